//! What meets at each node.

/// For every node the items there, such as the elements around it: 4 bytes a node beside the items.
#[derive(Clone, Debug, Default)]
pub struct Incidence<T> {
    /// Where each node's items begin, and where the last one's end.
    starts: Vec<u32>,
    items: Vec<T>,
}

impl<T: Copy + Default> Incidence<T> {
    /// The lists of `nodes` nodes, from `(node, item)`: each keeps the order in which its items come.
    ///
    /// The pairs are gone through twice, first to count them.
    #[must_use]
    pub fn new(nodes: usize, pairs: impl Iterator<Item = (usize, T)> + Clone) -> Incidence<T> {
        let mut starts = vec![0u32; nodes + 1];
        pairs.clone().for_each(|(node, _)| starts[node + 1] += 1);
        for node in 0..nodes {
            starts[node + 1] += starts[node];
        }
        let mut next = starts.clone();
        let mut items = vec![T::default(); starts[nodes] as usize];
        for (node, item) in pairs {
            items[next[node] as usize] = item;
            next[node] += 1;
        }
        Incidence { starts, items }
    }

    /// The same with every node's items sorted.
    #[must_use]
    pub fn sorted(mut self) -> Incidence<T>
    where
        T: Ord,
    {
        for own in self.starts.windows(2) {
            self.items[own[0] as usize..own[1] as usize].sort_unstable();
        }
        self
    }

    /// The items at a node; none beyond the last node.
    #[must_use]
    pub fn at(&self, node: usize) -> &[T] {
        match self.starts.get(node..node + 2) {
            Some(&[first, end]) => &self.items[first as usize..end as usize],
            _ => &[],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn items_stand_at_their_nodes_in_the_order_they_came() {
        let lists = Incidence::new(4, [(2, 'c'), (0, 'z'), (2, 'a')].into_iter());
        assert_eq!([0, 1, 2, 3, 4].map(|node| lists.at(node)), [&['z'][..], &[], &['c', 'a'], &[], &[]]);
        assert_eq!(lists.sorted().at(2), ['a', 'c']);
    }
}
