//! The Bernstein coefficients of an element's Jacobian determinant, by direct convolution of its derivative nets.

use rustc_hash::FxHashMap;

use super::real::Real;
use super::rounding::Growth;
use crate::element::derivative::{Derivative, derivatives};
use crate::element::{Cell, Net, Order, Tables};

/// Tables of one cell and order.
///
/// With scaled nets (`element::net`), `det(sum D1_b, sum D2_c, sum D3_d)` is two plain convolutions: cross products
/// `C_k = sum D1_b x D2_c` over `b + c = k`, then `sum C_k . D3_d` over `k + d = a`; coefficient `a` is that sum
/// divided by the weight of `a`. All weights are positive.
#[derive(Debug)]
pub(super) struct Product {
    columns: [Column; 3],
    cross: Pairs,
    dot: Pairs,
    /// Weight of each coefficient times the cube of the nodes' common denominator, an exact integer.
    divisor: Vec<f64>,
    /// Constants of the rounding bound.
    pub(super) growth: Growth,
}

/// A derivative as sparse rows.
#[derive(Debug)]
struct Column {
    starts: Vec<u32>,
    entries: Vec<(u16, f64)>,
    /// The weight that each scaled coefficient holds, times the denominator.
    weights: Vec<f64>,
}

/// For each place of a product the pairs of places that meet there.
#[derive(Debug)]
struct Pairs {
    starts: Vec<u32>,
    pairs: Vec<[u16; 2]>,
}

/// Nets of one arithmetic while an element is worked on.
#[derive(Clone, Debug, Default)]
pub(super) struct Workspace<T> {
    /// Shifted and scaled nodes.
    pub(super) nodes: Vec<[T; 3]>,
    columns: [Vec<[T; 3]>; 3],
    cross: Vec<[T; 3]>,
}

impl Product {
    /// The tables of a cell with two or three dimensions.
    pub(super) fn of(cell: Cell, order: Order) -> &'static Product {
        static TABLES: Tables<Product> = Tables::new();
        TABLES.get(cell, order, || Product::build(cell, order))
    }

    fn build(cell: Cell, order: Order) -> Product {
        let derivatives = derivatives(cell, order);
        let [a, b, c] = derivatives.each_ref().map(|d| d.net);
        let cross = Pairs::new(a, b);
        let dot = Pairs::new(a.times(b), c);
        let net = Net::jacobian(cell, order);
        let denominator: f64 = derivatives.iter().map(|d| d.denominator).product();
        let divisor = net.indices().into_iter().map(|index| net.weight(index) * denominator).collect();
        let columns = derivatives.map(|d| Column::new(&d));
        let growth = Growth::new(columns.each_ref().map(Column::extent), cross.longest(), dot.longest());
        Product { columns, cross, dot, divisor, growth }
    }

    /// Computes the coefficients from the workspace's nodes; returns each column's largest unscaled components, which
    /// the rounding bound asks for.
    pub(super) fn coefficients<T: Real>(&self, work: &mut Workspace<T>, into: &mut Vec<f64>) -> [[f64; 3]; 3] {
        let Workspace { nodes, columns, cross } = work;
        let mut largest = [[0.0; 3]; 3];
        for axis in 0..3 {
            self.columns[axis].apply(nodes, &mut columns[axis]);
            largest[axis] = self.columns[axis].largest(&columns[axis]);
        }
        let [a, b, c] = columns;
        cross.clear();
        cross.extend(self.cross.places().map(|pairs| {
            let mut sum = [T::default(); 3];
            for &[i, j] in pairs {
                let (x, y) = (a[usize::from(i)], b[usize::from(j)]);
                sum[0] = sum[0] + (x[1] * y[2] - x[2] * y[1]);
                sum[1] = sum[1] + (x[2] * y[0] - x[0] * y[2]);
                sum[2] = sum[2] + (x[0] * y[1] - x[1] * y[0]);
            }
            sum
        }));
        into.clear();
        into.extend(self.dot.places().zip(&self.divisor).map(|(pairs, &divisor)| {
            let mut sum = T::default();
            for &[i, j] in pairs {
                let (x, y) = (cross[usize::from(i)], c[usize::from(j)]);
                sum = sum + ((x[0] * y[0] + x[1] * y[1]) + x[2] * y[2]);
            }
            sum.rounded() / divisor
        }));
        largest
    }
}

impl Column {
    fn new(derivative: &Derivative) -> Column {
        let net = derivative.net;
        let weights = net.indices().into_iter().map(|index| net.weight(index) * derivative.denominator).collect();
        let mut starts = vec![0];
        let mut entries = Vec::new();
        for row in &derivative.rows {
            entries.extend(row.iter().map(|&(node, factor)| (node as u16, factor)));
            starts.push(entries.len() as u32);
        }
        Column { starts, entries, weights }
    }

    fn rows(&self) -> impl ExactSizeIterator<Item = &[(u16, f64)]> {
        self.starts.windows(2).map(|w| &self.entries[w[0] as usize..w[1] as usize])
    }

    /// Entries of the longest row, and the largest sum of absolute values of an unscaled row.
    fn extent(&self) -> (usize, f64) {
        let longest = self.rows().map(<[_]>::len).max().unwrap_or(0);
        let sums = self.rows().zip(&self.weights).map(|(row, w)| row.iter().map(|e| e.1.abs()).sum::<f64>() / w);
        (longest, sums.fold(0.0, f64::max))
    }

    fn apply<T: Real>(&self, nodes: &[[T; 3]], into: &mut Vec<[T; 3]>) {
        into.clear();
        into.extend(self.rows().map(|row| {
            let mut sum = [T::default(); 3];
            for &(node, factor) in row {
                let (x, factor) = (nodes[usize::from(node)], T::of(factor));
                for axis in 0..3 {
                    sum[axis] = sum[axis] + factor * x[axis];
                }
            }
            sum
        }));
    }

    fn largest<T: Real>(&self, values: &[[T; 3]]) -> [f64; 3] {
        let mut largest = [0.0f64; 3];
        for (value, weight) in values.iter().zip(&self.weights) {
            for axis in 0..3 {
                largest[axis] = largest[axis].max((value[axis].rounded() / weight).abs());
            }
        }
        largest
    }
}

impl Pairs {
    fn new(left: Net, right: Net) -> Pairs {
        let product = left.times(right).indices();
        let place: FxHashMap<[usize; 3], usize> = product.iter().enumerate().map(|(n, &index)| (index, n)).collect();
        let mut lists = vec![Vec::new(); product.len()];
        for (i, a) in left.indices().into_iter().enumerate() {
            for (j, b) in right.indices().into_iter().enumerate() {
                let sum: [usize; 3] = std::array::from_fn(|axis| a[axis] + b[axis]);
                if let Some(&n) = place.get(&sum) {
                    lists[n].push([i as u16, j as u16]);
                }
            }
        }
        let mut starts = vec![0];
        starts.extend(lists.iter().scan(0, |sum, list| {
            *sum += list.len() as u32;
            Some(*sum)
        }));
        Pairs { starts, pairs: lists.concat() }
    }

    fn places(&self) -> impl ExactSizeIterator<Item = &[[u16; 2]]> {
        self.starts.windows(2).map(|w| &self.pairs[w[0] as usize..w[1] as usize])
    }

    fn longest(&self) -> usize {
        self.places().map(<[_]>::len).max().unwrap_or(0)
    }
}
