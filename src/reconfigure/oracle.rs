//! Margins of states and moves of one robot, asked of the stability oracle.
//!
//! Knows transient states and when to stop asking; does not know which states
//! are worth asking about.

use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

use rayon::prelude::*;

use crate::robot::{Cell, Configuration, Face, Occupancy, Placement};
use crate::statics::{Bracket, InvalidStructure, Question, assess};

use super::assembly::{Assembler, Assembly, Engagement, Transient};
use super::course::{Course, engagement};
use super::layout::Bond;
use super::moves::{Motion, Move};
use super::sampling;

/// When a margin is attained.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Instant {
    /// At this phase of a move, from 0 to 1.
    Phase(f64),
    /// In a state at rest.
    Rest,
}

/// Two modules that hold each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Seam {
    /// Their cells; of a module on its way, the one that it left.
    pub cells: [Cell; 2],
    /// World direction of the first one's face.
    pub towards: Face,
}

/// The worst of some states.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Worst {
    /// Smallest margin.
    pub margin: Bracket,
    /// When.
    pub instant: Instant,
    /// The connection that is weakest then, if any holds at all.
    pub weakest: Option<Seam>,
}

/// The oracle for the states of one robot.
pub struct Oracle<'a> {
    assembler: Assembler<'a>,
    pitch: f64,
    solves: AtomicU64,
    relaxed: AtomicU64,
    fault: Mutex<Option<Vec<InvalidStructure>>>,
}

impl<'a> Oracle<'a> {
    /// For the modules of `configuration`, in its environment and under its loads.
    pub fn new(configuration: &'a Configuration) -> Self {
        Self {
            assembler: Assembler::new(configuration),
            pitch: configuration.pitch(),
            solves: AtomicU64::new(0),
            relaxed: AtomicU64::new(0),
            fault: Mutex::new(None),
        }
    }

    /// Structures assessed so far.
    pub fn solves(&self) -> u64 {
        self.solves.load(Ordering::Relaxed)
    }

    /// Moves that the moving module alone ruled out, without a solve.
    pub fn ruled_out(&self) -> u64 {
        self.relaxed.load(Ordering::Relaxed)
    }

    /// What the oracle found wrong with a structure, if it ever did. The margin
    /// of such a state counts as unknown.
    pub fn fault(&self) -> Option<Vec<InvalidStructure>> {
        self.fault.lock().expect("no thread panics while it holds the fault").clone()
    }

    /// Margin at rest, with these placements and connections.
    pub fn of_state(&self, placements: &[Placement], bonds: &[Bond]) -> Worst {
        let occupancy = Occupancy::of_placements(placements);
        let engaged: Vec<_> = bonds.iter().filter_map(|&bond| engagement(&occupancy, bond)).collect();
        self.solves.fetch_add(1, Ordering::Relaxed);
        self.ask(&Transient { placements, moving: None, engaged: &engaged }, Instant::Rest)
    }

    /// Margin of a move: of all its transient states and of the state that it
    /// ends in. `bonds` are the connections before it, `after` those after it.
    ///
    /// Stops as soon as one state's margin is proved to be below `floor`; then the lower end is
    /// minus infinity. The result does not depend on the number of threads.
    pub fn of_move(&self, before: Vec<Placement>, bonds: &[Bond], step: Move, rest: &Rest, floor: f64) -> Worst {
        let course = Course::new(before, bonds, step, self.pitch).expect("a legal move has a module and a support");
        if let Some(out) = self.rule_out(&course, step, floor) {
            return out.cut_short();
        }
        match self.of_course(&course, step, floor) {
            Err(out) => out.cut_short(),
            // The state at rest after a slide is the one at its last phase.
            Ok(worst) if matches!(step.motion, Motion::Slide { .. }) => worst,
            Ok(worst) => {
                let settled = self.of_state(&rest.placements, &rest.bonds);
                if is_out(&settled, floor) { settled.cut_short() } else { worst.or_worse(settled) }
            }
        }
    }

    /// A state of the move whose margin is below `floor` even if all modules but
    /// the moving one are held immovably, if there is one.
    ///
    /// Holding a body drops its balance from the program, so the utilisation of what is left is
    /// a lower bound: a problem of one body, in closed form where only a hinge holds it.
    fn rule_out(&self, course: &Course, step: Move, floor: f64) -> Option<Worst> {
        if floor == f64::NEG_INFINITY {
            return None;
        }
        let out = initial_phases(step).find_map(|phase| {
            let state = course.at(phase);
            let mut assembly = self.assembler.assemble(&state);
            let moving = state.moving.map(|moving| moving.module);
            for (module, body) in assembly.structure.bodies.iter_mut().enumerate() {
                body.fixed |= Some(module) != moving;
            }
            let worst = self.read(&assembly, &state, Instant::Phase(phase));
            (worst.margin.upper < floor).then_some(worst)
        });
        self.relaxed.fetch_add(u64::from(out.is_some()), Ordering::Relaxed);
        out
    }

    /// The worst sample, refined; `Err` with the first that is out.
    fn of_course(&self, course: &Course, step: Move, floor: f64) -> Result<Worst, Worst> {
        let initial: Vec<f64> = initial_phases(step).collect();
        let mut samples = self.sample(course, &initial, floor)?;
        loop {
            samples.sort_by(|(a, _), (b, _)| a.total_cmp(b));
            let worst = (0..samples.len())
                .min_by(|&a, &b| samples[a].1.margin.lower.total_cmp(&samples[b].1.margin.lower))
                .expect("a move has samples");
            let around = [worst.checked_sub(1).map(|before| [before, worst]), Some([worst, worst + 1])];
            let gaps = around.into_iter().flatten().filter(|&[_, high]| high < samples.len());
            let wide = gaps.map(|[a, b]| [samples[a].0, samples[b].0]);
            let wide = wide.filter(|[low, high]| high - low >= sampling::resolution(step));
            let middles: Vec<f64> = wide.map(|[low, high]| f64::midpoint(low, high)).collect();
            if middles.is_empty() {
                let margin = samples.iter().map(|(_, w)| w.margin).reduce(Bracket::min);
                return Ok(Worst { margin: margin.expect("a move has samples"), ..samples[worst].1 });
            }
            samples.extend(self.sample(course, &middles, floor)?);
        }
    }

    /// Margins at these phases, in this order; `Err` with the first that is out.
    fn sample(&self, course: &Course, phases: &[f64], floor: f64) -> Result<Vec<(f64, Worst)>, Worst> {
        let mut samples = Vec::with_capacity(phases.len());
        for together in phases.chunks(rayon::current_num_threads().max(1)) {
            let ask = |&phase: &f64| self.ask(&course.at(phase), Instant::Phase(phase));
            let worsts: Vec<Worst> = match together {
                [phase] => vec![ask(phase)],
                _ => together.par_iter().map(ask).collect(),
            };
            for (&phase, worst) in together.iter().zip(worsts) {
                self.solves.fetch_add(1, Ordering::Relaxed);
                if is_out(&worst, floor) {
                    return Err(worst);
                }
                samples.push((phase, worst));
            }
        }
        Ok(samples)
    }

    fn ask(&self, state: &Transient, instant: Instant) -> Worst {
        self.read(&self.assembler.assemble(state), state, instant)
    }

    fn read(&self, assembly: &Assembly, state: &Transient, instant: Instant) -> Worst {
        match assess(&assembly.structure, Question::Value) {
            Ok(assessment) => {
                let weakest = assessment.weakest_connection().map(|i| state.engaged[assembly.connections[i]]);
                let weakest = weakest.map(|held| seam(&held, state.placements));
                Worst { margin: assessment.margin(), instant, weakest }
            }
            Err(problems) => {
                let mut fault = self.fault.lock().expect("no thread panics while it holds the fault");
                fault.get_or_insert(problems);
                Worst { margin: Bracket::new(f64::NEG_INFINITY, f64::INFINITY), instant, weakest: None }
            }
        }
    }
}

/// The phases sampled before refinement: the middle and the ends first, which are out most often.
fn initial_phases(step: Move) -> impl Iterator<Item = f64> {
    let steps = sampling::steps(step);
    let first = [steps / 2, steps, 0];
    let others = (1..steps).filter(move |i| !first.contains(i));
    first.into_iter().chain(others).map(move |i| f64::from(i) / f64::from(steps))
}

/// The state that a move ends in.
#[derive(Clone, Debug)]
pub struct Rest {
    /// Placements after the move.
    pub placements: Vec<Placement>,
    /// Connections after the move.
    pub bonds: Vec<Bond>,
}

impl Worst {
    /// The worse of two; of equals the first.
    #[must_use]
    pub fn or_worse(self, other: Self) -> Self {
        let margin = self.margin.min(other.margin);
        if other.margin.lower < self.margin.lower { Self { margin, ..other } } else { Self { margin, ..self } }
    }

    /// What is known when other states were not asked about.
    fn cut_short(self) -> Self {
        Self { margin: Bracket::new(f64::NEG_INFINITY, self.margin.upper), ..self }
    }
}

/// Whether no more need be known.
fn is_out(worst: &Worst, floor: f64) -> bool {
    worst.margin.upper < floor || worst.margin.upper == f64::NEG_INFINITY
}

fn seam(engagement: &Engagement, placements: &[Placement]) -> Seam {
    let cells = engagement.modules().map(|module| placements[module].cell);
    let towards = match *engagement {
        Engagement::Face { towards, .. } => towards,
        // The support of a pivot is the neighbour of the module that left.
        Engagement::Hinge { .. } => {
            let step = std::array::from_fn(|i| cells[1][i] - cells[0][i]);
            Face::from_step(step).expect("a module pivots about an edge of a neighbour")
        }
    };
    Seam { cells, towards }
}
