//! Block-sparse Cholesky factors of the matrices of a body graph.
//!
//! The normal equations of a block's program have one D x D block per body, with
//! D balances each, and one per pair of bodies that a link joins, like the
//! stiffness matrix of a frame of beams.
//!
//! Knows matrices on a pattern, nothing of wrenches or cones.

use std::sync::Arc;

use super::elimination::Pattern;

/// A D x D matrix, by columns.
pub(super) type Matrix<const D: usize> = [[f64; D]; D];

/// Least pivot, as a share of the diagonal entry it came from: what is left
/// below that is rounding, or less than nothing.
const LEAST_PIVOT: f64 = 1e-14;

/// Pivot root that stands for infinity.
const AT_REST: f64 = 1e100;

/// A symmetric block matrix on the bodies of a graph, then its Cholesky factor.
pub(super) struct Stiffness<const D: usize> {
    pattern: Arc<Pattern>,
    blocks: Vec<Matrix<D>>,
}

impl<const D: usize> Stiffness<D> {
    /// The zero matrix on `pattern`.
    pub(super) fn new(pattern: Arc<Pattern>) -> Self {
        let blocks = vec![[[0.0; D]; D]; pattern.rows.len()];
        Self { pattern, blocks }
    }

    /// Sets every entry to zero.
    pub(super) fn clear(&mut self) {
        self.blocks.fill([[0.0; D]; D]);
    }

    /// Adds a block at the row of body `i` and the column of body `j`; of a
    /// diagonal block, the lower triangle counts.
    pub(super) fn add(&mut self, i: usize, j: usize, block: &Matrix<D>) {
        let (row, at) = (self.pattern.position[i], self.pattern.position[j]);
        if row >= at {
            let index = self.pattern.index(row, at);
            for (target, column) in self.blocks[index].iter_mut().zip(block) {
                for (entry, value) in target.iter_mut().zip(column) {
                    *entry += value;
                }
            }
        } else {
            let index = self.pattern.index(at, row);
            for (c, target) in self.blocks[index].iter_mut().enumerate() {
                for (entry, column) in target.iter_mut().zip(block) {
                    *entry += column[c];
                }
            }
        }
    }

    /// Where its blocks are.
    pub(super) fn pattern(&self) -> &Arc<Pattern> {
        &self.pattern
    }

    /// A block to add to; of a diagonal block, the lower triangle counts.
    pub(super) fn block(&mut self, slot: usize) -> &mut Matrix<D> {
        &mut self.blocks[slot]
    }

    /// Overwrites the matrix, which must be positive semidefinite, with its factor.
    pub(super) fn factorise(&mut self) {
        let diagonal = |k: usize| -> [f64; D] { std::array::from_fn(|c| self.blocks[self.pattern.first[k]][c][c]) };
        let least: Vec<[f64; D]> = (0..self.pattern.position.len())
            .map(|k| diagonal(k).map(|d| (d * LEAST_PIVOT).max(f64::MIN_POSITIVE)))
            .collect();
        let Pattern { first: firsts, targets, .. } = &*self.pattern;
        let mut target = targets.iter();
        for (k, least) in least.iter().enumerate() {
            let (first, end) = (firsts[k], firsts[k + 1]);
            cholesky(&mut self.blocks[first], least);
            let pivot = self.blocks[first];
            for block in &mut self.blocks[first + 1..end] {
                divide(block, &pivot);
            }
            for n in first + 1..end {
                let b = self.blocks[n];
                for m in n..end {
                    let a = self.blocks[m];
                    subtract_product(&mut self.blocks[*target.next().expect("one per pair")], &a, &b);
                }
            }
        }
    }

    /// `x := L^-1 x`, by bodies; the result is in the order of elimination.
    pub(super) fn forward(&self, x: &[f64]) -> Vec<f64> {
        let mut y = vec![0.0; x.len()];
        for (body, &k) in self.pattern.position.iter().enumerate() {
            y[D * k..D * k + D].copy_from_slice(&x[D * body..D * body + D]);
        }
        for k in 0..self.pattern.position.len() {
            let pivot = &self.blocks[self.pattern.first[k]];
            let mut own: [f64; D] = std::array::from_fn(|r| y[D * k + r]);
            for c in 0..D {
                own[c] *= pivot[c][c];
                for r in c + 1..D {
                    own[r] -= pivot[c][r] * own[c];
                }
            }
            y[D * k..D * k + D].copy_from_slice(&own);
            for n in self.pattern.first[k] + 1..self.pattern.first[k + 1] {
                let (block, row) = (&self.blocks[n], self.pattern.rows[n]);
                let part = &mut y[D * row..D * row + D];
                for (column, factor) in block.iter().zip(&own) {
                    for (entry, value) in part.iter_mut().zip(column) {
                        *entry -= value * factor;
                    }
                }
            }
        }
        y
    }

    /// `L'^-1 y` for `y` in the order of elimination; the result is by bodies.
    pub(super) fn backward(&self, mut y: Vec<f64>) -> Vec<f64> {
        for k in (0..self.pattern.position.len()).rev() {
            let mut own: [f64; D] = std::array::from_fn(|r| y[D * k + r]);
            for n in self.pattern.first[k] + 1..self.pattern.first[k + 1] {
                let (block, row) = (&self.blocks[n], self.pattern.rows[n]);
                let part = &y[D * row..D * row + D];
                for (column, entry) in block.iter().zip(&mut own) {
                    *entry -= column.iter().zip(part).map(|(a, b)| a * b).sum::<f64>();
                }
            }
            let pivot = &self.blocks[self.pattern.first[k]];
            for c in (0..D).rev() {
                for r in c + 1..D {
                    own[c] -= pivot[c][r] * own[r];
                }
                own[c] *= pivot[c][c];
            }
            y[D * k..D * k + D].copy_from_slice(&own);
        }
        let mut x = vec![0.0; y.len()];
        for (body, &k) in self.pattern.position.iter().enumerate() {
            x[D * body..D * body + D].copy_from_slice(&y[D * k..D * k + D]);
        }
        x
    }
}

/// Overwrites the lower triangle with the Cholesky factor, its diagonal inverted.
fn cholesky<const D: usize>(matrix: &mut Matrix<D>, least: &[f64; D]) {
    for c in 0..D {
        // Where all that is left is rounding, let this component rest (Wright 1999).
        let root = if matrix[c][c] > least[c] { matrix[c][c].sqrt() } else { AT_REST };
        let inverse = root.recip();
        matrix[c][c] = inverse;
        for entry in &mut matrix[c][c + 1..] {
            *entry *= inverse;
        }
        let column = matrix[c];
        for d in c + 1..D {
            for r in d..D {
                matrix[d][r] -= column[r] * column[d];
            }
        }
    }
}

/// `block := block L'^-1`, with the diagonal of L inverted.
fn divide<const D: usize>(block: &mut Matrix<D>, pivot: &Matrix<D>) {
    for c in 0..D {
        for b in 0..c {
            let (factor, column) = (pivot[b][c], block[b]);
            for (entry, value) in block[c].iter_mut().zip(&column) {
                *entry -= value * factor;
            }
        }
        for entry in &mut block[c] {
            *entry *= pivot[c][c];
        }
    }
}

/// `target -= a b'`.
fn subtract_product<const D: usize>(target: &mut Matrix<D>, a: &Matrix<D>, b: &Matrix<D>) {
    for (c, column) in target.iter_mut().enumerate() {
        for k in 0..D {
            for (entry, value) in column.iter_mut().zip(&a[k]) {
                *entry -= value * b[k][c];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solves_a_ring_of_bodies() {
        let bodies = 7;
        let pairs: Vec<(usize, usize)> = (0..bodies).map(|i| (i, (i + 1) % bodies)).collect();
        let mut matrix = Stiffness::<6>::new(Arc::new(Pattern::new(bodies, pairs.iter().copied())));
        let mut columns: Vec<[(usize, [f64; 6]); 2]> = Vec::new();
        for (n, &(i, j)) in pairs.iter().enumerate() {
            for k in 0..8 {
                let entry = |seed: usize| ((seed * 7 + k * 13 + n * 5) % 11) as f64 - 5.0;
                columns.push([(i, std::array::from_fn(entry)), (j, std::array::from_fn(|r| entry(r * r + 3)))]);
            }
        }
        for column in &columns {
            for (i, a) in column {
                for (j, b) in column.iter().filter(|(j, _)| i <= j) {
                    matrix.add(*j, *i, &std::array::from_fn(|c| std::array::from_fn(|r| b[r] * a[c])));
                }
            }
        }
        let wanted: Vec<f64> = (0..6 * bodies).map(|k| (k as f64 * 0.7).sin()).collect();
        let mut rhs = vec![0.0; wanted.len()];
        for column in &columns {
            let along: f64 = column.iter().flat_map(|(i, a)| a.iter().zip(&wanted[6 * i..])).map(|(a, b)| a * b).sum();
            for (i, a) in column {
                for r in 0..6 {
                    rhs[6 * i + r] += a[r] * along;
                }
            }
        }
        matrix.factorise();
        let solved = matrix.backward(matrix.forward(&rhs));
        for (a, b) in solved.iter().zip(&wanted) {
            assert!((a - b).abs() < 1e-9, "{a} {b}");
        }
    }
}
