//! The normal equations of a block's program at one scaling.
//!
//! `M = sum A_g W_g^-2 A_g'` over the cones has one 6 x 6 block per body and per
//! joined pair of bodies. The row that ties a box component's two slacks is
//! eliminated by hand, so it costs nothing; the column of t, which is dense, is
//! multiplied onto the factor: `L (1 + d w w') L'` with `L w = a` has a closed
//! Cholesky factor (Goldfarb and Scheinberg, 2004), as stable as L, which the
//! Sherman-Morrison formula is not.

use super::program::{Cone, Group, Program};
use super::second_order::{Scaling, determinant};
use super::stiffness::Stiffness;

/// Weight of a variable without a cone. Its dual residual is what it still moves
/// by, over this.
const FREE_WEIGHT: f64 = 1e8;

/// A column of A: its entries on the balances of at most two bodies and in a tie.
#[derive(Clone, Copy)]
struct Column {
    bodies: usize,
    sides: [(usize, [f64; 6]); 2],
    tie: Option<usize>,
}

impl Column {
    fn new(entries: &[(usize, f64)], tie_rows: usize) -> Self {
        let mut column = Self { bodies: 0, sides: [(0, [0.0; 6]); 2], tie: None };
        for &(row, value) in entries {
            if row >= tie_rows {
                column.tie = Some(row);
                continue;
            }
            let known = column.sides[..column.bodies].iter().position(|side| side.0 == row / 6);
            let side = known.unwrap_or_else(|| {
                column.sides[column.bodies].0 = row / 6;
                column.bodies += 1;
                column.bodies - 1
            });
            column.sides[side].1[row % 6] += value;
        }
        column
    }

    fn sides(&self) -> &[(usize, [f64; 6])] {
        &self.sides[..self.bodies]
    }
}

/// The matrix A of a program with the column of t as its last.
pub(super) struct Operator {
    columns: Vec<Column>,
    preload: Vec<f64>,
}

impl Operator {
    pub(super) fn new(program: &Program) -> Self {
        let tie_rows = 6 * program.scales.force.len();
        let columns = program.columns.iter().map(|column| Column::new(&column.entries, tie_rows)).collect();
        let mut preload = vec![0.0; program.rows()];
        for &(row, value) in &program.preload {
            preload[row] += value;
        }
        Self { columns, preload }
    }

    /// `rows += A x`.
    pub(super) fn add_to(&self, rows: &mut [f64], x: &[f64]) {
        for (column, &value) in self.columns.iter().zip(x) {
            for (body, part) in column.sides() {
                for (row, entry) in rows[6 * body..6 * body + 6].iter_mut().zip(part) {
                    *row += entry * value;
                }
            }
            if let Some(tie) = column.tie {
                rows[tie] += value;
            }
        }
        let t = x[self.columns.len()];
        for (row, entry) in rows.iter_mut().zip(&self.preload) {
            *row += entry * t;
        }
    }

    /// `A' v`.
    pub(super) fn transposed(&self, v: &[f64]) -> Vec<f64> {
        let mut values = Vec::with_capacity(self.columns.len() + 1);
        for column in &self.columns {
            let mut sum = column.tie.map_or(0.0, |tie| v[tie]);
            for (body, part) in column.sides() {
                sum += part.iter().zip(&v[6 * body..6 * body + 6]).map(|(a, b)| a * b).sum::<f64>();
            }
            values.push(sum);
        }
        values.push(self.preload.iter().zip(v).map(|(a, b)| a * b).sum());
        values
    }
}

/// The Nesterov-Todd scaling W of one group of variables.
pub(super) enum Metric {
    /// A single variable: W itself.
    Linear(f64),
    Friction(Scaling<3>),
    Wrench(Scaling<6>),
}

impl Metric {
    /// `None` when a point is not inside its cone, or the cone of a size that
    /// no connector has.
    pub(super) fn new(group: &Group, x: &[f64], s: &[f64]) -> Option<Self> {
        let inside = |z: &[f64]| z[0] > 0.0 && determinant(z) > 0.0;
        match (group.cone, group.len) {
            (Cone::Free, _) => Some(Self::Linear(FREE_WEIGHT.sqrt().recip())),
            _ if !(inside(x) && inside(s)) => None,
            (Cone::NonNegative, _) => Some(Self::Linear((s[0] / x[0]).sqrt())),
            (Cone::Lorentz, 3) => Some(Self::Friction(Scaling::new(&array(x), &array(s)))),
            (Cone::Lorentz, 6) => Some(Self::Wrench(Scaling::new(&array(x), &array(s)))),
            (Cone::Lorentz, _) => None,
        }
    }

    /// `v := W v`.
    pub(super) fn apply(&self, v: &mut [f64]) {
        match self {
            Self::Linear(root) => v[0] *= root,
            Self::Friction(scaling) => v.copy_from_slice(&scaling.apply(&array(v))),
            Self::Wrench(scaling) => v.copy_from_slice(&scaling.apply(&array(v))),
        }
    }

    /// `v := W^-1 v`.
    pub(super) fn apply_inverse(&self, v: &mut [f64]) {
        match self {
            Self::Linear(root) => v[0] /= root,
            Self::Friction(scaling) => v.copy_from_slice(&scaling.apply_inverse(&array(v))),
            Self::Wrench(scaling) => v.copy_from_slice(&scaling.apply_inverse(&array(v))),
        }
    }
}

/// The first `N` entries.
pub(super) fn array<const N: usize>(v: &[f64]) -> [f64; N] {
    std::array::from_fn(|k| v[k])
}

/// A box component with two limits, its tie row eliminated.
struct Tie {
    /// The component's variable, and the group of its other slack.
    column: usize,
    other: usize,
    row: usize,
    /// Square root of the sum of both slacks' weights, and the first one's share.
    root: f64,
    share: f64,
}

/// Factored normal equations; the pattern serves all iterations.
pub(super) struct Normal {
    stiffness: Stiffness,
    ties: Vec<Tie>,
    /// Per column: the tie it takes part in with a wrench.
    tied: Vec<Option<usize>>,
    /// `L w = a`, and the diagonal and multipliers of the factor of `1 + d w w'`.
    w: Vec<f64>,
    diagonal: Vec<f64>,
    multiplier: Vec<f64>,
}

impl Normal {
    pub(super) fn new(program: &Program, operator: &Operator) -> Self {
        let pairs = operator.columns.iter().filter(|column| column.bodies == 2);
        let stiffness =
            Stiffness::new(program.scales.force.len(), pairs.map(|column| (column.sides[0].0, column.sides[1].0)));
        let mut tied = vec![None; program.columns.len()];
        let mut ties = Vec::new();
        for (other, group) in program.groups.iter().enumerate() {
            if let (Some(column), Some(row)) = (group.ties, operator.columns[group.first].tie) {
                tied[column] = Some(ties.len());
                ties.push(Tie { column, other, row, root: 1.0, share: 0.0 });
            }
        }
        Self { stiffness, ties, tied, w: Vec::new(), diagonal: Vec::new(), multiplier: Vec::new() }
    }

    /// Factorises at `metrics`, one per group and t's last.
    pub(super) fn factorise(&mut self, operator: &Operator, groups: &[Group], metrics: &[Metric]) {
        self.stiffness.clear();
        for (group, metric) in groups.iter().zip(metrics) {
            if group.first == operator.columns.len() || operator.columns[group.first].bodies == 0 {
                continue;
            }
            if let Some(tie) = self.tied[group.first].map(|tie| &mut self.ties[tie])
                && let (Metric::Linear(one), Metric::Linear(other)) = (metric, &metrics[tie.other])
            {
                tie.root = one.recip().hypot(other.recip());
                tie.share = (one.recip() / tie.root).powi(2);
                let column = &operator.columns[group.first];
                let scaled = column.sides.map(|(body, part)| (body, part.map(|entry| entry / one.hypot(*other))));
                self.stiffness.add_square(&scaled[..column.bodies]);
                continue;
            }
            for k in 0..group.len {
                let mut weights = [0.0; 6];
                weights[k] = 1.0;
                metric.apply_inverse(&mut weights[..group.len]);
                let columns = &operator.columns[group.first..group.first + group.len];
                let mut sum = columns[0].sides.map(|(body, _)| (body, [0.0; 6]));
                for (column, weight) in columns.iter().zip(weights) {
                    for (total, (_, part)) in sum.iter_mut().zip(column.sides()) {
                        for (entry, value) in total.1.iter_mut().zip(part) {
                            *entry += value * weight;
                        }
                    }
                }
                self.stiffness.add_square(&sum[..columns[0].bodies]);
            }
        }
        self.stiffness.factorise();
        self.multiply_preload(operator, metrics);
    }

    /// The factor of `1 + d w w'`: unit lower triangle `w_i b_j`, and a diagonal.
    fn multiply_preload(&mut self, operator: &Operator, metrics: &[Metric]) {
        let mut weight = match metrics.last() {
            Some(Metric::Linear(root)) => root.powi(-2),
            _ => 0.0,
        };
        self.w = self.forward(operator, &operator.preload);
        self.diagonal.clear();
        self.multiplier.clear();
        for &entry in &self.w {
            let diagonal = 1.0 + weight * entry * entry;
            self.diagonal.push(diagonal);
            self.multiplier.push(weight * entry / diagonal);
            weight /= diagonal;
        }
    }

    /// `M^-1 rows`.
    pub(super) fn solve(&self, operator: &Operator, rows: &[f64]) -> Vec<f64> {
        let mut y = self.forward(operator, rows);
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
        self.backward(operator, y)
    }

    /// `L^-1 rows`, with the ties before the bodies.
    fn forward(&self, operator: &Operator, rows: &[f64]) -> Vec<f64> {
        let mut balance = rows[..rows.len() - self.ties.len()].to_vec();
        let mut y = Vec::with_capacity(rows.len());
        for tie in &self.ties {
            let value = rows[tie.row];
            y.push(value / tie.root);
            for (body, part) in operator.columns[tie.column].sides() {
                for (row, entry) in balance[6 * body..6 * body + 6].iter_mut().zip(part) {
                    *row -= entry * tie.share * value;
                }
            }
        }
        y.extend(self.stiffness.forward(&balance));
        y
    }

    /// `L'^-1 y`.
    fn backward(&self, operator: &Operator, mut y: Vec<f64>) -> Vec<f64> {
        let mut v = self.stiffness.backward(y.split_off(self.ties.len()));
        v.resize(v.len() + self.ties.len(), 0.0);
        for (tie, value) in self.ties.iter().zip(y) {
            let sides = operator.columns[tie.column].sides();
            let along: f64 =
                sides.iter().flat_map(|(body, part)| part.iter().zip(&v[6 * body..])).map(|(a, b)| a * b).sum();
            v[tie.row] = value / tie.root - tie.share * along;
        }
        v
    }
}
