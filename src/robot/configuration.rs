//! A robot in its environment at one moment.

use std::sync::Arc;

use petgraph::unionfind::UnionFind;

use crate::spatial::{Pose, Vec3};

use super::catalogue::Catalogue;
use super::connection::{Connection, OnModule};
use super::environment::Environment;
use super::lattice::{Face, Placement};
use super::module_type::ModuleType;
use super::occupancy::{Occupancy, connection};
use super::requirement::Requirement;

/// A module of a configuration.
#[derive(Clone, Debug, PartialEq)]
pub struct Module {
    /// Unique name.
    pub id: String,
    /// Index into [`Catalogue::module_types`].
    pub module_type: usize,
    /// Where it is.
    pub placement: Placement,
    /// Whether it is held immovably (and never moves in a plan).
    pub fixed: bool,
}

/// A face of a module, in the **module's own** axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Port {
    /// Index into [`Configuration::modules`].
    pub module: usize,
    /// Which of its faces.
    pub face: Face,
}

impl OnModule for Port {
    fn module(&self) -> usize {
        self.module
    }
}

/// An engaged connection between two coinciding faces.
pub type FaceConnection = Connection<Port>;

/// An external wrench that stays on a module wherever it goes.
#[derive(Clone, Debug, PartialEq)]
pub struct ModuleLoad {
    /// Index into [`Configuration::modules`].
    pub module: usize,
    /// Force in N, in W.
    pub force: Vec3,
    /// Torque in N m, in W.
    pub torque: Vec3,
    /// Point of action in the module frame, in m; the centre of mass when `None`.
    pub at: Option<Vec3>,
}

/// A robot, its surroundings and its loads.
#[derive(Clone, Debug, PartialEq)]
pub struct Configuration {
    /// What the modules are made of.
    pub catalogue: Arc<Catalogue>,
    /// Gravity in m/s^2, in W.
    pub gravity: Vec3,
    /// Ground and obstacles.
    pub environment: Environment,
    /// The modules.
    pub modules: Vec<Module>,
    /// The engaged connections, sorted.
    pub connections: Vec<FaceConnection>,
    /// External loads.
    pub loads: Vec<ModuleLoad>,
    /// What transient states must satisfy.
    pub require: Requirement,
}

impl Configuration {
    /// The type of a module.
    pub fn module_type(&self, module: usize) -> &ModuleType {
        &self.catalogue.module_types[self.modules[module].module_type]
    }

    /// Edge length of a cell in m: that of the first module's type, which a
    /// sound configuration shares among all; 1 without modules.
    pub fn pitch(&self) -> f64 {
        self.modules
            .first()
            .and_then(|m| self.catalogue.module_types.get(m.module_type))
            .map_or(1.0, |module_type| module_type.cell().pitch)
    }

    /// Pose of a module's frame in W.
    pub fn pose(&self, module: usize) -> Pose {
        self.modules[module].placement.pose(self.module_type(module).cell().pitch)
    }

    /// The occupied cells.
    pub fn occupancy(&self) -> Occupancy {
        Occupancy::of_modules(&self.modules)
    }

    /// The world direction that a port looks in.
    pub fn direction(&self, port: Port) -> Face {
        self.modules[port.module].placement.orientation.to_world(port.face)
    }

    /// Every pair of coinciding faces, connectable or not, sorted.
    pub fn touching_faces(&self) -> Vec<FaceConnection> {
        let pairs = self.occupancy().touching_pairs();
        let mut faces: Vec<_> = pairs.into_iter().map(|(a, face, b)| connection(&self.modules, a, face, b)).collect();
        faces.sort_unstable();
        faces
    }

    /// Every connection that could be engaged: the coinciding faces whose
    /// connectors fit each other, sorted.
    pub fn touching_connections(&self) -> Vec<FaceConnection> {
        let mut connections = self.touching_faces();
        connections.retain(|c| {
            let [a, b] = c.modules().map(|m| self.modules[m].module_type);
            self.catalogue.face_connector(a, b).is_some()
        });
        connections
    }

    /// For each module the smallest index of a module that it is connected to,
    /// directly or through others, by `connections`. Fixed modules are not
    /// connected to each other by the world.
    pub fn components(&self) -> Vec<usize> {
        let count = self.modules.len();
        let mut sets = UnionFind::<usize>::new(count);
        for [a, b] in self.connections.iter().map(FaceConnection::modules) {
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

    /// Whether `connections` join all modules. True without modules.
    pub fn is_connected(&self) -> bool {
        self.components().iter().all(|&component| component == 0)
    }
}

/// How a goal is compared with a state.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Matching {
    /// Whether every module must be at its own place (by id), rather than any
    /// module of the same type.
    pub labelled: bool,
    /// Whether the goal is met up to a displacement over the ground.
    pub free_frame: bool,
}

/// A configuration to reach; its environment, gravity and loads are the start's.
#[derive(Clone, Debug, PartialEq)]
pub struct Goal {
    /// Modules and connections to reach.
    pub configuration: Configuration,
    /// How it is compared.
    pub matching: Matching,
}
