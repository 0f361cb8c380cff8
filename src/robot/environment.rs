//! What surrounds a robot.

use crate::spatial::Pose;

use super::problem::{Findings, Part};
use super::terrain::Terrain;

/// Horizontal frictional ground, filling everything below its height.
#[derive(Clone, Debug, PartialEq)]
pub struct Ground {
    /// z of its surface in m.
    pub height: f64,
    /// Friction coefficient.
    pub friction: f64,
}

/// Something immovable: modules collide with it and rest on it.
#[derive(Clone, Debug, PartialEq)]
pub struct Obstacle {
    /// Its shape.
    pub shape: Terrain,
    /// Pose of its frame in W.
    pub pose: Pose,
    /// Friction coefficient of its surface.
    pub friction: f64,
}

/// What surrounds the robot.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Environment {
    /// The ground, if there is one.
    pub ground: Option<Ground>,
    /// Whatever else stands there.
    pub obstacles: Vec<Obstacle>,
    /// Friction coefficient between unconnected modules.
    pub module_friction: f64,
}

impl Environment {
    /// Adds everything that is wrong with the environment.
    pub(super) fn check(&self, findings: &mut Findings) {
        findings.not_negative(Part::Environment, "module_friction", &[self.module_friction]);
        if let Some(ground) = &self.ground {
            findings.finite(Part::Ground, "height", &[ground.height]);
            findings.not_negative(Part::Ground, "friction", &[ground.friction]);
        }
        for (i, obstacle) in self.obstacles.iter().enumerate() {
            let part = Part::Obstacle(i);
            if let Terrain::Solid(shape) = &obstacle.shape {
                shape.check(findings, part);
            }
            findings.finite(part, "position", obstacle.pose.translation.vector.as_slice());
            findings.finite(part, "rotation", obstacle.pose.rotation.coords.as_slice());
            findings.not_negative(part, "friction", &[obstacle.friction]);
        }
    }
}
