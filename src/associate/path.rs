//! Chains of edges.

use std::collections::BTreeMap;

/// Edges in the order and direction in which they follow one another, cut where a path branches: one list a path. A path that does not close
/// begins at its smaller end.
#[must_use]
pub fn paths<T: Copy + Ord>(edges: &[[T; 2]]) -> Vec<Vec<[T; 2]>> {
    let mut around: BTreeMap<T, Vec<usize>> = BTreeMap::new();
    for (index, edge) in edges.iter().enumerate() {
        edge.iter().for_each(|&end| around.entry(end).or_default().push(index));
    }
    let mut used = vec![false; edges.len()];
    let mut found = Vec::new();
    let ends = around.iter().filter(|(_, edges)| edges.len() != 2);
    let inner = around.iter().filter(|(_, edges)| edges.len() == 2);
    for (&start, at_start) in ends.chain(inner) {
        for &first in at_start {
            let (mut path, mut here, mut next) = (Vec::new(), start, Some(first));
            while let Some(edge) = next.filter(|&edge| !used[edge]) {
                used[edge] = true;
                let [a, b] = edges[edge];
                let there = if a == here { b } else { a };
                path.push([here, there]);
                here = there;
                next = match around[&here][..] {
                    [one, other] => Some(if one == edge { other } else { one }),
                    _ => None,
                };
            }
            if !path.is_empty() {
                found.push(path);
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::paths;

    #[test]
    fn chains_loops_gaps_and_branches() {
        assert_eq!(paths(&[[3, 2], [1, 2], [3, 4]]), [[[1, 2], [2, 3], [3, 4]]]);
        assert_eq!(paths(&[[2, 3], [1, 2], [3, 1]]), [[[1, 2], [2, 3], [3, 1]]]);
        assert_eq!(paths(&[[1, 2], [3, 4]]).len(), 2);
        assert_eq!(paths(&[[1, 2], [2, 3], [2, 4]]).len(), 3);
        assert_eq!(paths::<u32>(&[]).len(), 0);
    }
}
