//! From the file's node numbers to indices in the list of nodes.

use super::fault::MshFault;
use crate::formats::error::Fault;
use crate::mesh::NodeId;

/// Looks nodes up by the file's number: by table where the numbers are dense, by search where they are sparse.
pub(super) enum NodeTags {
    /// Node of the number `first + n`, where there is one.
    Dense { first: u64, nodes: Vec<Option<NodeId>> },
    /// Numbers and nodes, rising.
    Sparse(Vec<(u64, NodeId)>),
}

impl NodeTags {
    /// The table of the numbers of nodes 0, 1, ...
    ///
    /// # Errors
    /// [`MshFault::RepeatedNode`]; [`Fault::TooMany`].
    pub(super) fn new(tags: &[u64]) -> Result<NodeTags, Fault> {
        let first = tags.iter().copied().min().unwrap_or(0);
        let last = tags.iter().copied().max().unwrap_or(0);
        if (last - first) / 4 <= tags.len() as u64 {
            let mut nodes = vec![None; (last - first) as usize + 1];
            for (n, &tag) in tags.iter().enumerate() {
                if nodes[(tag - first) as usize].replace(NodeId::new(n)?).is_some() {
                    return Err(MshFault::RepeatedNode(tag).into());
                }
            }
            return Ok(NodeTags::Dense { first, nodes });
        }
        let numbered = |(n, &tag): (usize, &u64)| Ok::<_, Fault>((tag, NodeId::new(n)?));
        let mut sorted = tags.iter().enumerate().map(numbered).collect::<Result<Vec<_>, _>>()?;
        sorted.sort_unstable();
        match sorted.windows(2).find(|pair| pair[0].0 == pair[1].0) {
            Some(pair) => Err(MshFault::RepeatedNode(pair[0].0).into()),
            None => Ok(NodeTags::Sparse(sorted)),
        }
    }

    /// The node of a number.
    pub(super) fn get(&self, tag: u64) -> Option<NodeId> {
        match self {
            NodeTags::Dense { first, nodes } => {
                let place = usize::try_from(tag.checked_sub(*first)?).ok()?;
                nodes.get(place).copied().flatten()
            }
            NodeTags::Sparse(sorted) => {
                let place = sorted.binary_search_by_key(&tag, |&(tag, _)| tag).ok()?;
                Some(sorted[place].1)
            }
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn dense_and_sparse_numbers_are_found() {
        for tags in [&[3, 1, 2][..], &[7, u64::MAX, 1], &[5], &[]] {
            let table = NodeTags::new(tags).unwrap();
            for (n, &tag) in tags.iter().enumerate() {
                assert_eq!(table.get(tag).map(NodeId::index), Some(n));
            }
            assert!(table.get(0).is_none() && table.get(4).is_none() && table.get(u64::MAX - 1).is_none());
        }
    }

    #[test]
    fn a_number_that_stands_twice_is_told() {
        let told = |tags: &[u64]| NodeTags::new(tags).map_or_else(|fault| fault.to_string(), |_| String::new());
        let far = 9_000_000_000;
        assert!(told(&[1, 2, 1]).starts_with("node 1 occurs twice"));
        assert!(told(&[1, far, far]).starts_with("node 9000000000 occurs twice"));
    }
}
