//! Axis-aligned boxes and a tree of them.

use glam::DVec3;

/// An axis-aligned box; [`Aabb::EMPTY`] holds nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// Smallest corner.
    pub min: DVec3,
    /// Largest corner.
    pub max: DVec3,
}

impl Aabb {
    /// The box that holds no point.
    pub const EMPTY: Self = Self { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY };

    /// The smallest box around points.
    pub fn of_points(points: impl IntoIterator<Item = DVec3>) -> Self {
        points.into_iter().fold(Self::EMPTY, Self::with_point)
    }

    /// This box, grown to hold `point`.
    #[must_use]
    pub fn with_point(self, point: DVec3) -> Self {
        Self { min: self.min.min(point), max: self.max.max(point) }
    }

    /// The smallest box around both.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// This box, grown by `margin` on every side.
    #[must_use]
    pub fn grown(self, margin: f64) -> Self {
        Self { min: self.min - DVec3::splat(margin), max: self.max + DVec3::splat(margin) }
    }

    /// Whether the box holds no point.
    pub fn is_empty(&self) -> bool {
        !(self.min.x <= self.max.x && self.min.y <= self.max.y && self.min.z <= self.max.z)
    }

    /// Centre of the box.
    pub fn center(&self) -> DVec3 {
        0.5 * (self.min + self.max)
    }

    /// Length of the diagonal; 0 for an empty box.
    pub fn diagonal(&self) -> f64 {
        if self.is_empty() { 0.0 } else { (self.max - self.min).length() }
    }

    /// Distance from `x` to the farthest corner; 0 for an empty box.
    pub(crate) fn farthest(&self, x: DVec3) -> f64 {
        if self.is_empty() { 0.0 } else { (x - self.min).max(self.max - x).length() }
    }

    /// Square of the distance from `x` to the box; 0 inside.
    pub fn distance_squared(&self, x: DVec3) -> f64 {
        (self.min - x).max(x - self.max).max(DVec3::ZERO).length_squared()
    }
}

#[derive(Clone, Copy, Debug)]
struct Node {
    bounds: Aabb,
    /// Leaf range in `order` for leaves; index of the left child (right = left + 1) for inner nodes.
    first: u32,
    /// Number of leaves; 0 for inner nodes.
    count: u32,
}

/// A binary tree over a slice of boxes, for branch-and-bound queries.
#[derive(Clone, Debug)]
pub struct BoxTree {
    nodes: Vec<Node>,
    order: Vec<u32>,
    boxes: Vec<Aabb>,
}

/// The best leaf found by [`BoxTree::nearest`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// Index of the leaf in the slice that the tree was built from.
    pub leaf: usize,
    /// Square of its distance, as the visitor gave it.
    pub distance_squared: f64,
}

/// A part of the tree: one leaf, or all below a node. In one number, as feet keep several.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Branch(u32);

impl Branch {
    /// All of a tree.
    pub(crate) const ROOT: Self = Self(Self::NODE);
    const NODE: u32 = 1 << 31;

    pub(crate) fn leaf(leaf: usize) -> Self {
        Self(leaf as u32)
    }

    /// The leaf, or the node.
    pub(crate) fn split(self) -> Result<usize, usize> {
        if self.0 & Self::NODE == 0 { Ok(self.0 as usize) } else { Err((self.0 & !Self::NODE) as usize) }
    }
}

/// What a [walk](BoxTree::walk) meets.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Met {
    /// A leaf whose box is near enough.
    Leaf(usize),
    /// A part that is skipped, and the squared distance of its box.
    Skipped(Branch, f64),
}

const LEAVES_PER_NODE: usize = 4;
const STACK: usize = 96;

impl BoxTree {
    /// Builds the tree; the result depends on the boxes and their order only.
    pub fn new(boxes: &[Aabb]) -> Self {
        let mut tree = Self { nodes: Vec::new(), order: (0..boxes.len() as u32).collect(), boxes: Vec::new() };
        if !boxes.is_empty() {
            tree.nodes.push(Node { bounds: Aabb::EMPTY, first: 0, count: 0 });
            tree.build(boxes, 0, 0, boxes.len());
        }
        tree.boxes = tree.order.iter().map(|&leaf| boxes[leaf as usize]).collect();
        tree
    }

    fn build(&mut self, boxes: &[Aabb], node: usize, start: usize, end: usize) {
        let leaves = &mut self.order[start..end];
        let bounds = leaves.iter().fold(Aabb::EMPTY, |all, &leaf| all.union(boxes[leaf as usize]));
        if leaves.len() <= LEAVES_PER_NODE {
            leaves.sort_unstable();
            self.nodes[node] = Node { bounds, first: start as u32, count: (end - start) as u32 };
            return;
        }
        let centers = Aabb::of_points(leaves.iter().map(|&leaf| boxes[leaf as usize].center()));
        let extent = centers.max - centers.min;
        let axis = if extent.x >= extent.y && extent.x >= extent.z {
            0
        } else if extent.y >= extent.z {
            1
        } else {
            2
        };
        let half = leaves.len() / 2;
        leaves.select_nth_unstable_by(half, |&a, &b| {
            let (ca, cb) = (boxes[a as usize].center()[axis], boxes[b as usize].center()[axis]);
            ca.total_cmp(&cb).then(a.cmp(&b))
        });
        let left = self.nodes.len();
        self.nodes[node] = Node { bounds, first: left as u32, count: 0 };
        self.nodes.extend([self.nodes[node]; 2]);
        self.build(boxes, left, start, start + half);
        self.build(boxes, left + 1, start + half, end);
    }

    /// Number of leaves.
    pub fn len(&self) -> usize {
        self.order.len()
    }

    /// Whether the tree has no leaf.
    pub fn is_empty(&self) -> bool {
        self.order.is_empty()
    }

    /// Box around all leaves.
    pub fn bounds(&self) -> Aabb {
        self.nodes.first().map_or(Aabb::EMPTY, |node| node.bounds)
    }

    /// Box around the leaves below a node.
    pub(crate) fn bounds_below(&self, node: usize) -> Aabb {
        self.nodes[node].bounds
    }

    /// Visits the leaves below node `root` (0 is the whole tree), nearer branches first, whose box is at most `sqrt(bound)` away from `x`,
    /// and tells what is skipped. After each leaf the visitor returns the new bound (squared distance).
    pub(crate) fn walk(&self, root: usize, x: DVec3, mut bound: f64, mut visitor: impl FnMut(Met) -> f64) {
        if self.nodes.is_empty() {
            return;
        }
        let mut stack = [(0_u32, 0.0_f64); STACK];
        stack[0] = (root as u32, self.nodes[root].bounds.distance_squared(x));
        let mut depth = 1;
        while depth > 0 {
            depth -= 1;
            let (index, distance) = stack[depth];
            if distance > bound {
                visitor(Met::Skipped(Branch(index | Branch::NODE), distance));
                continue;
            }
            let node = &self.nodes[index as usize];
            if node.count > 0 {
                for at in node.first..node.first + node.count {
                    let distance = self.boxes[at as usize].distance_squared(x);
                    let leaf = self.order[at as usize];
                    if distance <= bound {
                        bound = visitor(Met::Leaf(leaf as usize));
                    } else {
                        visitor(Met::Skipped(Branch(leaf), distance));
                    }
                }
                continue;
            }
            let near = [node.first, node.first + 1]
                .map(|child| (child, self.nodes[child as usize].bounds.distance_squared(x)));
            let (far, near) = if near[0].1 <= near[1].1 { (near[1], near[0]) } else { (near[0], near[1]) };
            stack[depth] = far;
            stack[depth + 1] = near;
            depth += 2;
        }
    }

    /// The nearest leaf to `x` not farther than `sqrt(bound)`. `distance_squared(leaf)` is the exact squared distance of a leaf, or `None` for
    /// a leaf that does not count. Of equally near leaves the one with the smallest index wins.
    pub fn nearest(
        &self,
        x: DVec3,
        bound: f64,
        mut distance_squared: impl FnMut(usize) -> Option<f64>,
    ) -> Option<Nearest> {
        let (mut bound, mut best) = (bound, None::<Nearest>);
        self.walk(0, x, bound, |met| {
            let Met::Leaf(leaf) = met else { return bound };
            let Some(distance) = distance_squared(leaf).filter(|&d| d <= bound) else { return bound };
            if best.is_none_or(|b| distance < b.distance_squared || (distance == b.distance_squared && leaf < b.leaf)) {
                best = Some(Nearest { leaf, distance_squared: distance });
            }
            bound = bound.min(distance);
            bound
        });
        best
    }

    /// Leaves whose box overlaps `window`, in ascending order.
    pub fn overlapping(&self, window: Aabb) -> Vec<usize> {
        let meets = |b: &Aabb| b.min.cmple(window.max).all() && window.min.cmple(b.max).all();
        let mut found = Vec::new();
        let mut stack = if self.nodes.is_empty() { Vec::new() } else { vec![0_u32] };
        while let Some(index) = stack.pop() {
            let node = &self.nodes[index as usize];
            if !meets(&node.bounds) {
                continue;
            }
            if node.count == 0 {
                stack.extend([node.first, node.first + 1]);
            }
            let leaves = node.first as usize..(node.first + node.count) as usize;
            found.extend(leaves.filter(|&at| meets(&self.boxes[at])).map(|at| self.order[at] as usize));
        }
        found.sort_unstable();
        found
    }
}
