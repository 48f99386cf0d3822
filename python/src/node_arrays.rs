//! Nodes of elements as numpy has them, in any of the library's node orders.

use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray2};
use pyo3::exceptions::{PyKeyError, PyValueError};
use pyo3::prelude::*;
use sagitta::element::{Cell, Order};
use sagitta::formats::{NODE_ORDERS, NamedOrder};
use sagitta::mesh::NodeId;

use crate::mesh::cell;

/// Nodes of elements, `(elements, nodes of each)`.
pub(crate) type NodeArray<'py> = Bound<'py, PyArray2<i64>>;

/// The names of the node orders, the internal one first.
#[pyfunction]
pub(crate) fn node_orders() -> Vec<(&'static str, &'static str)> {
    NODE_ORDERS.iter().map(|own| (own.name, own.title)).collect()
}

/// For each slot of an element in a node order, the node of the CGNS order that it holds.
#[pyfunction]
pub(crate) fn node_order(kind: &str, order: usize, name: &str) -> PyResult<Vec<usize>> {
    let order = Order::new(order).map_err(|error| PyValueError::new_err(error.to_string()))?;
    Ok(slots(name, cell(kind)?, order)?.iter().map(|&slot| usize::from(slot)).collect())
}

fn slots(name: &str, cell: Cell, order: Order) -> PyResult<&'static [u8]> {
    let known = || NODE_ORDERS.iter().map(|own| own.name).collect::<Vec<_>>().join(", ");
    let own = NamedOrder::named(name)
        .ok_or_else(|| PyKeyError::new_err(format!("{name:?} is no node order; there are {}", known())))?;
    own.slots(cell, order).ok_or_else(|| PyKeyError::new_err(format!("{name} has no {cell} of {order}")))
}

/// The nodes of all elements of some lists, in a node order.
pub(crate) fn gathered<'py>(
    py: Python<'py>,
    cell: Cell,
    order: Order,
    name: &str,
    lists: &[&[NodeId]],
) -> PyResult<NodeArray<'py>> {
    let (slots, stride) = (slots(name, cell, order)?, cell.node_count(order));
    let count = lists.iter().map(|list| list.len() / stride).sum();
    let mut all: Vec<i64> = Vec::with_capacity(count * stride);
    for element in lists.iter().flat_map(|list| list.chunks_exact(stride)) {
        all.extend(slots.iter().map(|&slot| element[usize::from(slot)].index() as i64));
    }
    PyArray1::from_vec(py, all).reshape([count, stride])
}

/// The nodes of elements in the internal order.
///
/// # Errors
/// What is wrong with them.
pub(crate) fn internal(
    nodes: &PyReadonlyArray2<'_, i64>,
    cell: Cell,
    order: Order,
    name: &str,
    points: usize,
) -> Result<Vec<NodeId>, String> {
    let slots = slots(name, cell, order).map_err(|error| error.to_string())?;
    let nodes = nodes.as_array();
    let mut all = vec![NodeId::default(); nodes.len()];
    for (element, (row, own)) in nodes.rows().into_iter().zip(all.chunks_exact_mut(slots.len())).enumerate() {
        for (&node, &slot) in row.iter().zip(slots) {
            let known = usize::try_from(node).ok().filter(|&node| node < points);
            let known =
                known.ok_or_else(|| format!("element {element} has node {node}, and there are {points} points"))?;
            own[usize::from(slot)] = NodeId::new(known).map_err(|error| error.to_string())?;
        }
    }
    Ok(all)
}
