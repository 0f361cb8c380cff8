//! Contact forces that finite stiffness produces, by a fixed point of cone programs.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSolver, IPSolver, SolverStatus, SupportedConeT};

use super::super::blocks::{Block, Link};
use super::super::conic::{Attempt, settings};
use super::super::distribution::compressed;
use super::super::loads::BodyLoad;
use super::super::program::{Cone, Form, Group, Program, Purpose};
use super::super::structure::Structure;
use super::SelfStress;

/// Most programs that are solved for a block.
const ROUNDS: usize = 60;

/// Largest change of a gap, relative to gaps and elastic approaches, at which they stay.
const STAYS: f64 = 1e-4;

/// How many times the elastic energy the work of pressures over the gaps may be.
pub(super) const FAR: f64 = 100.0;

/// Steadiness of gaps' growth (the share of the last growth that is repeated) from which on the
/// next step is longer, and by how much.
const STEADY: f64 = 0.6;
const LONGER: f64 = 2.0;

/// How the solver is asked.
const ATTEMPT: Attempt = Attempt { tolerance: 1e-9, inset: 0.0, regularization: 1e-8 };

/// Lets a block settle elastically from a state without stress.
pub(super) fn settle(structure: &Structure, block: &Block, loads: &[BodyLoad]) -> SelfStress {
    let program = Program::new(structure, block, loads, Purpose::Utilisation);
    let springs = Springs::new(&program, block);
    let mut gaps = vec![0.0; program.groups.len()];
    let (mut before, mut stride): (Option<Vec<f64>>, f64) = (None, 1.0);
    for _ in 0..ROUNDS {
        let Some(settled) = springs.settle(&gaps) else { return SelfStress::Undecided };
        let size = gaps.iter().copied().fold(settled.approach, f64::max);
        let growth: Vec<f64> = settled.slips.iter().zip(&gaps).map(|(slip, gap)| slip - gap).collect();
        if growth.iter().all(|growth| growth.abs() <= STAYS * size) {
            return SelfStress::NotNeeded;
        }
        if settled.work > FAR * settled.energy {
            return SelfStress::ReliedOn;
        }
        let steady = before.as_ref().is_some_and(|before| {
            let along = |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(x, y)| x * y).sum() };
            along(&growth, before) > STEADY * along(before, before)
        });
        stride = if steady { stride * LONGER } else { 1.0 };
        for (gap, growth) in gaps.iter_mut().zip(&growth) {
            *gap = (*gap + stride * growth).max(0.0);
        }
        before = Some(growth);
    }
    SelfStress::Undecided
}

/// A block's links as springs of one stiffness, up to their limits at the rated strengths.
///
/// Variables are those of the program, measured from where a link carries nothing: what
/// strength presses faces and cones with is no force of a spring.
struct Springs<'p> {
    program: &'p Program,
    /// Compliance of each variable, scaled.
    compliance: Vec<f64>,
    /// Where each group's first variable lies when the link carries nothing.
    rest: Vec<f64>,
    /// Which groups are contacts.
    contact: Vec<bool>,
    matrix: CscMatrix<f64>,
    rhs: Vec<f64>,
    cones: Vec<SupportedConeT<f64>>,
    /// Row at which each group's cone begins.
    row: Vec<usize>,
}

/// A state of least energy, with given gaps.
struct Settled {
    /// Slip of every contact times its friction, as a gap.
    slips: Vec<f64>,
    /// Largest elastic approach of a contact, as a gap.
    approach: f64,
    /// Twice the elastic energy.
    energy: f64,
    /// Work of all pressures over the gaps.
    work: f64,
}

impl<'p> Springs<'p> {
    fn new(program: &'p Program, block: &Block) -> Self {
        let unit = program.scales.link.iter().copied().fold(0.0, f64::max);
        let rest: Vec<f64> = program.groups.iter().map(|group| group.rest / program.t_scale).collect();
        let mut columns: Vec<Vec<(usize, f64)>> = Vec::with_capacity(program.variables);
        let mut compliance = Vec::with_capacity(program.variables);
        for group in &program.groups {
            columns.extend((0..group.len).map(|k| program.entries(group, k)));
            let lever = program.lever_of(group.link);
            compliance.extend((0..group.len).map(|k| (force(group, k, lever) / unit).powi(2)));
        }
        let mut rhs: Vec<f64> = program.load.iter().map(|load| -load).collect();
        let mut cones = vec![SupportedConeT::ZeroConeT(rhs.len())];
        let mut row = vec![0; program.groups.len()];
        for wanted in [Cone::NonNegative, Cone::Lorentz] {
            for (index, group) in program.groups.iter().enumerate().filter(|(_, group)| group.cone == wanted) {
                row[index] = rhs.len();
                for k in 0..group.len {
                    columns[group.first + k].push((rhs.len(), -1.0));
                    rhs.push(if k == 0 { rest[index] } else { 0.0 });
                }
                cones.push(match wanted {
                    Cone::Lorentz => SupportedConeT::SecondOrderConeT(group.len),
                    Cone::NonNegative | Cone::Free => SupportedConeT::NonnegativeConeT(group.len),
                });
            }
        }
        let contact = program.groups.iter().map(|group| matches!(block.links[group.link], Link::Contact(_)));
        let contact = contact.collect();
        let matrix = compressed(rhs.len(), columns);
        Self { program, compliance, rest, contact, matrix, rhs, cones, row }
    }

    /// The state of least energy with a gap at each contact that it takes nothing to open and
    /// work to press across. `None` when the solver finds none.
    fn settle(&self, gaps: &[f64]) -> Option<Settled> {
        let mut linear = vec![0.0; self.program.variables];
        for (group, gap) in self.program.groups.iter().zip(gaps) {
            linear[group.first] = *gap;
        }
        let diagonal = (0..self.compliance.len()).collect::<Vec<usize>>();
        let starts = (0..=self.compliance.len()).collect();
        let size = self.compliance.len();
        let energy = CscMatrix::new(size, size, starts, diagonal, self.compliance.clone());
        let mut solver =
            DefaultSolver::new(&energy, &linear, &self.matrix, &self.rhs, &self.cones, settings(&ATTEMPT)?).ok()?;
        solver.solve();
        match solver.solution.status {
            SolverStatus::Solved | SolverStatus::AlmostSolved => {}
            SolverStatus::Unsolved
            | SolverStatus::PrimalInfeasible
            | SolverStatus::DualInfeasible
            | SolverStatus::AlmostPrimalInfeasible
            | SolverStatus::AlmostDualInfeasible
            | SolverStatus::MaxIterations
            | SolverStatus::MaxTime
            | SolverStatus::NumericalError
            | SolverStatus::InsufficientProgress
            | SolverStatus::CallbackTerminated => return None,
        }
        let (y, multipliers) = (&solver.solution.x, &solver.solution.z);
        let mut settled = Settled { slips: vec![0.0; gaps.len()], approach: 0.0, energy: 0.0, work: 0.0 };
        settled.energy = y.iter().zip(&self.compliance).map(|(y, c)| c * y * y).sum();
        for (index, group) in self.program.groups.iter().enumerate().filter(|(index, _)| self.contact[*index]) {
            let pressure = (y[group.first] + self.rest[index]).max(0.0);
            settled.approach = settled.approach.max(pressure * self.compliance[group.first]);
            settled.work += gaps[index] * pressure;
            // The cone's multiplier is the plastic motion; across the normal it is mu times slip.
            let plastic = &multipliers[self.row[index]..self.row[index] + group.len];
            settled.slips[index] = plastic[1..].iter().map(|x| x * x).sum::<f64>().sqrt();
        }
        Some(settled)
    }
}

/// Force in N, or torque over a lever, that a variable of 1 stands for; a mere slack has none.
fn force(group: &Group, k: usize, lever: f64) -> f64 {
    match &group.form {
        Form::Slack => 0.0,
        Form::Axes(axes) => {
            let (axis, factor) = axes[k];
            group.scale * factor.abs() / if axis < 3 { 1.0 } else { lever }
        }
        Form::Point { friction, .. } => group.scale * if k == 0 { 1.0 } else { *friction },
    }
}
