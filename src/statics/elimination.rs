//! The order in which the bodies of a graph are eliminated, and where the blocks of
//! Cholesky factors on it are.
//!
//! Bodies go in order of least degree. The pattern is found once and serves every matrix
//! on the same graph, of blocks of any size.
//!
//! Knows graphs, no matrix.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Where the blocks of a factor are: by columns, in the order of elimination.
#[derive(Debug)]
pub(super) struct Pattern {
    /// Position of each body in the order of elimination.
    pub position: Vec<usize>,
    /// Per position: index of its diagonal block; those below it follow. One more for the end.
    pub first: Vec<usize>,
    /// Per block its row; diagonal blocks have their own position.
    pub rows: Vec<usize>,
    /// Per position: where the products of each pair of blocks below its diagonal go.
    pub targets: Vec<usize>,
}

impl Pattern {
    /// Of the matrices on `bodies` bodies of which `pairs` are joined.
    pub(super) fn new(bodies: usize, pairs: impl Iterator<Item = (usize, usize)>) -> Self {
        let (order, later) = least_degree(bodies, pairs);
        let mut position = vec![0; bodies];
        for (k, &body) in order.iter().enumerate() {
            position[body] = k;
        }
        let mut first = Vec::with_capacity(bodies + 1);
        let mut rows = Vec::new();
        for (k, neighbours) in later.iter().enumerate() {
            first.push(rows.len());
            rows.push(k);
            rows.extend(neighbours.iter().map(|&body| position[body]));
            rows[first[k] + 1..].sort_unstable();
        }
        first.push(rows.len());
        let mut pattern = Self { position, first, rows, targets: Vec::new() };
        for k in 0..bodies {
            let below = &pattern.rows[pattern.first[k] + 1..pattern.first[k + 1]];
            for (n, &column) in below.iter().enumerate() {
                // Both in ascending order, and all of these are among those.
                let mut block = pattern.first[column];
                for &row in &below[n..] {
                    while pattern.rows[block] < row {
                        block += 1;
                    }
                    pattern.targets.push(block);
                }
            }
        }
        pattern
    }

    /// Number of bodies.
    pub(super) fn bodies(&self) -> usize {
        self.position.len()
    }

    /// Whether body `i` is eliminated before body `j`.
    pub(super) fn precedes(&self, i: usize, j: usize) -> bool {
        self.position[i] < self.position[j]
    }

    /// Where the block at the row of body `i` and the column of body `j`, which does
    /// not come later in the elimination, is among all blocks.
    pub(super) fn slot(&self, i: usize, j: usize) -> usize {
        self.index(self.position[i], self.position[j])
    }

    /// Whether there is a block for bodies `i` and `j`.
    pub(super) fn joins(&self, i: usize, j: usize) -> bool {
        let (one, other) = (self.position[i], self.position[j]);
        self.find(one.max(other), one.min(other)).is_ok()
    }

    /// Index of the block at positions `(row, column)`, `row >= column`.
    pub(super) fn index(&self, row: usize, column: usize) -> usize {
        self.first[column] + self.find(row, column).expect("in the pattern")
    }

    /// Where the block at positions `(row, column)` is in its column, if there is one.
    fn find(&self, row: usize, column: usize) -> Result<usize, usize> {
        self.rows[self.first[column]..self.first[column + 1]].binary_search(&row)
    }
}

/// An order of elimination, least degree first, and per step the bodies that
/// remain and are joined to it, directly or through eliminated ones.
fn least_degree(bodies: usize, pairs: impl Iterator<Item = (usize, usize)>) -> (Vec<usize>, Vec<Vec<usize>>) {
    let mut neighbours: Vec<Vec<usize>> = vec![Vec::new(); bodies];
    for (i, j) in pairs.filter(|(i, j)| i != j) {
        neighbours[i].push(j);
        neighbours[j].push(i);
    }
    for around in &mut neighbours {
        around.sort_unstable();
        around.dedup();
    }
    // Entries whose degree is no longer true are passed over.
    let mut queue: BinaryHeap<Reverse<(usize, usize)>> =
        (0..bodies).map(|i| Reverse((neighbours[i].len(), i))).collect();
    let (mut order, mut later) = (Vec::with_capacity(bodies), Vec::with_capacity(bodies));
    let mut eliminated = vec![false; bodies];
    let mut union = Vec::new();
    while let Some(Reverse((degree, body))) = queue.pop() {
        if eliminated[body] || degree != neighbours[body].len() {
            continue;
        }
        eliminated[body] = true;
        let around = std::mem::take(&mut neighbours[body]);
        for &i in &around {
            union.clear();
            unite(&neighbours[i], &around, &mut union);
            union.retain(|&j| j != i && j != body);
            neighbours[i].clone_from(&union);
            queue.push(Reverse((neighbours[i].len(), i)));
        }
        order.push(body);
        later.push(around);
    }
    (order, later)
}

/// Appends what is in either of two ascending lists to `union`, in ascending order.
fn unite(mut one: &[usize], mut other: &[usize], union: &mut Vec<usize>) {
    while let (Some(&a), Some(&b)) = (one.first(), other.first()) {
        union.push(a.min(b));
        one = &one[usize::from(a <= b)..];
        other = &other[usize::from(b <= a)..];
    }
    union.extend_from_slice(one);
    union.extend_from_slice(other);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What elimination joins, by the definition: two bodies that a way over bodies eliminated
    /// before both of them leads between.
    fn filled(pattern: &Pattern, pairs: &[(usize, usize)], i: usize, j: usize) -> bool {
        let earlier = |body: usize| pattern.precedes(body, i) && pattern.precedes(body, j);
        let (mut reached, mut next) = (vec![i], 0);
        while let Some(&at) = reached.get(next) {
            next += 1;
            for &(a, b) in pairs {
                for (from, to) in [(a, b), (b, a)] {
                    if from == at && !reached.contains(&to) && (to == j || earlier(to)) {
                        reached.push(to);
                    }
                }
            }
        }
        reached.contains(&j)
    }

    #[test]
    fn blocks_are_where_ways_over_earlier_bodies_lead() {
        // A torus of 4 x 5 bodies.
        let body = |x: usize, y: usize| (x % 4) * 5 + y % 5;
        let cells = (0..4).flat_map(|x| (0..5).map(move |y| (x, y)));
        let pairs: Vec<_> =
            cells.flat_map(|(x, y)| [(body(x, y), body(x + 1, y)), (body(x, y), body(x, y + 1))]).collect();
        let pattern = Pattern::new(20, pairs.iter().copied());
        for i in 0..20 {
            for j in 0..i {
                assert_eq!(pattern.joins(i, j), filled(&pattern, &pairs, i, j), "{i} {j}");
            }
        }
        let mut target = pattern.targets.iter();
        for k in 0..20 {
            let below = &pattern.rows[pattern.first[k] + 1..pattern.first[k + 1]];
            for (n, &column) in below.iter().enumerate() {
                for &row in &below[n..] {
                    assert_eq!(target.next(), Some(&pattern.index(row, column)));
                }
            }
        }
    }
}
