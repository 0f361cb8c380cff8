//! Modules in a lattice: one module at a time is moved by an action.

mod overlap;

use std::sync::atomic::{AtomicU64, Ordering};

use petgraph::unionfind::UnionFind;

use crate::geometry::{Motion, Solid, Surrounding, Surroundings, first_collision};
use crate::reconfigure::action::Action;
use crate::reconfigure::assembly::{Assembler, Moment, Moving, Touched};
use crate::reconfigure::refusal::Refusal;
use crate::reconfigure::replay::Fault;
use crate::reconfigure::replay::legality::{Path, transition};
use crate::reconfigure::worst::Sampling;
use crate::robot::{Configuration, FaceConnection, Placement};
use crate::spatial::Pose;
use crate::statics::{Bracket, Question, assess};

use super::family::{Family, Kind};
use super::{Because, product};
use overlap::{are_apart, engaged};

/// Distance in cells between the samples of a translation before refinement, as the planner samples one.
const CELL_STEP: f64 = 1.0 / 8.0;

/// Around the worst sample, a translation is refined until samples are closer than this, in cells.
const CELL_RESOLUTION: f64 = 1.0 / 64.0;

/// Angle in degrees between the samples of a turn before refinement.
const TURN_STEP: f64 = 15.0;

/// Around the worst sample, a turn is refined until samples are closer than this, in degrees.
const TURN_RESOLUTION: f64 = 1.5;

/// A robot of lattice modules.
pub struct Lattice<'a> {
    start: &'a Configuration,
    assembler: Assembler<'a>,
    around: Surroundings,
    off_limits: Surroundings,
    /// Margin that every state must have.
    least: f64,
    /// Structures that the oracle has assessed.
    solves: AtomicU64,
}

impl<'a> Lattice<'a> {
    /// The robot of a start, every state of which must have the margin `least`.
    pub fn new(start: &'a Configuration, least: f64) -> Self {
        let [around, off_limits] = [&start.environment, &start.require.off_limits()].map(Surroundings::new);
        Self { start, assembler: Assembler::new(start), around, off_limits, least, solves: AtomicU64::new(0) }
    }

    /// What a module hits on its way.
    fn hits(&self, state: &Configuration, path: &Path) -> Result<(), Fault> {
        let solid = |m: usize| Solid::new(state.module_type(m).body().shape.clone(), state.pose(m));
        let moving = solid(path.module);
        if let Some((_, what)) = self.around.first_collision(&moving, &path.motion) {
            return Err(Fault::Collision { with: what.into() });
        }
        if let Some((_, Surrounding::Obstacle(region))) = self.off_limits.first_collision(&moving, &path.motion) {
            return Err(Fault::KeepOut { region });
        }
        let mut others = (0..state.modules.len()).filter(|&m| m != path.module);
        match others.find(|&m| first_collision(&moving, &path.motion, &solid(m)).is_some()) {
            Some(module) => Err(Fault::Collision { with: Touched::Module(module) }),
            None => Ok(()),
        }
    }

    fn margin(&self, state: &Configuration, moment: &Moment) -> Result<Result<Bracket, Because>, Refusal> {
        let assembly = self.assembler.assemble_moment(moment);
        if state.require.connected {
            let mut components = UnionFind::<usize>::new(state.modules.len());
            let held = assembly.connections.iter().map(|&i| moment.engaged[i].modules());
            let joined = held.filter(|&[a, b]| components.union(a, b)).count();
            if joined + 1 < state.modules.len() {
                return Ok(Err(Because::Disconnected));
            }
        }
        self.solves.fetch_add(1, Ordering::Relaxed);
        let margin = assess(&assembly.structure, Question::VALUE).map_err(Refusal::Structure)?.margin();
        Ok(if margin.lower >= self.least { Ok(margin) } else { Err(Because::Unstable) })
    }
}

impl Family for Lattice<'_> {
    type State = Configuration;
    type Action = Action;
    type Held = FaceConnection;
    type Touched = Touched;
    type Connection = FaceConnection;
    type Place = Vec<Placement>;

    fn start(&self) -> Configuration {
        let mut start = self.start.clone();
        start.connections.sort_unstable();
        start
    }

    fn kind(action: &Action) -> Kind {
        match action {
            Action::Attach(_) => Kind::Attach,
            Action::Detach(_) => Kind::Detach,
            Action::Move { .. } => Kind::Move,
        }
    }

    /// One of the two moves a module that the other names.
    fn bound(one: &Action, other: &Action) -> Option<Because> {
        let names = |action: &Action, module: usize| match *action {
            Action::Attach(connection) | Action::Detach(connection) => connection.modules().contains(&module),
            Action::Move { module: own, support, .. } => own == module || support == Some(module),
        };
        let moves = |a: &Action, b: &Action| a.moved().is_some_and(|module| names(b, module));
        (moves(one, other) || moves(other, one)).then_some(Because::SameModule)
    }

    fn place(&self, state: &Configuration) -> Vec<Placement> {
        state.modules.iter().map(|module| module.placement).collect()
    }

    fn connections(state: &Configuration) -> &[FaceConnection] {
        &state.connections
    }

    fn difference(&self, one: &Configuration, other: &Configuration) -> Option<Because> {
        let is_same = one.connections == other.connections && self.place(one) == self.place(other);
        (!is_same).then_some(Because::OtherState)
    }

    fn take(&self, state: &Configuration, action: &Action) -> Result<Configuration, Because> {
        let next = transition(state, action).map_err(Because::NotLegal)?;
        if let Some(path) = &next.path {
            self.hits(state, path).map_err(Because::NotLegal)?;
        }
        Ok(next.after)
    }

    fn worst(&self, state: &Configuration, moves: &[Action]) -> Result<Result<Bracket, Because>, Refusal> {
        let paths: Result<Vec<Option<Path>>, Fault> =
            moves.iter().map(|action| transition(state, action).map(|next| next.path)).collect();
        let paths: Vec<Path> = match paths {
            Ok(paths) => paths.into_iter().flatten().collect(),
            Err(fault) => return Ok(Err(Because::NotLegal(fault))),
        };
        for (index, path) in paths.iter().enumerate() {
            if !paths[..index].iter().all(|other| are_apart(state, path, other)) {
                return Ok(Err(Because::WaysCross));
            }
        }
        let engaged = match engaged(state, &paths) {
            Ok(engaged) => engaged,
            Err(because) => return Ok(Err(because)),
        };
        let placements = self.place(state);
        let starts: Vec<Pose> = paths.iter().map(|path| state.pose(path.module)).collect();
        let samplings: Vec<Sampling> = paths.iter().map(|path| sampling(path, state.pitch())).collect();
        product::worst(&samplings, |phases| {
            let moving = paths
                .iter()
                .zip(&starts)
                .zip(phases)
                .map(|((path, start), &phase)| Moving { module: path.module, pose: path.motion.pose(start, phase) });
            let moving: Vec<Moving> = moving.collect();
            self.margin(state, &Moment { placements: &placements, moving: &moving, engaged: &engaged })
        })
    }

    fn solves(&self) -> u64 {
        self.solves.load(Ordering::Relaxed)
    }
}

/// How the way of a module is sampled.
fn sampling(path: &Path, pitch: f64) -> Sampling {
    let (length, step, resolution) = match &path.motion {
        Motion::Translation { by } => (by.norm() / pitch, CELL_STEP, CELL_RESOLUTION),
        Motion::Rotation { angle, .. } => (angle.abs().to_degrees(), TURN_STEP, TURN_RESOLUTION),
    };
    Sampling { steps: (length / step).round().max(1.0) as u32, resolution: resolution / length }
}
