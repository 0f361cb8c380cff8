//! The normal equations of a block's program at one scaling.
//!
//! `M = sum A_g W_g^-2 A_g'` over the cones, t not among them, is the stiffness of
//! a network of springs (see `network`). The row that ties a box component's two
//! slacks is eliminated by hand, so it costs nothing. The column of t, which is
//! dense, is a border: `(M + d a a') v = r` is `M v + a y = r`, `y = d a'v`; with
//! ties and chains eliminated it is multiplied onto the factor of what is left:
//! `L (1 + d w w') L'` with `L w = a` has a closed Cholesky factor (Goldfarb and
//! Scheinberg, 2004), as stable as L, which the Sherman-Morrison formula is not.

use nalgebra::{Matrix3, Matrix6, Vector3, Vector6};

use super::maps::{Six, relative};
use super::network::{Condensed, Network, flexibility_root};
use super::program::{Cone, Form, Group, Program};
use super::second_order::{Scaling, determinant};

/// Weight of a variable without a cone. Its dual residual is what it still moves
/// by, over this.
const FREE_WEIGHT: f64 = 1e8;

/// `rows += A x`, with t as the last variable.
pub(super) fn add_forces(program: &Program, x: &[f64], rows: &mut [f64]) {
    for_each_link(program, |link, groups| {
        let mut wrench = [0.0; 6];
        for group in groups {
            group.add_wrench(group.part(x), &mut wrench);
            if let Some(row) = group.tie_row {
                rows[row] += x[group.first];
            }
        }
        for side in program.sides[link].iter().flatten() {
            side.push(&wrench, rows);
        }
    });
    let t = x[program.variables];
    for (row, entry) in rows.iter_mut().zip(&program.preload) {
        *row += entry * t;
    }
}

/// `A' v`, with t as the last variable.
pub(super) fn velocities(program: &Program, v: &[f64]) -> Vec<f64> {
    let mut values = vec![0.0; program.variables + 1];
    for_each_link(program, |link, groups| {
        let u: Six = relative(&program.sides[link], v);
        for group in groups {
            let opening = &mut values[group.first..group.first + group.len];
            group.velocities(&u, opening);
            if let Some(row) = group.tie_row {
                opening[0] += v[row];
            }
        }
    });
    values[program.variables] = program.preload.iter().zip(v).map(|(a, b)| a * b).sum();
    values
}

/// Calls `each` with every link and its groups, which follow one another.
fn for_each_link(program: &Program, mut each: impl FnMut(usize, &[Group])) {
    for groups in program.groups.chunk_by(|a, b| a.link == b.link) {
        each(groups[0].link, groups);
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
    pub(super) fn new(cone: Cone, x: &[f64], s: &[f64]) -> Option<Self> {
        let inside = |z: &[f64]| z[0] > 0.0 && determinant(z) > 0.0;
        match (cone, x.len()) {
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
    /// The groups of the component's two slacks.
    groups: [usize; 2],
    row: usize,
    /// Sum of both slacks' weights, and the first one's share.
    weight: f64,
    share: f64,
}

/// The solution v of the normal equations, with forces `W^-2 A' v` that are known
/// better than v tells: a stiff link turns the rounding of its motion into force.
pub(super) struct Solution {
    pub v: Vec<f64>,
    /// `(variable, force)` for t and for the links in chains of several.
    pub known: Vec<(usize, f64)>,
}

/// Factored normal equations; the pattern serves all iterations.
pub(super) struct Normal<'p> {
    program: &'p Program,
    network: Network,
    ties: Vec<Tie>,
    /// Per group: the tie whose first slack it is.
    tied: Vec<Option<usize>>,
    stiffness: Vec<Matrix6<f64>>,
    /// The border: t's column with ties and chains eliminated, and the weight
    /// that is left of t's own.
    border: Option<Condensed>,
    weight: f64,
    /// `L w = a`, and the diagonal and multipliers of the factor of `1 + d w w'`.
    w: Vec<f64>,
    diagonal: Vec<f64>,
    multiplier: Vec<f64>,
}

impl<'p> Normal<'p> {
    pub(super) fn new(program: &'p Program, in_series: bool) -> Self {
        let mut first_slack = vec![0; program.variables];
        let mut tied = vec![None; program.groups.len()];
        let mut ties = Vec::new();
        for (index, group) in program.groups.iter().enumerate() {
            first_slack[group.first] = index;
            if let (Some(column), Some(row)) = (group.ties, group.tie_row) {
                let one = first_slack[column];
                tied[one] = Some(ties.len());
                ties.push(Tie { groups: [one, index], row, weight: 1.0, share: 0.0 });
            }
        }
        Self {
            program,
            network: Network::new(program, in_series),
            ties,
            tied,
            stiffness: vec![Matrix6::zeros(); program.sides.len()],
            border: None,
            weight: 0.0,
            w: Vec::new(),
            diagonal: Vec::new(),
            multiplier: Vec::new(),
        }
    }

    /// Factorises at `metrics`, one per group and t's last.
    pub(super) fn factorise(&mut self, metrics: &[Metric]) {
        let groups = &self.program.groups;
        let square = |index: usize| match metrics[index] {
            Metric::Linear(root) => root * root,
            Metric::Friction(_) | Metric::Wrench(_) => 1.0,
        };
        for tie in &mut self.ties {
            let [one, other] = tie.groups.map(|index| square(index).recip());
            tie.weight = one + other;
            tie.share = one / tie.weight;
        }
        for matrix in &mut self.stiffness {
            matrix.fill(0.0);
        }
        for (index, (group, metric)) in groups.iter().zip(metrics).enumerate() {
            let sum = &mut self.stiffness[group.link];
            if self.tied[index].is_some() {
                // Both slacks move by the same amount, in opposite directions.
                let tie = self.ties[self.tied[index].expect("just seen")].groups;
                add_stiffness(group, &Metric::Linear((square(tie[0]) + square(tie[1])).sqrt()), sum);
            } else {
                add_stiffness(group, metric, sum);
            }
        }
        let mut wrenches: Vec<Option<usize>> = vec![None; self.program.sides.len()];
        for (index, group) in groups.iter().enumerate().filter(|(_, group)| group.len == 6) {
            wrenches[group.link] = Some(index);
        }
        self.network.factorise(&self.stiffness, |link| match wrenches[link].map(|index| (index, &metrics[index])) {
            Some((index, Metric::Wrench(scaling))) => wrench_flexibility(&groups[index], scaling),
            _ => flexibility_root(&self.stiffness[link]),
        });
        self.multiply_preload(square(groups.len()).recip());
    }

    /// The factor of `1 + d w w'`: unit lower triangle `w_i b_j`, and a diagonal.
    fn multiply_preload(&mut self, weight: f64) {
        let mut balance = self.program.preload.clone();
        let mut within = self.eliminate_ties(&mut balance, &self.program.preload);
        let border = self.network.condense(&balance);
        within += self.network.work_within(&border, &border);
        self.weight = (weight.recip() + within).recip();
        self.w = self.network.forward(&border.junctions);
        self.border = Some(border);
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

    /// Eliminates the tie rows of `rows`; returns their work with t's column.
    fn eliminate_ties(&self, rows: &mut [f64], against: &[f64]) -> f64 {
        let mut work = 0.0;
        for tie in &self.ties {
            let value = rows[tie.row];
            work += against[tie.row] * value / tie.weight;
            let group = &self.program.groups[tie.groups[0]];
            let mut wrench = [0.0; 6];
            group.add_wrench(&[-tie.share * value], &mut wrench);
            for side in self.program.sides[group.link].iter().flatten() {
                side.push(&wrench, rows);
            }
        }
        work
    }

    /// Solves `(M + d a a') v = rows`.
    pub(super) fn solve(&self, rows: &[f64]) -> Solution {
        let border = self.border.as_ref().expect("factorised before");
        let mut balance = rows.to_vec();
        let mut work = self.eliminate_ties(&mut balance, &self.program.preload);
        let mut condensed = self.network.condense(&balance);
        work += self.network.work_within(border, &condensed);
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
        let along: f64 = border.junctions.iter().zip(&junctions).map(|(a, v)| a * v).sum();
        let strength = self.weight * (along + work);
        condensed.subtract_within(border, strength);
        let mut known = vec![(self.program.variables, strength)];
        let mut carried: Vec<Option<Vector6<f64>>> = vec![None; self.program.sides.len()];
        let mut v = self.network.expand(&junctions, &condensed, |link, wrench| carried[link] = Some(wrench));
        v.resize(rows.len(), 0.0);
        let left: Vec<f64> =
            self.ties.iter().map(|tie| rows[tie.row] - self.program.preload[tie.row] * strength).collect();
        for (tie, left) in self.ties.iter().zip(&left) {
            let group = &self.program.groups[tie.groups[0]];
            let mut along = [0.0];
            group.velocities(&relative(&self.program.sides[group.link], &v), &mut along);
            v[tie.row] = left / tie.weight - tie.share * along[0];
        }
        for (index, group) in self.program.groups.iter().enumerate() {
            let (Form::Axes(axes), Some(wrench)) = (&group.form, carried[group.link]) else { continue };
            for (k, (axis, factor)) in axes[..group.len].iter().enumerate() {
                known.push((group.first + k, wrench[*axis] / (factor * group.scale)));
            }
            if let (Some(tie), Some(last)) = (self.tied[index], known.last_mut()) {
                let (tie, left) = (&self.ties[tie], left[tie]);
                last.1 += tie.share * left;
                let other = (self.program.groups[tie.groups[1]].first, left - last.1);
                known.push(other);
            }
        }
        Solution { v, known }
    }
}

/// Adds `C W^-2 C'`, with C the wrenches of the group's variables.
fn add_stiffness(group: &Group, metric: &Metric, sum: &mut Matrix6<f64>) {
    match (&group.form, metric) {
        (Form::Slack, _) => {}
        (Form::Axes(axes), Metric::Linear(root)) => {
            let (axis, factor) = axes[0];
            sum[(axis, axis)] += (group.scale * factor / root).powi(2);
        }
        (Form::Axes(axes), Metric::Wrench(scaling)) => {
            let inverse = scaling.inverse_square();
            for (r, (row, a)) in axes.iter().enumerate() {
                for (c, (column, b)) in axes.iter().enumerate() {
                    sum[(*row, *column)] += inverse[r][c] * (a * b * group.scale * group.scale);
                }
            }
        }
        (Form::Point { at, .. }, Metric::Linear(root)) => {
            let weight = (group.scale / root).powi(2);
            add_at_point(&Matrix3::from_diagonal(&Vector3::new(0.0, 0.0, weight)), at, sum);
        }
        (Form::Point { at, friction }, Metric::Friction(scaling)) => {
            let inverse = scaling.inverse_square();
            // Variables are (z, x / mu, y / mu).
            let place = [(2, 1.0), (0, *friction), (1, *friction)];
            let mut local = Matrix3::zeros();
            for (r, (row, a)) in place.iter().enumerate() {
                for (c, (column, b)) in place.iter().enumerate() {
                    local[(*row, *column)] = inverse[r][c] * (a * b * group.scale * group.scale);
                }
            }
            add_at_point(&local, at, sum);
        }
        (Form::Axes(_), Metric::Friction(_)) | (Form::Point { .. }, Metric::Wrench(_)) => {
            unreachable!("no group has this form and cone")
        }
    }
}

/// Adds a point's stiffness to that of the face it belongs to.
fn add_at_point(local: &Matrix3<f64>, [x, y]: &[f64; 2], sum: &mut Matrix6<f64>) {
    if *x == 0.0 && *y == 0.0 {
        let mut force = sum.fixed_view_mut::<3, 3>(0, 0);
        force += local;
        return;
    }
    // Force on the point to force and torque at the face's centre.
    let lever = Vector3::new(*x, *y, 0.0).cross_matrix();
    let turning = lever * local;
    let mut view = sum.fixed_view_mut::<3, 3>(0, 0);
    view += local;
    let mut view = sum.fixed_view_mut::<3, 3>(3, 0);
    view += turning;
    let mut view = sum.fixed_view_mut::<3, 3>(0, 3);
    view += turning.transpose();
    let mut view = sum.fixed_view_mut::<3, 3>(3, 3);
    view += turning * lever.transpose();
}

/// `C'^-1 W` of a group whose variables are all six components.
fn wrench_flexibility(group: &Group, scaling: &Scaling<6>) -> Matrix6<f64> {
    let Form::Axes(axes) = &group.form else { unreachable!("points have three components") };
    let mut root = Matrix6::zeros();
    for c in 0..6 {
        let column = scaling.apply(&std::array::from_fn(|k| if k == c { 1.0 } else { 0.0 }));
        for (value, (axis, factor)) in column.iter().zip(axes) {
            root[(*axis, c)] = value / (factor * group.scale);
        }
    }
    root
}
