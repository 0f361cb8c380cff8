//! What every transient state of a plan must satisfy, and what no action may do.

use crate::spatial::{Pose, Rotation, Vec3};

use super::environment::{Environment, Obstacle};
use super::problem::{Findings, Part};
use super::shape::Shape;
use super::terrain::Terrain;

/// What every transient state must satisfy.
#[derive(Clone, Debug, PartialEq)]
pub struct Requirement {
    /// Smallest admissible internal stability margin.
    pub margin: f64,
    /// Whether all modules must stay connected.
    pub connected: bool,
    /// Modules that no action may move, by index into the modules: they stay where they are, with their joints, but
    /// nothing holds them there. Their connections may be engaged and released.
    pub stay: Vec<usize>,
    /// Regions of W that no move may pass through. They carry nothing and nothing rests on them; a module that
    /// is inside one stays there.
    pub keep_out: Vec<Region>,
}

impl Default for Requirement {
    fn default() -> Self {
        Self { margin: 0.0, connected: true, stay: Vec::new(), keep_out: Vec::new() }
    }
}

impl Requirement {
    /// The forbidden regions as the obstacles of a world that has nothing else.
    pub fn off_limits(&self) -> Environment {
        let obstacle = |region: &Region| Obstacle {
            shape: Terrain::Solid(Shape::Cuboid { half_extents: (region.high - region.low) / 2.0 }),
            pose: Pose::from_parts(region.low.lerp(&region.high, 0.5).into(), Rotation::identity()),
            friction: 0.0,
        };
        Environment { obstacles: self.keep_out.iter().map(obstacle).collect(), ..Environment::default() }
    }

    /// Adds everything that is wrong with the requirement on a robot of so many modules.
    pub(super) fn check(&self, findings: &mut Findings, modules: usize) {
        findings.finite(Part::Requirement, "margin", &[self.margin]);
        for &module in &self.stay {
            findings.in_range(Part::Requirement, "stay", module, modules);
        }
        for region in &self.keep_out {
            if findings.finite(Part::Requirement, "keep_out", region.low.as_slice()) {
                findings.positive(Part::Requirement, "keep_out", (region.high - region.low).as_slice());
            }
        }
    }
}

/// A box with its edges along the axes of W.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Region {
    /// Its lowest corner, in m.
    pub low: Vec3,
    /// Its highest corner, in m; above the lowest along every axis.
    pub high: Vec3,
}
