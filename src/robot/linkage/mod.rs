//! Robots outside lattices: modules anywhere in space, of one body or of several with
//! joints between them, that hold each other by their ports.
//!
//! A lattice module may be part of such a robot: it is then a rigid module with six ports. Knows
//! poses and which ports meet; knows no forces, no collision of solids and no files.

mod code;
mod engagement;
mod kinematics;
mod problems;
mod spot;
mod square;
mod symmetry;
#[cfg(test)]
mod tests;

use std::sync::Arc;

use petgraph::unionfind::UnionFind;

use crate::spatial::{Pose, Vec3};

use super::catalogue::Catalogue;
use super::configuration::{Matching, ModuleLoad};
use super::connection::OnModule;
use super::environment::Environment;
use super::module_type::ModuleType;
use super::requirement::Requirement;

pub use code::Code;
pub use engagement::{Engagement, MEETING, frame_between, orientations_between};
pub use kinematics::{child_pose, mated};
pub use spot::{MICRO, Spot};
pub use square::is_square;
pub use symmetry::{Directions, Symmetry};

/// A module of a linkage.
#[derive(Clone, Debug, PartialEq)]
pub struct Module {
    /// Unique name.
    pub id: String,
    /// Index into [`Catalogue::module_types`].
    pub module_type: usize,
    /// Pose of the module frame in W: that of its first body.
    pub pose: Pose,
    /// Positions of its joints in steps, in the order of [`ModuleType::joints`].
    pub joints: Vec<i32>,
    /// Whether its first body is held immovably (and never moves in a plan).
    pub fixed: bool,
}

/// A port of a module.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Port {
    /// Index into [`Linkage::modules`].
    pub module: usize,
    /// Index into [`ModuleType::ports`].
    pub port: usize,
}

impl OnModule for Port {
    fn module(&self) -> usize {
        self.module
    }
}

/// An engaged connection between two ports of modules.
pub type Connection = super::connection::Connection<Port>;

/// A robot at one moment, its surroundings and its loads.
#[derive(Clone, Debug, PartialEq)]
pub struct Linkage {
    /// What the modules are made of.
    pub catalogue: Arc<Catalogue>,
    /// Gravity in m/s^2, in W.
    pub gravity: Vec3,
    /// Ground and obstacles.
    pub environment: Environment,
    /// The modules.
    pub modules: Vec<Module>,
    /// The engaged connections, sorted.
    pub connections: Vec<Connection>,
    /// External loads, each on the first body of its module.
    pub loads: Vec<ModuleLoad>,
    /// What transient states must satisfy.
    pub require: Requirement,
}

/// A linkage to reach; its environment, gravity and loads are the start's.
#[derive(Clone, Debug, PartialEq)]
pub struct Goal {
    /// Modules and connections to reach.
    pub linkage: Linkage,
    /// How it is compared.
    pub matching: Matching,
}

impl Linkage {
    /// The type of a module.
    pub fn module_type(&self, module: usize) -> &ModuleType {
        &self.catalogue.module_types[self.modules[module].module_type]
    }

    /// For each module the smallest index of a module that it is connected to,
    /// directly or through others. Fixed modules are not connected to each other by the world.
    pub fn components(&self) -> Vec<usize> {
        let count = self.modules.len();
        let mut sets = UnionFind::<usize>::new(count);
        for [a, b] in self.connections.iter().map(Connection::modules) {
            if a < count && b < count {
                sets.union(a, b);
            }
        }
        let mut smallest = vec![usize::MAX; count];
        (0..count)
            .map(|module| {
                let first = &mut smallest[sets.find(module)];
                *first = module.min(*first);
                *first
            })
            .collect()
    }

    /// Whether the connections join all modules. True without modules.
    pub fn is_connected(&self) -> bool {
        self.components().iter().all(|&component| component == 0)
    }
}
