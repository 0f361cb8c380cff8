//! Collision, connectedness and margins of states and moves.

use petgraph::unionfind::UnionFind;
use rayon::prelude::*;

use crate::geometry::{Solid, Surrounding, Surroundings, first_collision};
use crate::reconfigure::assembly::{Assembler, Engagement, Moving, Touched, Transient};
use crate::reconfigure::refusal::Refusal;
use crate::reconfigure::stronger::strengthen;
use crate::robot::{Configuration, FaceConnection, Placement, Port};
use crate::statics::{Question, assess};

use super::bounded::Bounds;
use super::claims;
use super::failure::Fault;
use super::judge::{Found, Judge, Sample, phases};
use super::legality::Path;

/// What a plan is replayed in: everything that no action changes.
pub(super) struct Scene<'a> {
    start: &'a Configuration,
    assembler: Assembler<'a>,
    surroundings: Surroundings,
    off_limits: Surroundings,
    /// The margin that every transient state must have.
    required: f64,
    /// A connection that is taken to be so many times as strong as it is.
    stronger: Option<(FaceConnection, f64)>,
}

impl<'a> Scene<'a> {
    pub fn new(start: &'a Configuration, required: f64, stronger: Option<(FaceConnection, f64)>) -> Self {
        let assembler = Assembler::new(start);
        let surroundings = Surroundings::new(&start.environment);
        let off_limits = Surroundings::new(&start.require.off_limits());
        Self { start, assembler, surroundings, off_limits, required, stronger }
    }
}

/// Checks states and collects what is wrong.
pub(super) struct Checker<'a> {
    scene: &'a Scene<'a>,
    bounds: Bounds<'a>,
    pub judge: Judge<FaceConnection, Touched>,
}

impl<'a> Checker<'a> {
    pub fn new(scene: &'a Scene<'a>) -> Self {
        let judge = Judge::new(scene.required, scene.start.require.connected);
        Self { scene, bounds: Bounds::new(scene.start), judge }
    }

    /// Structures assessed so far.
    pub fn solves(&self) -> u64 {
        self.judge.solves + self.bounds.solves()
    }

    /// What it found wrong, and what that took, without what it remembers of states.
    pub fn judged(self) -> Judge<FaceConnection, Touched> {
        Judge { solves: self.solves(), ..self.judge }
    }

    /// Adds what another one found wrong, and what that took.
    pub fn join(&mut self, other: Judge<FaceConnection, Touched>) {
        self.judge.solves += other.solves;
        self.judge.failures.extend(other.failures);
    }

    /// Checks a state at rest: whether it has a margin, by bounds with one of two modules hanging on the others, where
    /// that is enough; else its value.
    pub fn rest(
        &mut self,
        action: Option<usize>,
        state: &Configuration,
        bounded: Option<(f64, [Option<usize>; 2])>,
    ) -> Result<Found<FaceConnection>, Refusal> {
        // A claim may be for the move before, of which less is asked.
        if let Some((least, hanging)) = bounded
            && let Some(sample) =
                self.bounds.at_rest(state, hanging.into_iter().flatten(), least.max(self.judge.required))
        {
            return Ok(self.judge.rest(action, sample));
        }
        let placements: Vec<Placement> = state.modules.iter().map(|module| module.placement).collect();
        let engaged: Vec<_> = state.connections.iter().map(|c| Engagement::face(state, c)).collect();
        let at_rest = Transient { placements: &placements, moving: None, engaged: &engaged };
        let sample = self.sample(state, &at_rest, 1.0)?;
        Ok(self.judge.rest(action, sample))
    }

    /// Checks a move from a state on a fixed grid of phases, and at those claimed: whether it has a margin, by bounds,
    /// where that is enough; else its values.
    pub fn transit(
        &mut self,
        action: usize,
        before: &Configuration,
        path: &Path,
        claimed: &[f64],
        bound: Option<f64>,
    ) -> Result<Found<FaceConnection>, Refusal> {
        self.collide(action, before, path);
        let phases = phases(path.steps, claimed);
        let least = bound.map(|least| least.max(self.judge.required_on_the_way()));
        if let Some(samples) = least.and_then(|least| self.bounds.of_move(before, path, &phases, least)) {
            return Ok(self.judge.transit(action, samples));
        }
        let placements: Vec<Placement> = before.modules.iter().map(|module| module.placement).collect();
        let start = before.pose(path.module);
        let samples = phases.par_iter().map(|&phase| {
            let moving = Moving { module: path.module, pose: path.motion.pose(&start, phase) };
            let state = Transient { placements: &placements, moving: Some(moving), engaged: &path.engaged };
            self.sample(before, &state, phase)
        });
        let samples: Vec<Sample<_>> = samples.collect::<Result<_, _>>()?;
        Ok(self.judge.transit(action, samples))
    }

    /// Books the first thing that the moving module hits.
    fn collide(&mut self, action: usize, before: &Configuration, path: &Path) {
        let solid = |m: usize| Solid::new(before.module_type(m).body().shape.clone(), before.pose(m));
        let moving = solid(path.module);
        let others = (0..before.modules.len()).filter(|&m| m != path.module);
        let modules = others
            .filter_map(|m| first_collision(&moving, &path.motion, &solid(m)).map(|phase| (phase, Touched::Module(m))));
        let around = self.scene.surroundings.first_collision(&moving, &path.motion);
        let around = around.map(|(phase, what)| (phase, what.into()));
        let first = modules.chain(around).min_by(|(a, _), (b, _)| a.total_cmp(b));
        if let Some((phase, with)) = first {
            self.judge.fail(Some(action), Some(phase), Fault::Collision { with }, None);
        }
        if let Some((phase, Surrounding::Obstacle(region))) =
            self.scene.off_limits.first_collision(&moving, &path.motion)
        {
            self.judge.fail(Some(action), Some(phase), Fault::KeepOut { region }, None);
        }
    }

    fn sample(
        &self,
        modules: &Configuration,
        state: &Transient,
        phase: f64,
    ) -> Result<Sample<FaceConnection>, Refusal> {
        let mut assembly = self.scene.assembler.assemble(state);
        if let Some((held, factor)) = self.scene.stronger {
            let is_it = |index: usize| ports(modules, &state.engaged[assembly.connections[index]]) == held;
            strengthen(&mut assembly.structure, factor, is_it);
        }
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
