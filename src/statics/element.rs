//! One cone of a block's program with what the iteration keeps of it.
//!
//! An element has N variables, the wrench components of a link that lie in one
//! cone, and acts on the balances of at most two bodies, D each. Its state is
//! Nesterov and Todd's: forces `x` and opening velocities `s` inside the cone, and
//! the scaling W that maps both onto one point.
//!
//! Knows its own columns, nothing of other elements.

use super::network::Network;
use super::second_order::{Scaling, aim, divide, dot, product, shortened_step, towards};
use super::stiffness::{Matrix, Stiffness};

/// Weight of a variable without a cone. Its dual residual is what it still moves
/// by, over this.
const FREE_WEIGHT: f64 = 1e8;

/// How far from the mean the complementarity of a cone may be, either way, before it
/// is corrected.
const SPREAD: f64 = 10.0;

/// The balances of a body, or its scaled twist.
pub(super) type Rows<const D: usize> = [f64; D];

/// The action of an element's variables on the balance of one body.
#[derive(Clone, Debug)]
pub(super) struct End<const D: usize, const N: usize> {
    pub body: usize,
    pub columns: [Rows<D>; N],
}

/// A group of variables in one cone, at one point of the iteration.
pub(super) struct Element<const D: usize, const N: usize> {
    pub ends: [Option<End<D, N>>; 2],
    /// Blocks of the matrix: of the first end, of the second, and the rows of the second
    /// by the columns of the first.
    slots: [Option<usize>; 3],
    /// A variable without any restriction; its `s` stays zero.
    pub free: bool,
    /// Cost of the first variable.
    pub cost: f64,
    /// By how much a tie to another element opens this one.
    pub tied: f64,
    /// Share of the stiffness that is left once the tie is eliminated.
    pub left: f64,
    /// Whether its forces are those of a chain, known better than its motion tells.
    pub in_chain: bool,
    pub x: [f64; N],
    pub s: [f64; N],
    scaling: Scaling<N>,
    /// `W x = W^-1 s`.
    point: [f64; N],
    /// `c + A'v - s`.
    pub opening: [f64; N],
    /// Where the step aims, `W dx + W^-1 ds`, and the step of x and s.
    target: [f64; N],
    pub dx: [f64; N],
    pub ds: [f64; N],
    /// The step before it was bent.
    straight: [[f64; N]; 2],
}

impl<const D: usize, const N: usize> Element<D, N> {
    /// An element at `ends` whose first force and opening velocity are `start`, all others
    /// zero; one without a cone has none.
    pub(super) fn new(ends: [Option<End<D, N>>; 2], free: bool, cost: f64, start: [f64; 2]) -> Self {
        let (mut x, mut s) = ([0.0; N], [0.0; N]);
        if !free {
            [x[0], s[0]] = start;
        }
        let zero = [0.0; N];
        let scaling = Scaling::even(FREE_WEIGHT.sqrt().recip());
        Self {
            ends,
            slots: [None; 3],
            free,
            cost,
            tied: 0.0,
            left: 1.0,
            in_chain: false,
            x,
            s,
            scaling,
            point: zero,
            opening: zero,
            target: zero,
            dx: zero,
            ds: zero,
            straight: [zero; 2],
        }
    }

    /// `rows += A x`.
    pub(super) fn push(&self, x: &[f64; N], rows: &mut [Rows<D>]) {
        for end in self.ends.iter().flatten() {
            let rows = &mut rows[end.body];
            for (column, value) in end.columns.iter().zip(x) {
                for (row, entry) in rows.iter_mut().zip(column) {
                    *row += entry * value;
                }
            }
        }
    }

    /// `A'v`, with the tie.
    pub(super) fn pull(&self, v: &[Rows<D>]) -> [f64; N] {
        let mut opening = [0.0; N];
        opening[0] = self.tied;
        for end in self.ends.iter().flatten() {
            let rows = &v[end.body];
            for (value, column) in opening.iter_mut().zip(&end.columns) {
                *value += dot(column, rows);
            }
        }
        opening
    }

    /// Notes what the motion `v` lacks, and adds this element's forces to `forces`.
    pub(super) fn compare(&mut self, v: &[Rows<D>], forces: &mut [Rows<D>]) {
        self.opening = self.pull(v);
        self.opening[0] += self.cost;
        for (opening, s) in self.opening.iter_mut().zip(&self.s) {
            *opening -= s;
        }
        self.push(&self.x, forces);
    }

    /// Finds the scaling; whether there is one.
    pub(super) fn rescale(&mut self) -> bool {
        if self.free {
            return true;
        }
        let Some(scaling) = Scaling::inside(&self.x, &self.s) else { return false };
        self.point = scaling.apply(&self.x);
        self.scaling = scaling;
        true
    }

    /// `(scale, u)` with the stiffness `W^-2 = scale (2 u u' - J)`.
    pub(super) fn stiffness(&self) -> (f64, [f64; N]) {
        self.scaling.inverse_square()
    }

    /// `W`, by columns.
    pub(super) fn root(&self) -> [[f64; N]; N] {
        std::array::from_fn(|c| self.scaling.apply(&std::array::from_fn(|k| if k == c { 1.0 } else { 0.0 })))
    }

    /// Heads for the boundary, as if nothing were in the way: adds the forces to `rows`.
    pub(super) fn predict(&mut self, rows: &mut [Rows<D>]) {
        self.seek(self.point.map(|p| -p), rows);
    }

    /// Heads for complementarity `mu`, with what the prediction left out.
    pub(super) fn correct(&mut self, mu: f64, rows: &mut [Rows<D>]) {
        let target = if self.free {
            [0.0; N]
        } else {
            aim(&self.point, &self.scaling.apply(&self.dx), &self.scaling.apply_inverse(&self.ds), mu)
        };
        self.seek(target, rows);
    }

    /// Heads closer to the central path of complementarity `mu` than the step so far
    /// would come if it were as long as `reach`.
    pub(super) fn centre(&mut self, [x, s]: [f64; 2], mu: f64, rows: &mut [Rows<D>]) {
        self.straight = [self.dx, self.ds];
        let mut target = self.target;
        if !self.free {
            let (dx, ds) = (self.scaling.apply(&self.dx), self.scaling.apply_inverse(&self.ds));
            let there = product(
                &std::array::from_fn(|k| self.point[k] + x * dx[k]),
                &std::array::from_fn(|k| self.point[k] + s * ds[k]),
            );
            let change = divide(&self.point, &towards(&there, [mu / SPREAD, mu * SPREAD]));
            target = std::array::from_fn(|k| target[k] + change[k]);
        }
        self.seek(target, rows);
    }

    /// Takes back [`centre`](Self::centre).
    pub(super) fn straighten(&mut self) {
        [self.dx, self.ds] = self.straight;
    }

    /// The step to `W x + W^-1 s = target` if no body moved.
    fn seek(&mut self, target: [f64; N], rows: &mut [Rows<D>]) {
        self.target = target;
        let scaled = self.scaling.apply_inverse(&self.opening);
        self.dx = self.scaling.apply_inverse(&std::array::from_fn(|k| target[k] - scaled[k]));
        self.ds = self.opening;
        self.push(&self.dx, rows);
    }

    /// Follows the bodies' motion `v`.
    pub(super) fn follow(&mut self, v: &[Rows<D>]) {
        let opening = self.pull(v);
        let force = self.scaling.apply_inverse(&self.scaling.apply_inverse(&opening));
        for k in 0..N {
            self.ds[k] += opening[k];
            if !self.in_chain {
                self.dx[k] -= force[k];
            }
        }
        if self.free {
            self.ds = [0.0; N];
        }
    }

    /// The largest steps of x and s, no larger than `reach`, that stay inside, times
    /// `shorten` where something is in the way.
    pub(super) fn reach(&self, shorten: f64, reach: [f64; 2]) -> [f64; 2] {
        if self.free {
            return reach;
        }
        let [x, s] = reach;
        [shortened_step(&self.x, &self.dx, shorten, x), shortened_step(&self.s, &self.ds, shorten, s)]
    }

    /// Steps by the shares `x` and `s` of the way.
    pub(super) fn advance(&mut self, [x, s]: [f64; 2]) {
        for k in 0..N {
            self.x[k] += x * self.dx[k];
            self.s[k] += s * self.ds[k];
        }
    }

    /// `x's`.
    pub(super) fn gap(&self) -> f64 {
        dot(&self.x, &self.s)
    }

    /// Puts its ends into the order of elimination, and notes its places in the matrix.
    /// An element of a chain has none.
    pub(super) fn place(&mut self, network: &Network<D>) {
        if self.in_chain {
            return;
        }
        let at = |end: &Option<End<D, N>>| end.as_ref().and_then(|end| network.junction(end.body));
        let pattern = network.pattern();
        if let [Some(one), Some(other)] = self.ends.each_ref().map(at)
            && pattern.precedes(other, one)
        {
            self.ends.swap(0, 1);
        }
        let [one, other] = self.ends.each_ref().map(at);
        let slot = |row: Option<usize>, column: Option<usize>| Some(pattern.slot(row?, column?));
        self.slots = [slot(one, one), slot(other, other), slot(other, one)];
    }

    /// `A W^-2 A'` at an unscaled point: `A diag(-1, 1..) A'` for the blocks of `slots`.
    /// Only this part of the stiffness does not change direction with W.
    pub(super) fn reflected(&self) -> [Matrix<D>; 3] {
        let product = |a: &Option<End<D, N>>, b: &Option<End<D, N>>| {
            let mut matrix = [[0.0; D]; D];
            let (Some(a), Some(b)) = (a, b) else { return matrix };
            for (k, (left, right)) in a.columns.iter().zip(&b.columns).enumerate() {
                let sign = if k == 0 { -1.0 } else { 1.0 };
                for (column, value) in matrix.iter_mut().zip(right) {
                    for (entry, other) in column.iter_mut().zip(left) {
                        *entry += sign * value * other;
                    }
                }
            }
            matrix
        };
        let [one, other] = &self.ends;
        [product(one, one), product(other, other), product(other, one)]
    }

    /// Adds the stiffness `A W^-2 A'` to `matrix`; `reflected` is as of
    /// [`reflected`](Self::reflected), nothing for a single variable.
    pub(super) fn add_stiffness(&self, reflected: Option<&[Matrix<D>; 3]>, matrix: &mut Stiffness<D>) {
        let (scale, u) = self.scaling.inverse_square();
        let [one, other] = self.ends.each_ref().map(|end| {
            let mut rows = [0.0; D];
            for (column, value) in end.iter().flat_map(|end| &end.columns).zip(&u) {
                for (row, entry) in rows.iter_mut().zip(column) {
                    *row += entry * value;
                }
            }
            rows
        });
        let along = if N == 1 { scale * self.left } else { 2.0 * scale };
        for (k, (left, right)) in [(&one, &one), (&other, &other), (&other, &one)].into_iter().enumerate() {
            let Some(slot) = self.slots[k] else { continue };
            let block = matrix.block(slot);
            for (column, value) in block.iter_mut().zip(right) {
                let value = along * value;
                for (entry, other) in column.iter_mut().zip(left) {
                    *entry += value * other;
                }
            }
            for (column, steady) in block.iter_mut().zip(reflected.iter().flat_map(|reflected| &reflected[k])) {
                for (entry, value) in column.iter_mut().zip(steady) {
                    *entry += scale * value;
                }
            }
        }
    }
}
