//! A structure under a force of any size along a line.

use crate::spatial::Vec3;

use super::super::assess::assess;
use super::super::assessment::{Assessment, Question, Verdict};
use super::super::structure::{Load, Structure};
use super::UnitForce;

/// A valid structure and the force of 1 N that is added to its loads.
pub(super) struct Line<'s> {
    pub structure: &'s Structure,
    /// Of 1 N, at a point.
    pub unit: Load,
}

impl<'s> Line<'s> {
    pub(super) fn new(structure: &'s Structure, force: &UnitForce) -> Self {
        let at = force.at.unwrap_or(structure.bodies[force.body].com);
        let unit = Load { body: force.body, force: force.direction.normalize(), torque: Vec3::zeros(), at: Some(at) };
        Self { structure, unit }
    }

    /// The structure under `force` newtons.
    pub(super) fn at(&self, force: f64) -> Structure {
        let mut loaded = self.structure.clone();
        loaded.loads.push(Load { force: self.unit.force * force, ..self.unit.clone() });
        loaded
    }

    /// The structure under `force` newtons and nothing else, not even its weight.
    pub(super) fn alone(&self, force: f64) -> Structure {
        let loads = vec![Load { force: self.unit.force * force, ..self.unit.clone() }];
        Structure { gravity: Vec3::zeros(), loads, ..self.structure.clone() }
    }

    /// What the oracle says of `force` newtons. Sound by construction, save for forces so large that
    /// they overflow: those are told nothing of.
    pub(super) fn assess(&self, force: f64, question: Question) -> Assessment {
        let nothing = || assess(&Structure::default(), question).expect("nothing is a sound structure");
        assess(&self.at(force), question).unwrap_or_else(|_| {
            let mut unknown = nothing();
            unknown.verdict = Verdict::Undecided;
            unknown.utilisation.upper = f64::INFINITY;
            unknown
        })
    }

    /// Whether the force alone is proved to demand nothing, in the direction of `sign`: what stands,
    /// stands under any multiple of it as well, since demands are sublinear in the loads.
    pub(super) fn demands_nothing(&self, sign: f64) -> bool {
        assess(&self.alone(sign), Question::Decide(0.0))
            .is_ok_and(|answer| answer.verdict != Verdict::WholeBodyUnstable && answer.utilisation.upper <= 0.0)
    }
}
