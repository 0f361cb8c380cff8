//! Contact forces that finite stiffness produces, by a fixed point of cone programs.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSolver, IPSolver, SolverStatus, SupportedConeT};

use super::super::blocks::{Block, Link};
use super::super::conic::{Attempt, settings};
use super::super::distribution::compressed;
use super::super::groups::{Cone, Form, Group};
use super::super::loads::BodyLoad;
use super::super::program::{Program, Purpose};
use super::super::structure::Structure;
use super::SelfStress;

/// Most programs that are solved for a block.
const ROUNDS: usize = 60;

/// Largest change of a gap, as a share of the contact's own approach, at which it stays; and as a
/// share of the largest elastic motion in the block, which the solver's accuracy allows.
const STAYS: f64 = 1e-3;
const ROUNDED: f64 = 1e-6;

/// Share of the largest force from which on a contact presses.
const PRESSES: f64 = 1e-6;

/// How many times its own approach a contact that presses has to slide, times its friction, and for how many rounds
/// in a row its gap has to grow on hardly less than before, before nothing is taken to stop it.
const FAR: f64 = 100.0;
const STEADILY: usize = 4;
const HARDLY_LESS: f64 = 0.9;
const GROWS: f64 = 1e-2;

/// Steadiness of gaps' growth (the share of the last growth that is repeated) from which on the
/// next step is longer, and by how much.
const STEADY: f64 = 0.6;
const LONGER: f64 = 2.0;

/// How the solver is asked, in turn.
const ATTEMPTS: [Attempt; 2] = [
    Attempt { tolerance: 1e-9, inset: 0.0, regularization: 1e-8 },
    Attempt { tolerance: 1e-7, inset: 0.0, regularization: 1e-8 },
];

/// Lets a block settle elastically from a state without stress.
pub(super) fn settle(structure: &Structure, block: &Block, loads: &[BodyLoad]) -> SelfStress {
    let program = Program::new(structure, block, loads, Purpose::Utilisation);
    let springs = Springs::new(&program, block);
    let mut gaps = vec![0.0; program.groups.len()];
    let (mut before, mut stride): (Option<Vec<f64>>, f64) = (None, 1.0);
    let mut steadily = vec![0; program.groups.len()];
    for _ in 0..ROUNDS {
        let settled = ATTEMPTS.iter().find_map(|attempt| springs.settle(&gaps, attempt));
        let Some(settled) = settled else { return SelfStress::Undecided };
        let growth: Vec<f64> = settled.slips.iter().zip(&gaps).map(|(slip, gap)| slip - gap).collect();
        let stays = |(growth, pressure): (&f64, &f64)| growth.abs() <= STAYS * pressure + ROUNDED * settled.largest;
        if growth.iter().zip(&settled.pressures).all(stays) {
            return SelfStress::NotNeeded;
        }
        for (index, steady) in steadily.iter_mut().enumerate() {
            let (growth, pressure) = (growth[index], settled.pressures[index]);
            let less = before.as_ref().is_none_or(|before| growth < HARDLY_LESS * before[index]);
            let grows = pressure > PRESSES * settled.largest && growth > GROWS * pressure;
            *steady = if grows && !less { *steady + 1 } else { 0 };
            if *steady >= STEADILY && gaps[index] > FAR * pressure {
                return SelfStress::ReliedOn;
            }
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
    /// Force in N, or torque over a lever, of each variable.
    force: Vec<f64>,
    /// The largest force scale, by which compliances are measured.
    unit: f64,
}

/// A state of least energy, with given gaps. Motions are measured by the force that they
/// would cause in a contact, in N.
struct Settled {
    /// Slip of every contact times its friction, by group of the program.
    slips: Vec<f64>,
    /// Pressure of every contact, which is its approach.
    pressures: Vec<f64>,
    /// The largest elastic motion of all links.
    largest: f64,
}

impl<'p> Springs<'p> {
    fn new(program: &'p Program, block: &Block) -> Self {
        let unit = program.scales.link.iter().copied().fold(0.0, f64::max);
        let rest: Vec<f64> = program.groups.iter().map(|group| group.rest / program.t_scale).collect();
        let mut columns: Vec<Vec<(usize, f64)>> = Vec::with_capacity(program.variables);
        let mut forces = Vec::with_capacity(program.variables);
        for group in &program.groups {
            columns.extend((0..group.len).map(|k| program.entries(group, k)));
            let lever = program.lever_of(group.link);
            forces.extend((0..group.len).map(|k| force(group, k, lever)));
        }
        let compliance = forces.iter().map(|force| (force / unit).powi(2)).collect();
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
        Self { program, compliance, rest, contact, matrix, rhs, cones, row, force: forces, unit }
    }

    /// The state of least energy with a gap at each contact that it takes nothing to open and
    /// work to press across. `None` when the solver finds none.
    fn settle(&self, gaps: &[f64], attempt: &Attempt) -> Option<Settled> {
        let mut linear = vec![0.0; self.program.variables];
        for (group, gap) in self.program.groups.iter().zip(gaps) {
            linear[group.first] = gap / self.motion(group);
        }
        let diagonal = (0..self.compliance.len()).collect::<Vec<usize>>();
        let starts = (0..=self.compliance.len()).collect();
        let size = self.compliance.len();
        let energy = CscMatrix::new(size, size, starts, diagonal, self.compliance.clone());
        let mut solver =
            DefaultSolver::new(&energy, &linear, &self.matrix, &self.rhs, &self.cones, settings(attempt)?).ok()?;
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
        let strains = y.iter().zip(&self.force).map(|(y, force)| (y * force).abs());
        let mut settled = Settled {
            slips: vec![0.0; gaps.len()],
            pressures: vec![0.0; gaps.len()],
            largest: strains.fold(0.0, f64::max),
        };
        for (index, group) in self.program.groups.iter().enumerate().filter(|(index, _)| self.contact[*index]) {
            settled.pressures[index] = ((y[group.first] + self.rest[index]) * group.scale).max(0.0);
            // The cone's multiplier is the plastic motion; across the normal it is mu times slip.
            let plastic = &multipliers[self.row[index]..self.row[index] + group.len];
            let slip = plastic[1..].iter().map(|x| x * x).sum::<f64>().sqrt();
            settled.slips[index] = slip * self.motion(group);
        }
        Some(settled)
    }

    /// The motion that a multiplier of a contact's first variable of 1 stands for, as a force.
    fn motion(&self, group: &Group) -> f64 {
        self.unit * self.unit / group.scale
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
