//! What surrounds a robot.

use crate::spatial::Pose;

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
