//! Margins of states and moves of one linkage, asked of the stability oracle.
//!
//! Knows transient states and when to stop asking; does not know which states are worth asking about.

use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

use crate::geometry::Motion;
use crate::reconfigure::worst::{self, Instant, Sampling, Worst};
use crate::robot::linkage::Connection;
use crate::spatial::{Pose, Vec3};
use crate::statics::{Bracket, InvalidStructure, Question, Tally, assess};

use super::assembly::{Assembler, Held, Transient};
use super::moves::{Step, View};
use super::problem::Problem;

/// Steps of a turn are at most this long before refinement, in degrees.
const STEP_DEGREES: f64 = 15.0;

/// Around the worst sample, a turn is refined until samples are closer than this, in degrees.
const RESOLUTION_DEGREES: f64 = 1.5;

/// The oracle for the states of one robot.
pub struct Oracle<'a> {
    assembler: Assembler<'a>,
    /// Whether there is neither gravity nor a load.
    is_unloaded: bool,
    /// The first joint of the robot.
    first_joint: Option<Held>,
    solves: AtomicU64,
    tally: Mutex<Tally>,
    fault: Mutex<Option<Vec<InvalidStructure>>>,
}

impl<'a> Oracle<'a> {
    /// For the modules of a problem's start.
    pub fn new(problem: &'a Problem) -> Self {
        let start = &problem.start;
        let first_joint = (0..start.modules.len()).find(|&module| !start.module_type(module).joints.is_empty());
        Self {
            assembler: Assembler::new(start),
            is_unloaded: start.gravity == Vec3::zeros() && start.loads.is_empty(),
            first_joint: first_joint.map(|module| Held::Joint { module, joint: 0 }),
            solves: AtomicU64::new(0),
            tally: Mutex::new(Tally::default()),
            fault: Mutex::new(None),
        }
    }

    /// Structures assessed so far.
    pub fn solves(&self) -> u64 {
        self.solves.load(Ordering::Relaxed)
    }

    /// How they were decided.
    pub fn tally(&self) -> Tally {
        *self.tally.lock().expect("no thread panics while it counts")
    }

    /// What the oracle found wrong with a structure, if it ever did. The margin of such a state counts as unknown.
    pub fn fault(&self) -> Option<Vec<InvalidStructure>> {
        self.fault.lock().expect("no thread panics while it holds the fault").clone()
    }

    /// The margin of every state where there is neither gravity nor a load: nothing is asked of any connection, so
    /// nothing has to be assessed. `None` where there is.
    fn unloaded(&self, engaged: &[Connection], instant: Instant) -> Option<Worst<Held>> {
        self.is_unloaded.then(|| {
            let weakest = self.first_joint.or_else(|| engaged.first().map(|&connection| Held::Ports(connection)));
            Worst { margin: Bracket::new(1.0, 1.0), instant, weakest }
        })
    }

    /// Margin at rest of a robot whose modules stand for these of the start, with these connections engaged.
    pub fn of_state(&self, view: &View, slots: &[usize], engaged: &[Connection]) -> Worst<Held> {
        let engaged = renamed(engaged, slots);
        if let Some(unloaded) = self.unloaded(&engaged, Instant::Rest) {
            return unloaded;
        }
        self.solves.fetch_add(1, Ordering::Relaxed);
        self.ask(&bodies(view, slots, |_, _, pose| pose), &engaged, Instant::Rest)
    }

    /// Margin of the transient states of a move, ends included, with these connections engaged.
    ///
    /// Stops as soon as one state's margin is proved to be below `floor`; then the lower end is minus infinity. The
    /// result does not depend on the number of threads.
    pub fn of_move(
        &self,
        view: &View,
        slots: &[usize],
        engaged: &[Connection],
        step: &Step,
        floor: f64,
    ) -> Worst<Held> {
        let Motion::Rotation { angle, .. } = step.motion else { unreachable!("moves of linkages are turns") };
        let engaged = renamed(engaged, slots);
        if let Some(unloaded) = self.unloaded(&engaged, Instant::Phase(0.0)) {
            return unloaded;
        }
        let degrees = angle.abs().to_degrees();
        let steps = (degrees / STEP_DEGREES - 1e-9).ceil().max(1.0) as u32;
        let sampling = Sampling { steps, resolution: RESOLUTION_DEGREES / degrees };
        let ask = |phase: f64| {
            let displacement = step.motion.at(phase);
            let moved = |module: usize, body: usize, pose: Pose| {
                if view.moves(step, module, body) { displacement * pose } else { pose }
            };
            self.ask(&bodies(view, slots, moved), &engaged, Instant::Phase(phase))
        };
        worst::of_course(sampling, &ask, floor, &self.solves).unwrap_or_else(Worst::cut_short)
    }

    fn ask(&self, bodies: &[Vec<Pose>], engaged: &[Connection], instant: Instant) -> Worst<Held> {
        let assembly = self.assembler.assemble(&Transient { bodies, engaged });
        match assess(&assembly.structure, Question::VALUE) {
            Ok(assessment) => {
                self.tally.lock().expect("no thread panics while it counts").count(&assessment);
                let weakest = assessment.weakest_connection().map(|index| assembly.connections[index]);
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

/// Poses of all bodies, in the order of the start's modules.
fn bodies(view: &View, slots: &[usize], moved: impl Fn(usize, usize, Pose) -> Pose) -> Vec<Vec<Pose>> {
    let mut bodies = vec![Vec::new(); slots.len()];
    for (module, &slot) in slots.iter().enumerate() {
        let own = view.modules[module].bodies.iter().enumerate();
        bodies[slot] = own.map(|(body, &pose)| moved(module, body, pose)).collect();
    }
    bodies
}

/// Connections of modules by those that they stand for.
fn renamed(connections: &[Connection], slots: &[usize]) -> Vec<Connection> {
    let rename = |connection: &Connection| {
        let [a, b] = connection.ports.map(|mut port| {
            port.module = slots[port.module];
            port
        });
        Connection::new(a, b)
    };
    let mut renamed: Vec<Connection> = connections.iter().map(rename).collect();
    renamed.sort_unstable();
    renamed
}
