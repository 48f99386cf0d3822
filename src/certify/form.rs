//! Nets that are subdivided: where their lines, corners and raised coefficients stand.

use crate::element::{Cell, Net, Order, Tables};

/// Tables for the Jacobian net of one cell and order.
#[derive(Debug)]
pub(super) struct Form {
    /// Number of coefficients of the net that the product fills.
    pub(super) product: usize,
    /// Corners of the product's net: coefficient, and point in reference coordinates.
    pub(super) ends: Vec<(u16, [f64; 3])>,
    /// From the product's net to the one that is halved, where they differ (pyramids).
    pub(super) raise: Option<Means>,
    /// From the Jacobian net of the linear element to the product's net.
    pub(super) from_linear: Means,
    /// Number of coefficients of the net that is halved.
    pub(super) size: usize,
    /// Coefficients at the corners.
    pub(super) corners: Vec<u16>,
    /// The ways to halve the cell.
    pub(super) directions: Vec<Direction>,
    /// The largest degree along a line.
    pub(super) degree: usize,
}

/// A family of parallel edges of the cell, to be bisected together.
#[derive(Debug)]
pub(super) struct Direction {
    /// Bundles of lines of equal length.
    pub(super) bundles: Vec<Bundle>,
    /// Corners at the beginning and the end of each parallel edge.
    pub(super) edges: Vec<[u8; 2]>,
}

/// How many lines are halved together.
pub(super) const LANES: usize = 8;

/// [`LANES`] lines of one length: the coefficients at their first places, at their second ones, and so on. The last
/// line may stand several times.
pub(super) type Bundle = Vec<[u16; LANES]>;

/// Coefficients of one net as means of another's.
#[derive(Debug)]
pub(super) struct Means {
    starts: Vec<u32>,
    terms: Vec<(u16, f64)>,
    /// Terms of the longest mean.
    pub(super) longest: usize,
}

impl Form {
    /// The tables of a cell with two or three dimensions.
    pub(super) fn of(cell: Cell, order: Order) -> &'static Form {
        static TABLES: Tables<Form> = Tables::new();
        TABLES.get(cell, order, || Form::build(cell, order))
    }

    fn build(cell: Cell, order: Order) -> Form {
        let product = Net::jacobian(cell, order);
        let net = product.on_chart();
        let from = product.indices();
        let to = net.indices();
        let raise = (cell != net.cell).then(|| {
            Means::new(to.iter().map(|&index| {
                product.raised(index).into_iter().map(|(at, w)| (place(&from, at), w)).collect::<Vec<_>>()
            }))
        });
        let directions = directions(net, &to);
        let degree = directions.iter().map(Direction::degree).max().unwrap_or(0);
        Form {
            product: from.len(),
            ends: product.corners().into_iter().map(|(index, at)| (place(&from, index), at)).collect(),
            raise,
            from_linear: elevation(Net::jacobian(cell, Order::LINEAR), product),
            size: to.len(),
            corners: net.corners().into_iter().map(|(index, _)| place(&to, index)).collect(),
            directions,
            degree,
        }
    }
}

fn place(indices: &[[usize; 3]], index: [usize; 3]) -> u16 {
    indices.iter().position(|&at| at == index).map_or(u16::MAX, |n| n as u16)
}

/// The product of a net with the constant 1 in the net that is missing to a higher one.
fn elevation(low: Net, high: Net) -> Means {
    let unity = high.over(low);
    let from = low.indices();
    let means = high.indices().into_iter().map(|index| {
        from.iter().enumerate().filter_map(move |(n, &at)| {
            let rest = [0, 1, 2].map(|axis| index[axis].checked_sub(at[axis]));
            let [Some(i), Some(j), Some(k)] = rest else { return None };
            let rest = [i, j, k];
            let held = unity.holds(rest);
            held.then(|| (n as u16, low.weight(at) * unity.weight(rest) / high.weight(index)))
        })
    });
    Means::new(means.map(Iterator::collect::<Vec<_>>))
}

/// The families of parallel edges, in the order of the cell's edges.
fn directions(net: Net, indices: &[[usize; 3]]) -> Vec<Direction> {
    let corners = net.cell.corners();
    let step = |a: u8, b: u8| -> [i8; 3] {
        std::array::from_fn(|x| corners[usize::from(b)][x] as i8 - corners[usize::from(a)][x] as i8)
    };
    let mut families: Vec<([i8; 3], Vec<[u8; 2]>)> = Vec::new();
    for &[a, b] in net.cell.edges() {
        let (forth, back) = (step(a, b), step(b, a));
        match families.iter_mut().find(|(along, _)| *along == forth || *along == back) {
            Some((along, edges)) => edges.push(if *along == forth { [a, b] } else { [b, a] }),
            None => families.push((forth, vec![[a, b]])),
        }
    }
    families.into_iter().map(|(along, edges)| Direction::new(net, indices, along, edges)).collect()
}

impl Direction {
    fn new(net: Net, indices: &[[usize; 3]], along: [i8; 3], edges: Vec<[u8; 2]>) -> Direction {
        let moved = |at: [usize; 3], sign: isize| -> Option<[usize; 3]> {
            let to = [0, 1, 2].map(|x| at[x].checked_add_signed(sign * isize::from(along[x])));
            let [Some(i), Some(j), Some(k)] = to else { return None };
            net.holds([i, j, k]).then_some([i, j, k])
        };
        let along = |&first: &[usize; 3]| -> Vec<u16> {
            std::iter::successors(Some(first), |&at| moved(at, 1)).map(|at| place(indices, at)).collect()
        };
        let mut lines: Vec<Vec<u16>> = indices.iter().filter(|&&at| moved(at, -1).is_none()).map(along).collect();
        lines.sort_by_key(Vec::len);
        let bundles = lines.chunk_by(|a, b| a.len() == b.len()).flat_map(|equal| equal.chunks(LANES).map(bundle));
        Direction { bundles: bundles.collect(), edges }
    }

    fn degree(&self) -> usize {
        self.bundles.iter().map(|bundle| bundle.len() - 1).max().unwrap_or(0)
    }
}

fn bundle(lines: &[Vec<u16>]) -> Bundle {
    (0..lines[0].len()).map(|n| std::array::from_fn(|lane| lines[lane.min(lines.len() - 1)][n])).collect()
}

impl Means {
    fn new(means: impl Iterator<Item = Vec<(u16, f64)>>) -> Means {
        let (mut starts, mut terms, mut longest) = (vec![0], Vec::new(), 0);
        for mean in means {
            longest = longest.max(mean.len());
            terms.extend(mean);
            starts.push(terms.len() as u32);
        }
        Means { starts, terms, longest }
    }

    /// Appends the means of `from`.
    pub(super) fn apply(&self, from: &[f64], into: &mut Vec<f64>) {
        into.extend(self.starts.windows(2).map(|w| {
            let terms = &self.terms[w[0] as usize..w[1] as usize];
            terms.iter().map(|&(n, weight)| weight * from[usize::from(n)]).sum::<f64>()
        }));
    }
}
