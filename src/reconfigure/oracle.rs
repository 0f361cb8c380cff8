//! Margins of states and moves of one robot, asked of the stability oracle.
//!
//! Knows transient states and when to stop asking; does not know which states
//! are worth asking about.

use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

use crate::robot::{Cell, Configuration, Face, Occupancy, Placement};
use crate::spatial::Vec3;
use crate::statics::{
    Anchor, Assessment, Bracket, InvalidStructure, Load, Memory, NotNear, Question, Tally, assess, assess_keeping,
    assess_near,
};

use super::assembly::{Assembler, Assembly, Engagement, Transient};
use super::course::{Course, engagement};
use super::decision::{self, Wanted};
use super::hanging::Rest;
use super::layout::Bond;
use super::moves::Move;
use super::sampling;
use super::worst;

pub use super::worst::Instant;

/// Two modules that hold each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Seam {
    /// Their cells; of a module on its way, the one that it left.
    pub cells: [Cell; 2],
    /// World direction of the first one's face.
    pub towards: Face,
}

/// The worst of some states.
pub type Worst = worst::Worst<Seam>;

/// The oracle for the states of one robot.
pub struct Oracle<'a> {
    configuration: &'a Configuration,
    assembler: Assembler<'a>,
    pitch: f64,
    solves: AtomicU64,
    /// Says what time it is.
    pub(super) clock: Option<fn() -> Duration>,
    taken: Mutex<Duration>,
    tally: Mutex<Tally>,
    fault: Mutex<Option<Vec<InvalidStructure>>>,
}

impl<'a> Oracle<'a> {
    /// For the modules of `configuration`, in its environment and under its loads.
    pub fn new(configuration: &'a Configuration) -> Self {
        Self {
            configuration,
            assembler: Assembler::new(configuration),
            pitch: configuration.pitch(),
            solves: AtomicU64::new(0),
            clock: None,
            taken: Mutex::new(Duration::ZERO),
            tally: Mutex::new(Tally::default()),
            fault: Mutex::new(None),
        }
    }

    /// Structures assessed so far.
    pub fn solves(&self) -> u64 {
        self.solves.load(Ordering::Relaxed)
    }

    /// Time that this took, by the clock that was given.
    pub fn taken(&self) -> Duration {
        *self.taken.lock().expect("no thread panics while it adds")
    }

    /// Books structures that were assessed elsewhere.
    pub fn add(&self, elsewhere: &Tally) {
        self.solves.fetch_add(elsewhere.total(), Ordering::Relaxed);
        self.tally.lock().expect("no thread panics while it counts").merge(elsewhere);
    }

    /// Books the time of some work. What the time is influences nothing.
    pub fn timed<T>(&self, work: impl FnOnce() -> T) -> T {
        let Some(clock) = self.clock else { return work() };
        let began = clock();
        let done = work();
        *self.taken.lock().expect("no thread panics while it adds") += clock().saturating_sub(began);
        done
    }

    /// What it took to assess them.
    pub fn tally(&self) -> Tally {
        *self.tally.lock().expect("no thread panics while it counts")
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
        self.timed(|| self.ask(&Transient { placements, moving: None, engaged: &engaged }, Instant::Rest))
    }

    /// Margin of the transient states of a move. `bonds` are the connections before it.
    ///
    /// Stops as soon as one state's margin is proved to be below `floor`; then the lower end is
    /// minus infinity. The result does not depend on the number of threads.
    pub fn of_move(&self, before: Vec<Placement>, bonds: &[Bond], step: Move, floor: f64) -> Worst {
        let course = Course::new(before, bonds, step, self.pitch).expect("a legal move has a module and a support");
        let ask = |phase: f64| self.ask(&course.at(phase), Instant::Phase(phase));
        self.timed(|| worst::of_course(sampling::of(step), &ask, floor, &self.solves)).unwrap_or_else(Worst::cut_short)
    }

    /// Upper bound on the margin of a move: with all modules but the moving one held
    /// immovably, at every 45 degrees of a pivot or half-way through a slide, ends left out.
    ///
    /// Holding a body drops its balance from the program, so the utilisation of what is left is
    /// a lower bound: a problem of one body, in closed form where only a hinge holds it.
    pub fn at_most(&self, before: Vec<Placement>, step: Move) -> f64 {
        // What holds the others to each other plays no part.
        let course = Course::new(before, &[], step, self.pitch).expect("a legal move has a module and a support");
        let margins = sampling::coarse(step).map(|phase| {
            let state = course.at(phase);
            self.solves.fetch_add(1, Ordering::Relaxed);
            self.read(&self.assembler.assemble_alone(&state), &state, Instant::Phase(phase)).margin.upper
        });
        self.timed(|| margins.fold(f64::INFINITY, f64::min))
    }

    /// The worst of all samples of a move with all modules but the moving one held immovably.
    pub fn own_worst(&self, before: Vec<Placement>, step: Move) -> Worst {
        let course = Course::new(before, &[], step, self.pitch).expect("a legal move has a module and a support");
        let ask = |phase: f64| {
            let state = course.at(phase);
            self.read(&self.assembler.assemble_alone(&state), &state, Instant::Phase(phase))
        };
        let worst = || worst::of_course(sampling::of(step), &ask, f64::NEG_INFINITY, &self.solves);
        self.timed(worst).unwrap_or_else(|fallen| fallen)
    }

    /// Margin of a move at one phase. `bonds` are the connections before it.
    pub fn of_phase(&self, before: Vec<Placement>, bonds: &[Bond], step: Move, phase: f64) -> Worst {
        let course = Course::new(before, bonds, step, self.pitch).expect("a legal move has a module and a support");
        self.solves.fetch_add(1, Ordering::Relaxed);
        self.timed(|| self.ask(&course.at(phase), Instant::Phase(phase)))
    }

    /// Margin of the transient states of a move with all modules but the moving one held immovably. `on_sample` is given each
    /// phase with what the module does to the others then, in the field that proves its margin. `None` where the module falls.
    pub fn own_course(
        &self,
        course: &Course,
        step: Move,
        on_sample: &(impl Fn(f64, Vec<Load>) + Sync),
    ) -> Option<Worst> {
        let ask = |phase: f64| {
            let (state, instant) = (course.at(phase), Instant::Phase(phase));
            let assembly = self.assembler.assemble_alone(&state);
            match assess(&assembly.structure, Question::VALUE) {
                Ok(assessment) => {
                    on_sample(phase, on_others(&assembly, &assessment, &state));
                    self.worst(&assessment, &assembly, &state, instant)
                }
                Err(problems) => self.unknown(problems, instant),
            }
        };
        let worst = worst::of_course(sampling::of(step), &ask, f64::NEG_INFINITY, &self.solves).ok()?;
        worst.margin.lower.is_finite().then_some(worst)
    }

    /// All modules of a state but one: see [`Rest::new`].
    pub fn rest(&self, of: (usize, &[Placement], &[Engagement]), memory: Option<Memory>) -> Rest {
        Rest::new(self.configuration, &self.assembler, of, memory)
    }

    /// Whether the margin at rest is at least `floor`, with these placements and connections, and what neighbouring states
    /// can use of the answer. `near` is what was left by one: its memory, and which of its modules each one was.
    pub fn decides_state(
        &self,
        placements: &[Placement],
        bonds: &[Bond],
        floor: f64,
        near: Option<(&Memory, &[Option<usize>])>,
    ) -> (Worst, Option<Memory>) {
        let occupancy = Occupancy::of_placements(placements);
        let engaged: Vec<_> = bonds.iter().filter_map(|&bond| engagement(&occupancy, bond)).collect();
        let state = Transient { placements, moving: None, engaged: &engaged };
        self.timed(|| self.ask_near(&state, Instant::Rest, Wanted::AtLeast(floor), near))
    }

    /// Whether the margin of the transient states of a move is at least `floor`: like
    /// [`of_move`](Self::of_move), of the same states, but known no better than that takes. `near` is the memory of a
    /// state at rest with the same placements.
    pub fn decides_move(
        &self,
        before: Vec<Placement>,
        bonds: &[Bond],
        step: Move,
        floor: f64,
        near: Option<&Memory>,
    ) -> Worst {
        self.timed(|| self.decides_course(before, bonds, step, floor, near))
    }

    fn decides_course(
        &self,
        before: Vec<Placement>,
        bonds: &[Bond],
        step: Move,
        floor: f64,
        near: Option<&Memory>,
    ) -> Worst {
        let same: Vec<Option<usize>> = (0..before.len()).map(Some).collect();
        let course = Course::new(before, bonds, step, self.pitch).expect("a legal move has a module and a support");
        let sampling = sampling::of(step);
        let ask = |phase: f64, wanted: Wanted, near: Option<&Memory>| {
            let near = near.map(|memory| (memory, same.as_slice()));
            self.ask_near(&course.at(phase), Instant::Phase(phase), wanted, near)
        };
        let first = sampling.initial_phases().next().expect("a move has samples");
        let (decided, memory) = ask(first, Wanted::AtLeast(floor), near);
        if decided.is_out(floor) {
            return decided.cut_short();
        }
        // All others have this one as their neighbour, so that they can be looked at in any order.
        let memory = memory.as_ref();
        let worst = ask(first, Wanted::Value, memory).0;
        if worst.is_out(floor) {
            return worst.cut_short();
        }
        let ask = |phase: f64, wanted: Wanted| ask(phase, wanted, memory).0;
        decision::of_course(sampling, (first, worst), floor, &ask).unwrap_or_else(Worst::cut_short)
    }

    fn ask_near(
        &self,
        state: &Transient,
        instant: Instant,
        wanted: Wanted,
        near: Option<(&Memory, &[Option<usize>])>,
    ) -> (Worst, Option<Memory>) {
        self.solves.fetch_add(1, Ordering::Relaxed);
        let question = match wanted {
            // A margin is one less a utilisation; rounding must not take back what was decided.
            Wanted::AtLeast(margin) => {
                Question::Decide((1.0 - margin) - 4.0 * f64::EPSILON * (1.0 - margin).abs().max(1.0))
            }
            Wanted::Value => Question::VALUE,
        };
        let assembly = self.assembler.assemble(state);
        let answer = match near {
            Some((memory, matching)) => assess_near(&assembly.structure, question, memory, matching),
            None => assess_keeping(&assembly.structure, question).map_err(NotNear::Structure),
        };
        match answer {
            Ok((assessment, memory)) => (self.worst(&assessment, &assembly, state, instant), Some(memory)),
            Err(NotNear::Structure(problems)) => (self.unknown(problems, instant), None),
            Err(NotNear::Length { .. } | NotNear::NoSuchBody { .. }) => unreachable!("memories are of the same robot"),
        }
    }

    fn ask(&self, state: &Transient, instant: Instant) -> Worst {
        self.read(&self.assembler.assemble(state), state, instant)
    }

    fn read(&self, assembly: &Assembly, state: &Transient, instant: Instant) -> Worst {
        match assess(&assembly.structure, Question::VALUE) {
            Ok(assessment) => self.worst(&assessment, assembly, state, instant),
            Err(problems) => self.unknown(problems, instant),
        }
    }

    fn worst(&self, assessment: &Assessment, assembly: &Assembly, state: &Transient, instant: Instant) -> Worst {
        self.tally.lock().expect("no thread panics while it counts").count(assessment);
        let weakest = assessment.weakest_connection().map(|i| state.engaged[assembly.connections[i]]);
        let weakest = weakest.map(|held| seam(&held, state.placements));
        Worst { margin: assessment.margin(), instant, weakest }
    }

    /// The margin of a state that cannot be assessed.
    fn unknown(&self, problems: Vec<InvalidStructure>, instant: Instant) -> Worst {
        let mut fault = self.fault.lock().expect("no thread panics while it holds the fault");
        fault.get_or_insert(problems);
        Worst { margin: Bracket::new(f64::NEG_INFINITY, f64::INFINITY), instant, weakest: None }
    }
}

/// What the moving module of a state does to the others, in the field that an assessment shows.
fn on_others(assembly: &Assembly, assessment: &Assessment, state: &Transient) -> Vec<Load> {
    let structure = &assembly.structure;
    let moving = state.moving.map(|moving| Anchor::Body(moving.module));
    let mut loads = Vec::new();
    let mut act = |on: Anchor, force: Vec3, torque: Vec3, at: Vec3| {
        if let Anchor::Body(body) = on {
            loads.push(Load { body, force, torque, at: Some(at) });
        }
    };
    for (connection, held) in structure.connections.iter().zip(&assessment.connections) {
        let turn = connection.frame.rotation;
        let (force, torque) = (turn * held.wrench.force, turn * held.wrench.torque);
        let at = connection.frame.translation.vector;
        if Some(connection.child) == moving {
            act(connection.parent, -force, -torque, at);
        } else if Some(connection.parent) == moving {
            act(connection.child, force, torque, at);
        }
    }
    for (contact, &force) in structure.contacts.iter().zip(&assessment.contacts) {
        if Some(Anchor::Body(contact.body)) == moving {
            act(contact.against, -force, Vec3::zeros(), contact.position);
        } else if Some(contact.against) == moving {
            act(Anchor::Body(contact.body), force, Vec3::zeros(), contact.position);
        }
    }
    loads
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
