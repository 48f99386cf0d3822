//! Meshes in Python's hands.

use std::path::PathBuf;
use std::sync::Arc;

use numpy::ndarray::{ArrayView2, ShapeBuilder};
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray2};
use pyo3::exceptions::{PyKeyError, PyValueError};
use pyo3::prelude::*;
use sagitta::certify::Certificate;
use sagitta::curve::{Curved, Job, Sweep};
use sagitta::element::{Cell, Order};
use sagitta::formats::{self, WriteOptions, msh, solver};
use sagitta::mesh::{Block, Entity, EntityKey, NodeId, Parts, PhysicalName};
use sagitta::report;

use crate::failure::Failure;
use crate::node_arrays::{self, NodeArray};
use crate::patch::Patch;
use crate::reading::Limits;
use crate::work;

/// What a Python object holds: a mesh, or one that was curved, with all that is known of it.
pub(crate) enum Held {
    Plain(Box<sagitta::mesh::Mesh>),
    Curved(Box<Curving>),
}

/// A mesh that was curved, by which job, and how its smoothing went.
pub(crate) struct Curving {
    pub(crate) curved: Curved,
    pub(crate) job: Job,
    pub(crate) sweeps: Vec<Sweep>,
}

impl Held {
    pub(crate) fn mesh(&self) -> &sagitta::mesh::Mesh {
        match self {
            Held::Plain(mesh) => mesh,
            Held::Curved(own) => &own.curved.mesh,
        }
    }

    /// The curving that the mesh comes from.
    pub(crate) fn curving(&self) -> PyResult<&Curving> {
        match self {
            Held::Curved(own) => Ok(own),
            Held::Plain(_) => Err(PyValueError::new_err("the mesh does not come from sagitta.curve")),
        }
    }
}

/// A mesh of one polynomial order; see `sagitta.Mesh`.
#[pyclass(frozen)]
pub(crate) struct Mesh {
    pub(crate) held: Arc<Held>,
}

impl Mesh {
    pub(crate) fn new(held: Held) -> Mesh {
        Mesh { held: Arc::new(held) }
    }

    fn mesh(&self) -> &sagitta::mesh::Mesh {
        self.held.mesh()
    }
}

/// The cell of a name.
pub(crate) fn cell(name: &str) -> PyResult<Cell> {
    let known = || Cell::ALL.map(Cell::name).join(", ");
    let found = Cell::ALL.into_iter().find(|cell| cell.name() == name);
    found.ok_or_else(|| PyKeyError::new_err(format!("{name:?} is no kind of cell; there are {}", known())))
}

/// Coordinates as an array on the mesh's own memory, which nobody can write to.
#[allow(unsafe_code)] // a copy of the points of a mesh of 4.3 million tets at P2 takes 140 MB, and numpy knows no safe view
fn view<'py>(mesh: &Bound<'py, Mesh>) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let points = mesh.get().mesh().points();
    // SAFETY: points are three doubles each, without gaps (`DVec3` is `repr(C)`). The array's base is the mesh, which is frozen, so that
    // the memory neither moves nor changes while the array lives.
    let array = unsafe {
        let view = ArrayView2::from_shape_ptr((points.len(), 3).strides((3, 1)), points.as_ptr().cast::<f64>());
        PyArray2::borrow_from_array(&view, mesh.clone().into_any())
    };
    array.try_readwrite()?.make_nonwriteable();
    Ok(array)
}

#[pymethods]
impl Mesh {
    #[getter]
    fn order(&self) -> usize {
        self.mesh().order().get()
    }

    #[getter]
    fn dimension(&self) -> usize {
        self.mesh().dimension()
    }

    #[getter]
    fn notes(&self) -> Vec<String> {
        self.mesh().notes().to_vec()
    }

    #[getter]
    fn is_curved(&self) -> bool {
        matches!(*self.held, Held::Curved(_))
    }

    /// Coordinates, `(n, 3)`, read-only and without a copy.
    fn points<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        view(slf)
    }

    /// Kinds of cells that there are, and how many of each.
    fn counts(&self) -> Vec<(&'static str, usize)> {
        let (counts, dimension) = (self.mesh().counts(), self.mesh().dimension());
        counts.into_iter().filter(|(cell, _)| cell.dimension() == dimension).map(|(own, n)| (own.name(), n)).collect()
    }

    /// Nodes of the cells of one kind, `(n, k)`.
    fn nodes<'py>(&self, py: Python<'py>, kind: &str, order: &str) -> PyResult<NodeArray<'py>> {
        let (mesh, kind) = (self.mesh(), cell(kind)?);
        let elements: Vec<&[NodeId]> = mesh.elements_of(kind).blocks().iter().map(|block| &block.nodes[..]).collect();
        node_arrays::gathered(py, kind, mesh.order(), order, &elements)
    }

    /// The file's numbers of the cells of one kind.
    fn numbers<'py>(&self, py: Python<'py>, kind: &str) -> PyResult<Bound<'py, PyArray1<u64>>> {
        let elements = self.mesh().elements_of(cell(kind)?);
        let numbers = elements.blocks().iter().flat_map(|block| block.tags.iter().copied());
        Ok(PyArray1::from_vec(py, numbers.collect()))
    }

    /// The names of the boundary patches.
    fn patches(&self) -> Vec<String> {
        Patch::names(&self.held)
    }

    fn patch(&self, name: &str) -> PyResult<Patch> {
        Patch::named(&self.held, name)
    }

    /// Whether every element is proven valid and every face on the CAD free of folds.
    #[getter]
    fn certified(&self) -> PyResult<bool> {
        Ok(self.held.curving()?.curved.is_certified())
    }

    /// Whether the smoothing was ended early.
    #[getter]
    fn stopped(&self) -> PyResult<bool> {
        Ok(self.held.curving()?.curved.smoothed.stopped)
    }

    /// Proven lower bounds of J/Jc of all cells, in the order of the file.
    fn minima<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        Ok(PyArray1::from_slice(py, &self.held.curving()?.curved.certificate.minima))
    }

    /// The cells with the smallest proven bounds, worst first: kind, place among its kind, number, bound, middle.
    fn worst(&self, count: usize) -> PyResult<Vec<Weak>> {
        let curved = &self.held.curving()?.curved;
        Ok(weakest(&curved.mesh, &curved.certificate, count))
    }

    /// The report as JSON, and as text.
    fn report(&self, py: Python<'_>) -> PyResult<(String, String)> {
        let Curving { curved, job, sweeps } = self.held.curving()?;
        let report = py.detach(|| {
            let measures = report::measures(curved);
            let run = report::Run::ending_now();
            report::Report { sweeps: report::sweeps(sweeps), ..report::report(job, curved, &measures, run) }
        });
        let json = serde_json::to_string(&report).map_err(|error| Failure::told(error).raise(py))?;
        Ok((json, report.to_string()))
    }

    /// Writes the mesh; returns notes.
    #[pyo3(signature = (path, target, msh_version, ascii, volume_only, physical_only))]
    #[allow(clippy::too_many_arguments)] // the choices of the program's command line, one by one
    fn write(
        &self,
        py: Python<'_>,
        path: PathBuf,
        target: Option<&str>,
        msh_version: &str,
        ascii: bool,
        volume_only: bool,
        physical_only: bool,
    ) -> PyResult<Vec<String>> {
        let solver = target.map(solver_named).transpose()?;
        let known = || msh::Version::ALL.map(msh::Version::name).join(", ");
        let version = msh::Version::ALL.into_iter().find(|version| version.name() == msh_version);
        let msh_version = version.ok_or_else(|| PyValueError::new_err(format!("msh_version is one of {}", known())))?;
        let msh_encoding = if ascii { msh::Encoding::Ascii } else { msh::Encoding::Binary };
        let held = self.held.clone();
        let written = work::run(py, None, None, move |_| {
            let fields = match &*held {
                Held::Curved(own) if formats::shows_fields(&path, solver) => {
                    report::fields(&own.curved, &report::measures(&own.curved))
                }
                _ => Vec::new(),
            };
            let options = WriteOptions { msh_version, msh_encoding, volume_only, physical_only, fields: &fields };
            match solver {
                Some(solver) => formats::write_for(&path, held.mesh(), solver, &options),
                None => formats::write(&path, held.mesh(), &options),
            }
        })?;
        written.map_err(|error| Failure::from(error).raise(py))
    }
}

/// A cell and what is proven of it: kind, place among its kind, number in the file, lower bound of J/Jc, middle of its corners.
type Weak = (&'static str, usize, u64, f64, [f64; 3]);

fn weakest(mesh: &sagitta::mesh::Mesh, certificate: &Certificate, count: usize) -> Vec<Weak> {
    let mut places: Vec<usize> = (0..certificate.minima.len()).collect();
    let bound = |&place: &usize| certificate.minima[place];
    places.sort_by(|a, b| bound(a).total_cmp(&bound(b)).then(a.cmp(b)));
    places.truncate(count);
    let cells = mesh.cells();
    let starts: Vec<Cell> = cells.iter().map(|own| own.cell).collect();
    let weak = |place: usize| {
        let own = cells.get(cells.id(place));
        let before = starts[..place].iter().filter(|&&kind| kind == own.cell).count();
        let middle = mesh.points_of(own.corners()).sum::<glam::DVec3>() / own.corners().len() as f64;
        (own.cell.name(), before, own.tag, certificate.minima[place], middle.to_array())
    };
    places.into_iter().map(weak).collect()
}

/// The solver of a name.
pub(crate) fn solver_named(name: &str) -> PyResult<&'static formats::Solver> {
    let known = || solver::SOLVERS.iter().map(|solver| solver.name).collect::<Vec<_>>().join(", ");
    solver::by_name(name).ok_or_else(|| PyValueError::new_err(format!("target={name:?}: it is one of {}", known())))
}

/// Reads a mesh file.
#[pyfunction]
pub(crate) fn read(py: Python<'_>, path: PathBuf, limits: Limits) -> PyResult<Mesh> {
    let reading = limits.reading(py, 1.0)?.mesh;
    let read = work::run(py, None, None, move |_| formats::read_with(&path, &reading))?;
    read.map(|mesh| Mesh::new(Held::Plain(Box::new(mesh)))).map_err(|error| Failure::from(error).raise(py))
}

/// Nodes of elements of one kind, as they come in.
type Elements<'py> = (String, PyReadonlyArray2<'py, i64>);

/// A mesh of arrays: points `(n, 3)`; by kind the nodes of cells; by patch and kind those of the boundary elements.
#[pyfunction]
pub(crate) fn from_arrays(
    points: PyReadonlyArray2<'_, f64>,
    cells: Vec<Elements<'_>>,
    patches: Vec<(String, Vec<Elements<'_>>)>,
    node_order: &str,
) -> PyResult<Mesh> {
    let all = || cells.iter().chain(patches.iter().flat_map(|(_, own)| own));
    let mut order = None;
    for (kind, nodes) in all() {
        order = Some(order_of(cell(kind)?, nodes.as_array().ncols(), order)?);
    }
    let Some(order) = order else { return Err(PyValueError::new_err("cells is empty: give at least one kind")) };
    let coordinates = points.as_array();
    if coordinates.ncols() != 3 {
        return Err(PyValueError::new_err(format!("points has {} columns, not 3", coordinates.ncols())));
    }
    let mut parts = Parts { order, ..Parts::default() };
    parts.points = coordinates.rows().into_iter().map(|x| glam::dvec3(x[0], x[1], x[2])).collect();
    if let Some(node) = parts.points.iter().position(|x| !x.is_finite()) {
        return Err(PyValueError::new_err(format!("points[{node}] is not finite")));
    }
    for (kind, nodes) in &cells {
        let kind = cell(kind)?;
        let entity = EntityKey::new(kind.dimension() as u8, 1);
        add(&mut parts, kind, entity, nodes, node_order, "cells")?;
    }
    for (place, (name, elements)) in patches.iter().enumerate() {
        let tag = i32::try_from(place + 1).map_err(|_| PyValueError::new_err("too many patches"))?;
        for (kind, nodes) in elements {
            let kind = cell(kind)?;
            let entity = EntityKey::new(kind.dimension() as u8, tag);
            add(&mut parts, kind, entity, nodes, node_order, &format!("patches[{name:?}]"))?;
            name_entity(&mut parts, entity, name);
        }
    }
    let mesh = sagitta::mesh::Mesh::new(parts).map_err(|error| PyValueError::new_err(error.to_string()))?;
    Ok(Mesh::new(Held::Plain(Box::new(mesh))))
}

/// The order of elements with so many nodes, which must be that of the others.
fn order_of(cell: Cell, nodes: usize, known: Option<Order>) -> PyResult<Order> {
    let counts = || Order::all().map(|order| cell.node_count(order).to_string()).collect::<Vec<_>>().join(", ");
    // a point is of every order
    let found = Order::all().find(|&own| cell.node_count(own) == nodes && known.is_none_or(|known| known == own));
    found.ok_or_else(|| {
        let at = known.map_or_else(String::new, |order| format!(" (elements before it are of {order})"));
        PyValueError::new_err(format!("a {cell} of order 1 to 4 has {} nodes, not {nodes}{at}", counts()))
    })
}

fn add(
    parts: &mut Parts,
    cell: Cell,
    entity: EntityKey,
    nodes: &PyReadonlyArray2<'_, i64>,
    node_order: &str,
    what: &str,
) -> PyResult<()> {
    let nodes = node_arrays::internal(nodes, cell, parts.order, node_order, parts.points.len())
        .map_err(|why| PyValueError::new_err(format!("{what}[{:?}]: {why}", cell.name())))?;
    let first = 1 + parts.blocks.iter().map(|block| block.tags.len() as u64).sum::<u64>();
    let count = (nodes.len() / cell.node_count(parts.order)) as u64;
    parts.blocks.push(Block { tags: (first..first + count).collect(), nodes, ..Block::new(cell, entity) });
    Ok(())
}

/// Gives an entity its group, which has its number.
fn name_entity(parts: &mut Parts, key: EntityKey, name: &str) {
    if parts.entities.iter().any(|own| own.key == key) {
        return;
    }
    let own = parts.blocks.iter().filter(|block| block.entity == key).flat_map(|block| &block.nodes);
    let mut bounds = [glam::DVec3::INFINITY, glam::DVec3::NEG_INFINITY];
    for node in own {
        let x = parts.points[node.index()];
        bounds = [bounds[0].min(x), bounds[1].max(x)];
    }
    let bounds = bounds.map(|x| x.to_array());
    parts.entities.push(Entity { key, bounds, physical_tags: vec![key.tag], boundary: Vec::new() });
    parts.physical_names.push(PhysicalName { dimension: key.dimension, tag: key.tag, name: name.to_owned() });
}
