//! Which of the fields that hold a structure at its utilisation to show: the one
//! with the least sum of strengths and of normal forces at contacts.
//!
//! ```text
//! minimise   sum of s_l over the connections + sum of f_n,k over the contacts
//! subject to balance, friction cones, s_l(w_l) <= s_l <= t S_l
//! ```
//!
//! with t the upper end of the whole structure's bracket, block by block. These are
//! the further terms of the paper's objective (section 3: sums of the characteristic
//! strengths, of the non-connected and of the environmental normal forces), here with
//! one weight, since all are newtons, and after the first term rather than far below
//! it in the same sum: no weight is small enough to be exact and large enough to be
//! solved for. Where several fields have the least sum, the solver's central path
//! ends between them, so that equal connections share equally.
//!
//! Which field is least is the solver's word. That it balances and holds is not: it
//! is repaired and proved like any other, and where that fails the field that proved
//! the bracket stays.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSolver, IPSolver, SupportedConeT};
use nalgebra::Vector6;

use crate::spatial::{Twist, Wrench};

use super::assessment::{Bracket, Distribution, Question};
use super::balance::restore;
use super::blocks::{Block, Link};
use super::bracket::Problem;
use super::conic::{Attempt, Iterate, settings};
use super::groups::Cone;
use super::loads::BodyLoad;
use super::part::Part;
use super::program::{Program, Purpose};
use super::structure::Structure;

/// Ways of asking the solver, tried in turn.
const ATTEMPTS: [Attempt; 2] = [
    Attempt { tolerance: 1e-12, inset: 0.0, regularization: 1e-9 },
    Attempt { tolerance: 1e-10, inset: 0.0, regularization: 1e-8 },
];

/// Smallest force scales of bodies, relative to the largest, with which the solver is
/// asked. What flows through a body without weight can be as much as through any other:
/// counted in units that are too small its cost is below the solver's tolerance.
const FLOORS: [f64; 3] = [1e-2, 1e-5, 1e-9];

/// By how much of the larger of it and 1 the solver's residuals may take the shown
/// field beyond the upper end that was proved before: half of what a value may be off.
const ROOM: f64 = 5e-8;

/// Share of that room which the solver is given where it does not do without any.
const GIVEN: f64 = 0.25;

/// Largest share of the field that proved the bracket in what is shown as the least.
const MIXED: f64 = 1e-2;

/// Relative excess over the sum of the field that proved the bracket that is rounding
/// of the solver: that field was the least already.
const NO_MORE: f64 = 1e-8;

/// Replaces the fields of `parts`, each of a block with cycles, by those of the least
/// sum. `others` is the bracket of all other blocks.
pub(super) fn choose(
    structure: &Structure,
    blocks: &[Block],
    loads: &[BodyLoad],
    others: Bracket,
    parts: &mut [(usize, Part)],
) -> Distribution {
    let whole = parts.iter().fold(others, |whole, (_, part)| match part {
        Part::Stands { utilisation, .. } => whole.max(*utilisation),
        Part::Collapses { .. } => Bracket::exact(f64::INFINITY),
    });
    if !whole.upper.is_finite() {
        return Distribution::Proof;
    }
    let limit = relaxed(whole);
    let mut kept = 0;
    for (index, part) in parts {
        kept += usize::from(!improve(structure, &blocks[*index], loads, (whole.upper, limit), part));
    }
    if kept == 0 { Distribution::Least } else { Distribution::LeastExcept { blocks: kept } }
}

/// The largest upper bound that would still answer as well as `bracket` does.
fn relaxed(bracket: Bracket) -> f64 {
    let Bracket { lower, upper } = bracket;
    let mut limit = upper + ROOM * upper.max(1.0);
    if Question::VALUE.is_answered_by(&bracket) {
        limit = limit.min(lower + Question::VALUE.gap() * upper.max(1.0) * (1.0 - ROOM)).max(upper);
    }
    if upper <= 1.0 { limit.min(1.0) } else { limit }
}

/// Replaces the field of one part, whose utilisations may be as large as the first of
/// the limits, or the second where that cannot be proved; whether it is the least now.
fn improve(
    structure: &Structure,
    block: &Block,
    loads: &[BodyLoad],
    (upper, limit): (f64, f64),
    part: &mut Part,
) -> bool {
    let Part::Stands { utilisation, wrenches, demands, mechanism, .. } = part else { return false };
    if block.bodies.iter().all(|&body| loads[body].is_zero()) {
        return true;
    }
    let program = Program::new(structure, block, loads, Purpose::Utilisation);
    let problem = Problem { structure, block, loads, program: &program };
    let before = Proved {
        upper: utilisation.upper,
        sum: sum(&problem, wrenches, demands),
        wrenches: wrenches.clone(),
        demands: demands.clone(),
    };
    if before.sum == 0.0 {
        return true;
    }
    let unit_mechanism = (utilisation.lower > 0.0).then_some(&mechanism[..]);
    let scaled = programs(structure, block, loads, &program);
    for cap in [upper, upper + GIVEN * (limit - upper)] {
        let found = scaled.iter().filter_map(|program| {
            let asked = Problem { program, ..problem };
            let least = Least::new(&asked, cap, before.sum);
            ATTEMPTS.iter().find_map(|attempt| {
                let (mut field, iterate) = least.solve(attempt)?;
                restore(&asked, &iterate, &mut field, &vec![false; block.links.len()], true);
                prove(&problem, field, unit_mechanism, limit, &before)
            })
        });
        if let Some(least) = found.min_by(|a, b| a.sum.total_cmp(&b.sum)) {
            utilisation.upper = utilisation.upper.max(least.upper);
            (*wrenches, *demands) = (least.wrenches, least.demands);
            return true;
        }
    }
    false
}

/// The program of a block with each of the [`FLOORS`] that makes a difference.
fn programs(structure: &Structure, block: &Block, loads: &[BodyLoad], program: &Program) -> Vec<Program> {
    let forces = || program.scales.force.iter().copied();
    let smallest = forces().fold(f64::INFINITY, f64::min) / forces().fold(0.0, f64::max);
    let needed = FLOORS.iter().position(|floor| *floor <= smallest).unwrap_or(FLOORS.len() - 1);
    let floored = |floor: &f64| Program::with_floor(structure, block, loads, Purpose::Utilisation, *floor);
    FLOORS[..=needed].iter().map(floored).collect()
}

/// A balanced field of a block with what it proves.
struct Proved {
    upper: f64,
    sum: f64,
    wrenches: Vec<Wrench>,
    demands: Vec<f64>,
}

/// Brings a field that balances below `limit`. `None` where that fails, or where its
/// sum is no less than it was `before`.
fn prove(
    problem: &Problem<'_>,
    mut wrenches: Vec<Wrench>,
    unit_mechanism: Option<&[Twist]>,
    limit: f64,
    before: &Proved,
) -> Option<Proved> {
    let (mut upper, mut demands) = problem.upper_bound(&wrenches, unit_mechanism, 0.0)?;
    if upper > limit {
        // Demands are convex: a share of the other field brings it back below the limit.
        let share = (upper - limit) / (upper - before.upper) * (1.0 + 1e-3);
        if !(before.upper < limit && share <= MIXED) {
            return None;
        }
        for (wrench, proved) in wrenches.iter_mut().zip(&before.wrenches) {
            *wrench = *wrench * (1.0 - share) + *proved * share;
        }
        (upper, demands) = problem.upper_bound(&wrenches, unit_mechanism, 0.0)?;
    }
    let sum = sum(problem, &wrenches, &demands);
    let less = upper <= limit && sum <= before.sum * (1.0 + NO_MORE);
    less.then_some(Proved { upper, sum, wrenches, demands })
}

/// Strengths that a field demands and normal forces of its contacts, added up, in N.
fn sum(problem: &Problem<'_>, field: &[Wrench], demands: &[f64]) -> f64 {
    let links = problem.block.links.iter().zip(field).zip(demands);
    links
        .map(|((&link, wrench), demand)| match link {
            Link::Connection(i) => demand * strength(problem.structure, i),
            Link::Contact(_) => wrench.force.z.max(0.0),
        })
        .sum()
}

fn strength(structure: &Structure, connection: usize) -> f64 {
    structure.connectors[structure.connections[connection].connector].strength
}

/// A connection's own strength as a variable of the program.
struct Preload {
    link: usize,
    /// Force in N that a variable of 1 stands for.
    scale: f64,
    /// The common utilisation that this strength would be, scaled, per unit.
    t: f64,
    /// Largest value; `None` where the whole sum is less.
    limit: Option<f64>,
}

/// The cone program of one block: the variables of `program`, with a strength of its
/// own for every connection in place of the common t.
struct Least<'p> {
    problem: &'p Problem<'p>,
    limit: f64,
    preloads: Vec<Preload>,
    /// Force in N that counts as 1 in the objective.
    unit: f64,
}

impl<'p> Least<'p> {
    /// With every utilisation at most `limit`, where a field of sum `known` is known.
    fn new(problem: &'p Problem<'p>, limit: f64, known: f64) -> Self {
        let Problem { structure, block, program, .. } = problem;
        let preload = |(index, link): (usize, &Link)| match *link {
            Link::Connection(i) => {
                let (scale, rated) = (program.scales.link[index], strength(structure, i));
                if limit == 0.0 {
                    return None;
                }
                // No strength of the least sum is above the whole of it.
                let limit = (limit * rated < 2.0 * known).then_some(limit * rated / scale);
                Some(Preload { link: index, scale, t: scale / (rated * program.t_scale), limit })
            }
            Link::Contact(_) => None,
        };
        let preloads = block.links.iter().enumerate().filter_map(preload).collect();
        let unit = program.scales.link.iter().copied().fold(0.0, f64::max);
        Self { problem, limit, preloads, unit }
    }

    /// The field that the solver finds and, for its repair, the same as variables of
    /// the program with all strengths at the limit.
    fn solve(&self, attempt: &Attempt) -> Option<(Vec<Wrench>, Iterate)> {
        let program = self.problem.program;
        let (matrix, rhs, cones) = self.constraints();
        let objective = self.objective();
        let nothing = CscMatrix::zeros((objective.len(), objective.len()));
        let mut solver = DefaultSolver::new(&nothing, &objective, &matrix, &rhs, &cones, settings(attempt)?).ok()?;
        solver.solve();
        let x = &solver.solution.x;
        if !x.iter().all(|value| value.is_finite()) {
            return None;
        }
        let (z, strengths) = x.split_at(program.variables);
        let mut field = vec![Wrench::ZERO; program.frames.len()];
        let mut below = vec![self.limit / program.t_scale; program.frames.len()];
        for (preload, value) in self.preloads.iter().zip(strengths) {
            let t = preload.t * value.max(0.0);
            field[preload.link] = program.preload_local[preload.link] * (t * program.t_scale);
            below[preload.link] -= t;
        }
        let mut z = z.to_vec();
        for group in &program.groups {
            let mut local = [0.0; 6];
            group.add_wrench(group.part(&z), &mut local);
            let [a, b, c, d, e, f] = local;
            field[group.link] += Wrench::new([a, b, c].into(), [d, e, f].into());
            z[group.first] += group.rest * below[group.link];
        }
        Some((field, Iterate { v: vec![0.0; program.rows()], z, t: self.limit / program.t_scale }))
    }

    /// Every newton of strength and of contact pressure counts the same.
    fn objective(&self) -> Vec<f64> {
        let Problem { block, program, .. } = self.problem;
        let mut objective = vec![0.0; program.variables];
        for group in &program.groups {
            if let Link::Contact(_) = block.links[group.link] {
                objective[group.first] = group.scale / self.unit;
            }
        }
        objective.extend(self.preloads.iter().map(|preload| preload.scale / self.unit));
        objective
    }

    /// `A x + s = b`, s in the cones: balance first, then what is at least zero or at
    /// most its limit, then the Lorentz cones.
    fn constraints(&self) -> (CscMatrix<f64>, Vec<f64>, Vec<SupportedConeT<f64>>) {
        let program = self.problem.program;
        let mut columns: Vec<Vec<(usize, f64)>> = Vec::with_capacity(program.variables + self.preloads.len());
        for group in &program.groups {
            columns.extend((0..group.len).map(|k| program.entries(group, k)));
        }
        let ties = self.ties();
        columns.extend(self.preloads.iter().map(|preload| self.entries(preload, &ties[preload.link])));
        let mut rhs: Vec<f64> = program.load.iter().map(|load| -load).collect();
        let mut cones = vec![SupportedConeT::ZeroConeT(rhs.len())];
        for group in program.groups.iter().filter(|group| group.cone == Cone::NonNegative) {
            for column in &mut columns[group.first..group.first + group.len] {
                column.push((rhs.len(), -1.0));
                rhs.push(0.0);
            }
        }
        for (preload, column) in self.preloads.iter().zip(&mut columns[program.variables..]) {
            column.push((rhs.len(), -1.0));
            rhs.push(0.0);
            if let Some(limit) = preload.limit {
                column.push((rhs.len(), 1.0));
                rhs.push(limit);
            }
        }
        cones.push(SupportedConeT::NonnegativeConeT(rhs.len() - program.rows()));
        for group in program.groups.iter().filter(|group| group.cone == Cone::Lorentz) {
            for column in &mut columns[group.first..group.first + group.len] {
                column.push((rhs.len(), -1.0));
                rhs.push(0.0);
            }
            cones.push(SupportedConeT::SecondOrderConeT(group.len));
        }
        (compressed(rhs.len(), columns), rhs, cones)
    }

    /// The rows that tie a box component's slacks, by link.
    fn ties(&self) -> Vec<Vec<usize>> {
        let program = self.problem.program;
        let mut ties = vec![Vec::new(); program.frames.len()];
        for group in program.groups.iter().filter(|group| group.ties.is_some()) {
            ties[group.link].extend(group.tie_row);
        }
        ties
    }

    /// The column of a connection's strength in the rows of balance and of its ties.
    fn entries(&self, preload: &Preload, ties: &[usize]) -> Vec<(usize, f64)> {
        let program = self.problem.program;
        let local = program.preload_local[preload.link] * (preload.t * program.t_scale);
        let local = Vector6::from_iterator(local.force.iter().chain(local.torque.iter()).copied());
        let mut entries = Vec::new();
        for side in program.sides[preload.link].iter().flatten() {
            let values = side.map * local;
            entries.extend(values.iter().enumerate().map(|(row, value)| (6 * side.body + row, *value)));
        }
        entries.extend(ties.iter().map(|&row| (row, program.preload[row] * preload.t)));
        entries.retain(|entry| entry.1 != 0.0);
        entries
    }
}

/// Columns of `(row, entry)` as a matrix.
pub(super) fn compressed(height: usize, columns: Vec<Vec<(usize, f64)>>) -> CscMatrix<f64> {
    let width = columns.len();
    let mut starts = Vec::with_capacity(width + 1);
    let (mut rows, mut values) = (Vec::new(), Vec::new());
    starts.push(0);
    for mut column in columns {
        column.sort_unstable_by_key(|entry| entry.0);
        rows.extend(column.iter().map(|entry| entry.0));
        values.extend(column.iter().map(|entry| entry.1));
        starts.push(rows.len());
    }
    CscMatrix::new(height, width, starts, rows, values)
}
