//! Linkages: a move turns everything on one side of a joint or connection.
//!
//! Two states are the same if their joints and connections are, in integers, and their modules are in the same places
//! in the world: also where nothing in the world would tell, since what follows is said in its frame.

mod clearance;
#[cfg(test)]
mod clearance_laws;
mod nesting;
mod place;
#[cfg(test)]
mod tests;

use std::collections::HashMap;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

use crate::geometry::{Motion, Surroundings};
use crate::reconfigure::linkage::Action;
use crate::reconfigure::linkage::assembly::{Assembler, Assembly, Held, Touched, Transient};
use crate::reconfigure::linkage::replay::legality::{Path, transition};
use crate::reconfigure::linkage::replay::transit::{first_hit, first_passed, is_connected};
use crate::reconfigure::plan::Plan;
use crate::reconfigure::refusal::Refusal;
use crate::reconfigure::replay::Fault;
use crate::reconfigure::worst::Sampling;
use crate::robot::linkage::{Connection, Linkage};
use crate::spatial::{Pose, Vec3};
use crate::statics::{Bracket, Question, assess};

use super::family::{Family, Kind};
use super::growth::{Growth, least};
use super::{Because, OrderError, OrderOptions, PartialOrder, product};
use nesting::{Nesting, Turn};
use place::{Place, difference};

/// Steps of a turn are at most this long before refinement, in degrees, as the planner's.
const STEP_DEGREES: f64 = 15.0;

/// Around the worst sample, a turn is refined until samples are closer than this, in degrees.
const RESOLUTION_DEGREES: f64 = 1.5;

/// As [`partial_order`](super::partial_order), for linkages.
///
/// # Guarantees
/// See the [module](super). The result does not depend on the number of threads, nor on time unless a deadline or a
/// cancellation ended the work early; what it allows is checked then as well.
///
/// # Errors
/// [`OrderError::Broken`] for a plan that does not hold in its own order.
pub fn partial_order(
    start: &Linkage,
    plan: &Plan<Action, Held>,
    options: &OrderOptions,
) -> Result<PartialOrder<Touched>, OrderError<Touched>> {
    Growth::new(Linkages::new(start, least(options.required)), plan, options).grown()
}

/// What a move out of a place hits, if anything.
type Hits = HashMap<(Place, Action), Option<Fault<Touched>>>;

/// A robot of modules with joints or ports that roll.
struct Linkages<'a> {
    start: &'a Linkage,
    assembler: Assembler<'a>,
    around: Surroundings,
    off_limits: Surroundings,
    /// Margin that every state must have.
    least: f64,
    /// Structures that the oracle has assessed.
    solves: AtomicU64,
    /// What moves hit out of places, by themselves.
    hits: Mutex<Hits>,
}

impl<'a> Linkages<'a> {
    fn new(start: &'a Linkage, least: f64) -> Self {
        let [around, off_limits] = [&start.environment, &start.require.off_limits()].map(Surroundings::new);
        let (solves, hits) = (AtomicU64::new(0), Mutex::default());
        Self { start, assembler: Assembler::new(start), around, off_limits, least, solves, hits }
    }

    /// What a move hits on its way: nothing else is under way.
    fn hit(&self, state: &Linkage, action: &Action, path: &Path) -> Option<Fault<Touched>> {
        let key = (self.place(state), *action);
        let known = || self.hits.lock().expect("no thread panics while it holds what is hit");
        if let Some(hit) = known().get(&key) {
            return hit.clone();
        }
        let collision = first_hit(state, &self.around, path).map(|(_, with)| Fault::Collision { with });
        let passed = || first_passed(state, &self.off_limits, path).map(|(_, region)| Fault::KeepOut { region });
        let hit = collision.or_else(passed);
        known().insert(key, hit.clone());
        hit
    }

    /// The margin at these phases of what is under way.
    fn margin(
        &self,
        state: &Linkage,
        before: &[Vec<Pose>],
        nesting: &Nesting,
        phases: &[f64],
    ) -> Result<Result<Bracket, Because<Touched>>, Refusal> {
        let bodies = nesting.poses(before, phases);
        let mut assembly = self.assembler.assemble(&Transient { bodies: &bodies, engaged: &state.connections });
        leave_out_chance(&mut assembly, nesting);
        self.solves.fetch_add(1, Ordering::Relaxed);
        let margin = assess(&assembly.structure, Question::VALUE).map_err(Refusal::Structure)?.margin();
        Ok(if margin.lower >= self.least { Ok(margin) } else { Err(Because::Unstable) })
    }
}

/// Leaves out the contacts of bodies whose place to each other, or to what surrounds them, hangs on more than one
/// phase: that they touch is chance, and to leave a contact out never flatters.
fn leave_out_chance(assembly: &mut Assembly, nesting: &Nesting) {
    let is_sure = |(body, touched): &(_, Touched)| match touched {
        Touched::Body(other) => nesting.between(*body, *other).map(<[usize]>::len).iter().sum::<usize>() < 2,
        Touched::Ground | Touched::Obstacle(_) => nesting.carriers(*body).len() < 2,
    };
    let sure: Vec<bool> = assembly.contacts.iter().map(is_sure).collect();
    let kept = |index: &mut usize| {
        *index += 1;
        sure[*index - 1]
    };
    let (mut contact, mut name) = (0, 0);
    assembly.structure.contacts.retain(|_| kept(&mut contact));
    assembly.contacts.retain(|_| kept(&mut name));
}

impl Family for Linkages<'_> {
    type State = Linkage;
    type Action = Action;
    type Held = Held;
    type Touched = Touched;
    type Connection = Connection;
    type Place = Place;

    fn start(&self) -> Linkage {
        let mut start = self.start.clone();
        start.connections.sort_unstable();
        start
    }

    fn kind(action: &Action) -> Kind {
        match action {
            Action::Attach(_) => Kind::Attach,
            Action::Detach(_) => Kind::Detach,
            Action::Roll { .. } | Action::Rotate { .. } => Kind::Move,
        }
    }

    /// Both turn the same joint, or concern the same connection.
    fn bound(one: &Action, other: &Action) -> Option<Because<Touched>> {
        let held = |action: &Action| match *action {
            Action::Attach(connection) | Action::Detach(connection) | Action::Roll { connection, .. } => {
                Held::Ports(connection)
            }
            Action::Rotate { module, joint, .. } => Held::Joint { module, joint },
        };
        (held(one) == held(other)).then_some(Because::SameJoint)
    }

    fn place(&self, state: &Linkage) -> Place {
        Place::of(state)
    }

    fn connections(state: &Linkage) -> &[Connection] {
        &state.connections
    }

    fn difference(&self, one: &Linkage, other: &Linkage) -> Option<Because<Touched>> {
        difference(one, other)
    }

    fn take(&self, state: &Linkage, action: &Action) -> Result<Linkage, Because<Touched>> {
        let next = transition(state, action).map_err(Because::NotLegal)?;
        match next.path.and_then(|path| self.hit(state, action, &path)) {
            Some(fault) => Err(Because::NotLegal(fault)),
            None => Ok(next.after),
        }
    }

    fn worst(&self, state: &Linkage, moves: &[Action]) -> Result<Result<Bracket, Because<Touched>>, Refusal> {
        let turns: Result<Vec<Option<Turn>>, _> = moves.iter().map(|action| Turn::of(state, action)).collect();
        let turns: Vec<Turn> = match turns {
            Ok(turns) => turns.into_iter().flatten().collect(),
            Err(fault) => return Ok(Err(Because::NotLegal(fault))),
        };
        let nesting = match Nesting::of(state, &turns) {
            Ok(nesting) => nesting,
            Err(because) => return Ok(Err(because)),
        };
        if state.require.connected && !is_connected(state) {
            return Ok(Err(Because::Disconnected));
        }
        if !clearance::is_clear(state, &nesting, [&self.around, &self.off_limits]) {
            return Ok(Err(Because::WaysCross));
        }
        if state.gravity == Vec3::zeros() && state.loads.is_empty() {
            // Nothing is asked of any connection.
            return Ok(if 1.0 >= self.least { Ok(Bracket::new(1.0, 1.0)) } else { Err(Because::Unstable) });
        }
        let before: Vec<Vec<Pose>> = (0..state.modules.len()).map(|module| state.body_poses(module)).collect();
        let samplings: Vec<Sampling> = (0..turns.len()).map(|turn| sampling(nesting.motion(turn))).collect();
        product::worst(&samplings, |phases| self.margin(state, &before, &nesting, phases))
    }

    fn solves(&self) -> u64 {
        self.solves.load(Ordering::Relaxed)
    }
}

/// How a turn is sampled.
fn sampling(motion: &Motion) -> Sampling {
    let degrees = match motion {
        Motion::Rotation { angle, .. } => angle.abs().to_degrees(),
        Motion::Translation { .. } => 0.0,
    };
    let steps = (degrees / STEP_DEGREES - 1e-9).ceil().max(1.0) as u32;
    Sampling { steps, resolution: RESOLUTION_DEGREES / degrees }
}
