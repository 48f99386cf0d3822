//! Roots: the wall vertex nearest to each linear node along mesh edges.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use glam::DVec3;
use rayon::prelude::*;

use crate::element::Cell;
use crate::mesh::Incidence;
use crate::mesh::elevate::Elevated;

/// The root of every linear node.
#[derive(Clone)]
pub(super) struct Roots {
    /// The seed that it hangs on; `None` where no path leads to one.
    pub(super) of: Vec<Option<u32>>,
    /// Length of the shortest path to it; infinite where there is none.
    pub(super) length: Vec<f64>,
}

/// The mesh edges at each linear node.
pub(super) struct Graph<'a> {
    points: &'a [DVec3],
    /// Nodes at the other ends of the edges, rising.
    neighbours: Incidence<u32>,
}

impl<'a> Graph<'a> {
    pub(super) fn new(elevated: &'a Elevated) -> Graph<'a> {
        let linear_nodes = elevated.linear_nodes;
        let edges = elevated.carriers[Cell::Line as usize].iter().map(|(ends, _)| [ends[0].index(), ends[1].index()]);
        let both = edges.flat_map(|[a, b]| [(a, b as u32), (b, a as u32)]);
        let neighbours = Incidence::new(linear_nodes, both).sorted();
        Graph { points: &elevated.mesh.points()[..linear_nodes], neighbours }
    }

    fn around(&self, node: usize) -> &[u32] {
        self.neighbours.at(node)
    }

    /// For every linear node the seed at the end of the shortest path along mesh edges (Dijkstra from all seeds at once; equal paths
    /// go to the smaller seed), and the length of that path.
    pub(super) fn roots(&self, seeds: &[bool]) -> Roots {
        let linear_nodes = self.points.len();
        let mut of: Vec<Option<u32>> = vec![None; linear_nodes];
        let mut length = vec![f64::INFINITY; linear_nodes];
        let mut queue = BinaryHeap::new();
        for node in (0..linear_nodes).filter(|&n| seeds[n]) {
            length[node] = 0.0;
            queue.push(Reverse((Length(0.0), node as u32, node as u32)));
        }
        while let Some(Reverse((Length(so_far), root, node))) = queue.pop() {
            let node = node as usize;
            if of[node].is_some() {
                continue;
            }
            of[node] = Some(root);
            for &next in self.around(node) {
                let further = so_far + self.points[node].distance(self.points[next as usize]);
                if further < length[next as usize] || (further == length[next as usize] && of[next as usize].is_none())
                {
                    length[next as usize] = further;
                    queue.push(Reverse((Length(further), root, next)));
                }
            }
        }
        Roots { of, length }
    }

    /// Which linear nodes of planes are walls of their own: the shortest mesh edge there leaves the planes.
    ///
    /// `in_plane` tells which nodes a plane holds, `on_plane` which lie on one, its rim too: at a symmetry plane the shortest
    /// edges of the first layer lead to the rim, the wall's own curve.
    pub(super) fn walls_of_their_own(&self, in_plane: impl Fn(usize) -> bool + Sync, on_plane: &[bool]) -> Vec<bool> {
        let own_wall = |n: usize| {
            let length = |&&m: &&u32| self.points[n].distance(self.points[m as usize]);
            let nearest = || self.around(n).iter().min_by(|a, b| length(a).total_cmp(&length(b)));
            in_plane(n) && nearest().is_some_and(|&m| !on_plane[m as usize])
        };
        (0..self.points.len()).into_par_iter().map(own_wall).collect()
    }
}

/// A path's length, ordered.
#[derive(PartialEq)]
struct Length(f64);

impl Eq for Length {}

impl PartialOrd for Length {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Length {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.0.total_cmp(&other.0)
    }
}
