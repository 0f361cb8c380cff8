//! What all robots have in common that a goal and its start are compared by.

use crate::robot::linkage::{Linkage, MEETING};
use crate::robot::{Catalogue, Configuration, Environment, FaceConnection, ModuleLoad, Port, Requirement, linkage};
use crate::spatial::{Pose, Vec3};

use std::collections::HashMap;
use std::sync::Arc;

/// A robot in its surroundings.
pub(super) trait Compared {
    /// How a fixed module is to be listed, for a hint.
    const WHERE: &'static str;

    fn catalogue(&self) -> &Arc<Catalogue>;
    fn count(&self) -> usize;
    fn id(&self, module: usize) -> &str;
    fn module_type(&self, module: usize) -> usize;
    fn is_fixed(&self, module: usize) -> bool;
    fn gravity(&self) -> Vec3;
    fn environment(&self) -> &Environment;
    fn loads(&self) -> &[ModuleLoad];
    fn require(&self) -> &Requirement;

    /// Where a module is, for a message.
    fn whereabouts(&self, module: usize) -> String;

    /// For each fixed module of `self` the module of `other` in the same place.
    fn in_place_of_fixed(&self, other: &Self) -> Vec<(usize, Option<usize>)>;

    /// The same with the modules in this order, and their connections sorted.
    fn reordered(&mut self, order: &[usize]);

    /// Gravity, environment and loads of another.
    fn surround_as(&mut self, other: &Self);
}

/// Where each module goes.
fn new_indices(order: &[usize]) -> Vec<usize> {
    let mut new_index = vec![0; order.len()];
    for (new, &old) in order.iter().enumerate() {
        new_index[old] = new;
    }
    new_index
}

/// What both kinds of robot have under the same name.
macro_rules! common {
    () => {
        fn catalogue(&self) -> &Arc<Catalogue> {
            &self.catalogue
        }

        fn count(&self) -> usize {
            self.modules.len()
        }

        fn id(&self, module: usize) -> &str {
            &self.modules[module].id
        }

        fn module_type(&self, module: usize) -> usize {
            self.modules[module].module_type
        }

        fn is_fixed(&self, module: usize) -> bool {
            self.modules[module].fixed
        }

        fn gravity(&self) -> Vec3 {
            self.gravity
        }

        fn environment(&self) -> &Environment {
            &self.environment
        }

        fn loads(&self) -> &[ModuleLoad] {
            &self.loads
        }

        fn require(&self) -> &Requirement {
            &self.require
        }

        fn surround_as(&mut self, other: &Self) {
            self.gravity = other.gravity;
            self.environment = other.environment.clone();
            self.loads = other.loads.clone();
        }
    };
}

impl Compared for Configuration {
    const WHERE: &'static str = "the same cell";

    common!();

    fn whereabouts(&self, module: usize) -> String {
        format!("in cell {:?}", self.modules[module].placement.cell)
    }

    fn in_place_of_fixed(&self, other: &Self) -> Vec<(usize, Option<usize>)> {
        let cells: HashMap<_, _> =
            other.modules.iter().enumerate().map(|(index, module)| (module.placement.cell, index)).collect();
        let fixed = self.modules.iter().enumerate().filter(|(_, module)| module.fixed);
        fixed.map(|(index, module)| (index, cells.get(&module.placement.cell).copied())).collect()
    }

    fn reordered(&mut self, order: &[usize]) {
        let new_index = new_indices(order);
        let moved = |port: Port| Port { module: new_index[port.module], ..port };
        self.modules = order.iter().map(|&old| self.modules[old].clone()).collect();
        self.connections =
            self.connections.iter().map(|c| FaceConnection::new(moved(c.ports[0]), moved(c.ports[1]))).collect();
        self.connections.sort_unstable();
    }
}

impl Compared for Linkage {
    const WHERE: &'static str = "the same position and rotation";

    common!();

    fn whereabouts(&self, module: usize) -> String {
        let p = self.modules[module].pose.translation.vector;
        format!("at [{:.6}, {:.6}, {:.6}] m", p.x, p.y, p.z)
    }

    fn in_place_of_fixed(&self, other: &Self) -> Vec<(usize, Option<usize>)> {
        let mut by_x: Vec<usize> = (0..other.modules.len()).collect();
        let x = |module: &usize| other.modules[*module].pose.translation.x;
        by_x.sort_by(|a, b| x(a).total_cmp(&x(b)));
        let same = |a: &Pose, b: &Pose, tolerance: f64| {
            (a.translation.vector - b.translation.vector).norm() <= tolerance
                && a.rotation.angle_to(&b.rotation) <= MEETING
        };
        let fixed = self.modules.iter().enumerate().filter(|(_, module)| module.fixed);
        fixed
            .map(|(index, module)| {
                let tolerance = MEETING * self.module_type(index).size();
                let first = by_x.partition_point(|other| x(other) < module.pose.translation.x - tolerance);
                let near = by_x[first..].iter().take_while(|m| x(m) <= module.pose.translation.x + tolerance);
                let mut there = near.filter(|m| same(&other.modules[**m].pose, &module.pose, tolerance));
                (index, there.next().copied())
            })
            .collect()
    }

    fn reordered(&mut self, order: &[usize]) {
        let new_index = new_indices(order);
        let moved = |port: linkage::Port| linkage::Port { module: new_index[port.module], ..port };
        self.modules = order.iter().map(|&old| self.modules[old].clone()).collect();
        self.connections =
            self.connections.iter().map(|c| linkage::Connection::new(moved(c.ports[0]), moved(c.ports[1]))).collect();
        self.connections.sort_unstable();
    }
}
