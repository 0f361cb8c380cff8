//! The normal equations of a block's program at one scaling.
//!
//! `M = sum A_g W_g^-2 A_g'` over the cones, t not among them, is the stiffness of
//! a network of springs (see `network`). The column of t, which is dense, is a
//! border: `(M + d a a') v = r` is `M v + a y = r`, `y = d a'v`; with ties and
//! chains eliminated it is multiplied onto the factor of what is left:
//! `L (1 + d w w') L'` with `L w = a` has a closed Cholesky factor (Goldfarb and
//! Scheinberg, 2004), as stable as L, which the Sherman-Morrison formula is not.

use nalgebra::SVector;

use super::network::{Condensed, Network};

/// The solution of the normal equations, with forces that are known better than
/// v tells: a stiff link turns the rounding of its motion into force.
pub(super) struct Solution<const D: usize> {
    pub v: Vec<f64>,
    /// `y`, the force of t.
    pub strength: f64,
    /// The wrench of every link in a chain, in its frame.
    pub carried: Vec<(usize, SVector<f64, D>)>,
}

/// Factored normal equations; the pattern serves all iterations.
pub(super) struct Normal<const D: usize> {
    network: Network<D>,
    /// t's column with chains eliminated, and the weight that is left of t's own.
    border: Condensed<D>,
    weight: f64,
    /// `L w = a`, and the diagonal and multipliers of the factor of `1 + d w w'`.
    w: Vec<f64>,
    diagonal: Vec<f64>,
    multiplier: Vec<f64>,
}

impl<const D: usize> Normal<D> {
    pub(super) fn new(network: Network<D>) -> Self {
        let nothing = Vec::new;
        let border = Condensed::default();
        Self { network, border, weight: 0.0, w: nothing(), diagonal: nothing(), multiplier: nothing() }
    }

    /// The network, to be factorised.
    pub(super) fn network(&mut self) -> &mut Network<D> {
        &mut self.network
    }

    /// Multiplies t's column `preload`, of which `give` is 1 / d, what ties give way
    /// to included, onto the factor: unit lower triangle `w_i b_j`, and a diagonal.
    pub(super) fn add_border(&mut self, preload: &[f64], give: f64) {
        self.border = self.network.condense(preload);
        self.weight = (give + self.network.work_within(&self.border, &self.border)).recip();
        self.w = self.network.forward(&self.border.junctions);
        self.diagonal.clear();
        self.multiplier.clear();
        let mut weight = self.weight;
        for &entry in &self.w {
            let diagonal = 1.0 + weight * entry * entry;
            self.diagonal.push(diagonal);
            self.multiplier.push(weight * entry / diagonal);
            weight /= diagonal;
        }
    }

    /// Solves for the bodies' `rows`, to whose forces ties add `along` along t's column.
    pub(super) fn solve(&self, rows: &[f64], along: f64) -> Solution<D> {
        let border = &self.border;
        let mut condensed = self.network.condense(rows);
        let work = along + self.network.work_within(border, &condensed);
        for (row, entry) in condensed.junctions.iter_mut().zip(&border.junctions) {
            *row -= entry * (work * self.weight);
        }
        let mut y = self.network.forward(&condensed.junctions);
        let mut sum = 0.0;
        for ((y, w), multiplier) in y.iter_mut().zip(&self.w).zip(&self.multiplier) {
            *y -= w * sum;
            sum += multiplier * *y;
        }
        let mut sum = 0.0;
        for (k, y) in y.iter_mut().enumerate().rev() {
            *y = *y / self.diagonal[k] - self.multiplier[k] * sum;
            sum += self.w[k] * *y;
        }
        let junctions = self.network.backward(y);
        let moved: f64 = border.junctions.iter().zip(&junctions).map(|(a, v)| a * v).sum();
        let strength = self.weight * (moved + work);
        condensed.subtract_within(border, strength);
        let mut carried = Vec::new();
        let v = self.network.expand(&junctions, &condensed, |link, wrench| carried.push((link, wrench)));
        Solution { v, strength, carried }
    }
}
