//! Collision, connectedness and margins of states and moves.

use petgraph::unionfind::UnionFind;
use rayon::prelude::*;

use crate::geometry::{Solid, Surroundings, first_collision};
use crate::reconfigure::assembly::{Assembler, Engagement, Moving, Touched, Transient};
use crate::reconfigure::refusal::Refusal;
use crate::robot::{Configuration, FaceConnection, Placement, Port};
use crate::statics::{Bracket, Question, assess};

use super::claims;
use super::failure::{Failure, Fault};
use super::legality::Path;

/// A state that the oracle assessed.
#[derive(Clone, Debug)]
pub(super) struct Sample {
    /// Phase of the action; 1 at rest after it.
    pub phase: f64,
    pub margin: Bracket,
    /// The connections that limit it: critical ones, and those at their limit.
    pub limiting: Vec<FaceConnection>,
    pub weakest: Option<FaceConnection>,
    connected: bool,
}

/// The margins found for the start or one action.
#[derive(Clone, Debug)]
pub(super) struct Found {
    pub margin: Bracket,
    pub samples: Vec<Sample>,
    /// Whether all of it is one state at rest, so that margins compare exactly.
    pub exact: bool,
}

impl Found {
    /// A move and the rest after it.
    pub fn followed_by(mut self, rest: Self) -> Self {
        self.margin = self.margin.min(rest.margin);
        self.samples.extend(rest.samples);
        self
    }

    /// The samples at a phase.
    pub fn at(&self, phase: f64) -> impl Iterator<Item = &Sample> {
        self.samples.iter().filter(move |sample| sample.phase == phase)
    }
}

/// Checks states and collects what is wrong.
pub(super) struct Checker<'a> {
    start: &'a Configuration,
    assembler: &'a Assembler<'a>,
    required: f64,
    pub failures: Vec<Failure>,
    pub solves: u64,
}

impl<'a> Checker<'a> {
    pub fn new(start: &'a Configuration, assembler: &'a Assembler<'a>, required: f64) -> Self {
        Self { start, assembler, required, failures: Vec::new(), solves: 0 }
    }

    pub fn fail(&mut self, action: Option<usize>, phase: Option<f64>, fault: Fault, weakest: Option<FaceConnection>) {
        self.failures.push(Failure { action, phase, fault, connection: weakest });
    }

    /// Checks a state at rest.
    pub fn rest(&mut self, action: Option<usize>, state: &Configuration) -> Result<Found, Refusal> {
        let placements: Vec<Placement> = state.modules.iter().map(|module| module.placement).collect();
        let engaged: Vec<_> = state.connections.iter().map(|c| Engagement::face(state, c)).collect();
        let at_rest = Transient { placements: &placements, moving: None, engaged: &engaged };
        let sample = self.sample(state, &at_rest, 1.0)?;
        self.solves += 1;
        self.judge(action, None, &[&sample], self.required);
        Ok(Found { margin: sample.margin, samples: vec![sample], exact: true })
    }

    /// Checks a move from a state on a fixed grid of phases, and at those claimed.
    pub fn transit(
        &mut self,
        action: usize,
        before: &Configuration,
        path: &Path,
        claimed: &[f64],
    ) -> Result<Found, Refusal> {
        self.collide(action, before, path);
        let placements: Vec<Placement> = before.modules.iter().map(|module| module.placement).collect();
        let start = before.pose(path.module);
        let grid = (0..=path.steps).map(|i| f64::from(i) / f64::from(path.steps));
        let mut phases: Vec<f64> = grid.chain(claimed.iter().copied().filter(|p| (0.0..=1.0).contains(p))).collect();
        phases.sort_unstable_by(f64::total_cmp);
        phases.dedup();
        let samples = phases.par_iter().map(|&phase| {
            let moving = Moving { module: path.module, pose: path.motion.pose(&start, phase) };
            let state = Transient { placements: &placements, moving: Some(moving), engaged: &path.engaged };
            self.sample(before, &state, phase)
        });
        let samples: Vec<Sample> = samples.collect::<Result<_, _>>()?;
        self.solves += samples.len() as u64;
        let least = if self.required > 0.0 {
            (self.required - claims::tolerance(self.required)).max(0.0)
        } else {
            self.required
        };
        self.judge(Some(action), Some(()), &samples.iter().collect::<Vec<_>>(), least);
        let margin = samples.iter().map(|sample| sample.margin).reduce(Bracket::min);
        Ok(Found { margin: margin.expect("a grid has phases"), samples, exact: false })
    }

    /// Books the first disconnected and the first unstable of some samples.
    fn judge(&mut self, action: Option<usize>, moving: Option<()>, samples: &[&Sample], least: f64) {
        let phase = |sample: &Sample| moving.map(|()| sample.phase);
        if self.start.require.connected
            && let Some(apart) = samples.iter().find(|sample| !sample.connected)
        {
            self.fail(action, phase(apart), Fault::Disconnected, None);
        }
        let weak = |sample: &&&Sample| !(sample.margin.lower >= least) || sample.margin.upper == f64::NEG_INFINITY;
        if let Some(weak) = samples.iter().find(weak) {
            let fault = Fault::Unstable { margin: weak.margin, required: self.required };
            self.fail(action, phase(weak), fault, weak.weakest);
        }
    }

    /// Books the first thing that the moving module hits.
    fn collide(&mut self, action: usize, before: &Configuration, path: &Path) {
        let solid = |m: usize| Solid::new(before.module_type(m).body().shape.clone(), before.pose(m));
        let environment = &before.environment;
        let others = (0..before.modules.len()).filter(|&m| m != path.module);
        let modules = others.map(|m| (Touched::Module(m), solid(m)));
        let obstacles = environment.obstacles.iter().enumerate().map(|(i, o)| (Touched::Obstacle(i), Solid::from(o)));
        let solids =
            modules.chain(obstacles).map(|(what, solid)| (what, Surroundings { solids: vec![solid], ground: None }));
        let ground = environment
            .ground
            .as_ref()
            .map(|ground| (Touched::Ground, Surroundings { solids: Vec::new(), ground: Some(ground.height) }));
        let moving = solid(path.module);
        let hit = |(what, around): (Touched, Surroundings)| {
            first_collision(&moving, &path.motion, &around).map(|phase| (phase, what))
        };
        let first = solids.chain(ground).filter_map(hit).min_by(|(a, _), (b, _)| a.total_cmp(b));
        if let Some((phase, with)) = first {
            self.fail(Some(action), Some(phase), Fault::Collision { with }, None);
        }
    }

    fn sample(&self, modules: &Configuration, state: &Transient, phase: f64) -> Result<Sample, Refusal> {
        let assembly = self.assembler.assemble(state);
        let assessment = assess(&assembly.structure, Question::VALUE).map_err(Refusal::Structure)?;
        let connection = |i: usize| ports(modules, &state.engaged[assembly.connections[i]]);
        let limit = assessment.utilisation.lower * (1.0 - claims::AT_LIMIT);
        let limiting = assessment.connections.iter().enumerate();
        let limiting = limiting.filter(|(_, c)| c.critical || c.utilisation >= limit).map(|(i, _)| connection(i));
        let mut components = UnionFind::<usize>::new(modules.modules.len());
        let held = assembly.connections.iter().map(|&i| state.engaged[i].modules());
        let joined = held.filter(|&[a, b]| components.union(a, b)).count();
        Ok(Sample {
            phase,
            margin: assessment.margin(),
            limiting: limiting.collect(),
            weakest: assessment.weakest_connection().map(connection),
            connected: joined + 1 >= modules.modules.len(),
        })
    }
}

/// The faces that hold each other, or that a hinge joins.
fn ports(modules: &Configuration, engagement: &Engagement) -> FaceConnection {
    let [a, b] = engagement.modules();
    let towards = match *engagement {
        Engagement::Face { towards, .. } => towards,
        Engagement::Hinge { .. } => {
            let cell = |m: usize| modules.modules[m].placement.cell;
            let step = std::array::from_fn(|i| cell(b)[i] - cell(a)[i]);
            crate::robot::Face::from_step(step).expect("a legal pivot is about an edge of a neighbour")
        }
    };
    let port = |m: usize, towards| Port { module: m, face: modules.modules[m].face_towards(towards) };
    FaceConnection::new(port(a, towards), port(b, towards.opposite()))
}
