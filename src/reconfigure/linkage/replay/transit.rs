//! Collision, connectedness and margins of states and moves of a linkage.

use rayon::prelude::*;

use crate::geometry::{Solid, Surrounding, Surroundings, first_collision};
use crate::reconfigure::stronger::strengthen;
use crate::robot::linkage::{Connection, Linkage};
use crate::spatial::Pose;
use crate::statics::{Question, assess};

use super::super::assembly::{Assembler, Assembly, BodyOf, Held, Touched, Transient};
use super::super::joined::Joined;
use super::legality::{Path, poses_at};
use super::{Fault, Found, Judge, Refusal, Sample, claims, phases};

/// Checks states and collects what is wrong.
pub(super) struct Checker<'a> {
    assembler: &'a Assembler<'a>,
    surroundings: Surroundings,
    off_limits: Surroundings,
    /// What is taken to be so many times as strong as it is.
    stronger: Option<(Held, f64)>,
    pub judge: Judge<Held, Touched>,
}

impl<'a> Checker<'a> {
    pub fn new(start: &Linkage, assembler: &'a Assembler<'a>, required: f64, stronger: Option<(Held, f64)>) -> Self {
        let surroundings = Surroundings::new(&start.environment);
        let off_limits = Surroundings::new(&start.require.off_limits());
        let judge = Judge::new(required, start.require.connected);
        Self { assembler, surroundings, off_limits, stronger, judge }
    }

    /// Checks a state at rest.
    pub fn rest(&mut self, action: Option<usize>, state: &Linkage) -> Result<Found<Held>, Refusal> {
        let bodies: Vec<Vec<Pose>> = (0..state.modules.len()).map(|module| state.body_poses(module)).collect();
        let sample = self.sample(state, &bodies, 1.0)?;
        Ok(self.judge.rest(action, sample))
    }

    /// Checks a move from a state on a fixed grid of phases, and at those claimed.
    pub fn transit(
        &mut self,
        action: usize,
        before: &Linkage,
        path: &Path,
        claimed: &[f64],
    ) -> Result<Found<Held>, Refusal> {
        if let Some((phase, with)) = first_hit(before, &self.surroundings, path) {
            self.judge.fail(Some(action), Some(phase), Fault::Collision { with }, None);
        }
        if let Some((phase, region)) = first_passed(before, &self.off_limits, path) {
            self.judge.fail(Some(action), Some(phase), Fault::KeepOut { region }, None);
        }
        let phases = phases(path.steps, claimed);
        let samples = phases.par_iter().map(|&phase| self.sample(before, &poses_at(before, path, phase), phase));
        let samples: Vec<Sample<_>> = samples.collect::<Result<_, _>>()?;
        Ok(self.judge.transit(action, samples))
    }

    fn sample(&self, linkage: &Linkage, bodies: &[Vec<Pose>], phase: f64) -> Result<Sample<Held>, Refusal> {
        let Assembly { mut structure, connections, .. } =
            self.assembler.assemble(&Transient { bodies, engaged: &linkage.connections });
        if let Some((held, factor)) = self.stronger {
            strengthen(&mut structure, factor, |index| connections[index] == held);
        }
        let assessment = assess(&structure, Question::VALUE).map_err(Refusal::Structure)?;
        let limit = assessment.utilisation.lower * (1.0 - claims::AT_LIMIT);
        let limiting = assessment.connections.iter().zip(&connections);
        let limiting = limiting.filter(|(c, _)| c.critical || c.utilisation >= limit).map(|(_, held)| *held);
        Ok(Sample {
            phase,
            margin: assessment.margin(),
            limiting: limiting.collect(),
            weakest: assessment.weakest_connection().map(|index| connections[index]),
            connected: is_connected(linkage),
        })
    }
}

/// Whether joints and engaged connections join all bodies.
pub fn is_connected(linkage: &Linkage) -> bool {
    let joined = Joined::new(linkage);
    let whole = joined.whole(linkage);
    (1..joined.bodies.len()).all(|body| whole.equiv(0, body))
}

/// The first thing that something hits on its way. Bodies that a joint or an engaged connection holds
/// together do not hit each other.
pub fn first_hit(before: &Linkage, surroundings: &Surroundings, path: &Path) -> Option<(f64, Touched)> {
    let poses = poses_at(before, path, 0.0);
    let solid = |body: BodyOf| {
        let kind = &before.module_type(body.module).bodies[body.body];
        Solid::new(kind.shape.clone(), poses[body.module][body.body] * kind.shape_pose)
    };
    let all = Joined::new(before).bodies;
    let hits = path.carried.par_iter().filter_map(|&mover| {
        let moving = solid(mover);
        let others = all.iter().filter(|&&other| !path.carried.contains(&other) && !held(before, mover, other));
        let bodies = others.filter_map(|&other| {
            first_collision(&moving, &path.motion, &solid(other)).map(|phase| (phase, Touched::Body(other)))
        });
        let around = surroundings.first_collision(&moving, &path.motion);
        bodies.chain(around.map(|(phase, what)| (phase, what.into()))).min_by(|(a, _), (b, _)| a.total_cmp(b))
    });
    let mut hits: Vec<(f64, Touched)> = hits.collect();
    hits.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    hits.into_iter().next()
}

/// The first forbidden region that something passes through on its way.
pub fn first_passed(before: &Linkage, off_limits: &Surroundings, path: &Path) -> Option<(f64, usize)> {
    let poses = poses_at(before, path, 0.0);
    let passed = path.carried.iter().filter_map(|body| {
        let kind = &before.module_type(body.module).bodies[body.body];
        let moving = Solid::new(kind.shape.clone(), poses[body.module][body.body] * kind.shape_pose);
        match off_limits.first_collision(&moving, &path.motion) {
            Some((phase, Surrounding::Obstacle(region))) => Some((phase, region)),
            Some((_, Surrounding::Ground)) | None => None,
        }
    });
    passed.min_by(|(a, _), (b, _)| a.total_cmp(b))
}

/// Whether a joint or an engaged connection holds two bodies together.
fn held(linkage: &Linkage, a: BodyOf, b: BodyOf) -> bool {
    let by_joint = a.module == b.module
        && linkage.module_type(a.module).joints.iter().any(|joint| {
            [joint.parent, joint.child] == [a.body, b.body] || [joint.child, joint.parent] == [a.body, b.body]
        });
    let sits_on = |connection: &Connection| {
        let bodies = connection
            .ports
            .map(|port| BodyOf { module: port.module, body: linkage.module_type(port.module).ports[port.port].body });
        bodies == [a, b] || bodies == [b, a]
    };
    by_joint || linkage.connections.iter().any(sits_on)
}
