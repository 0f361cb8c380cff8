//! What every body has to hold: its own weight and loads, and what hangs from it.

use crate::spatial::{Vec3, Wrench};

use super::blocks::{Block, Vertex};
use super::demand::WrenchError;
use super::structure::Structure;

/// A load wrench on a body about its centre of mass, in W, with the sizes of
/// the terms that went into it, from which rounding errors are judged.
#[derive(Clone, Copy, Debug)]
pub(super) struct BodyLoad {
    pub wrench: Wrench,
    /// Per component, the sum of the magnitudes of all its terms, in N.
    pub force_size: Vec3,
    /// Per component, the sum of the magnitudes of all its terms, in N m.
    pub torque_size: Vec3,
    /// How many terms were added up.
    pub terms: usize,
}

impl BodyLoad {
    pub(super) const ZERO: Self = Self {
        wrench: Wrench::ZERO,
        force_size: Vec3::new(0.0, 0.0, 0.0),
        torque_size: Vec3::new(0.0, 0.0, 0.0),
        terms: 0,
    };

    /// Adds a force and torque that act at `lever` from the centre of mass.
    pub(super) fn add(&mut self, force: &Vec3, torque: &Vec3, lever: &Vec3) {
        self.wrench += Wrench::new(*force, torque + lever.cross(force));
        self.force_size += force.abs();
        self.torque_size += torque.abs() + cross_size(lever, &force.abs());
        self.terms += 1;
    }

    /// The same load about a point that `lever` leads from.
    pub(super) fn moved(&self, lever: &Vec3) -> Self {
        Self {
            wrench: self.wrench.moved(lever),
            torque_size: self.torque_size + cross_size(lever, &self.force_size),
            ..*self
        }
    }

    /// Whether there is nothing to hold.
    pub(super) fn is_zero(&self) -> bool {
        self.wrench == Wrench::ZERO
    }

    /// Bound on the rounding error of each component.
    pub(super) fn error(&self) -> WrenchError {
        let factor = (self.terms as f64 + 16.0) * f64::EPSILON;
        WrenchError { force: self.force_size * factor, torque: self.torque_size * factor }
    }
}

impl std::ops::AddAssign for BodyLoad {
    fn add_assign(&mut self, other: Self) {
        self.wrench += other.wrench;
        self.force_size += other.force_size;
        self.torque_size += other.torque_size;
        self.terms += other.terms;
    }
}

/// Per component, the size of the products in `lever x force`.
pub(super) fn cross_size(lever: &Vec3, force_size: &Vec3) -> Vec3 {
    let (r, f) = (lever.abs(), force_size);
    Vec3::new(r.y * f.z + r.z * f.y, r.z * f.x + r.x * f.z, r.x * f.y + r.y * f.x)
}

/// Gravity and external loads on every body, about its centre of mass.
pub(super) fn own_loads(structure: &Structure) -> Vec<BodyLoad> {
    let weigh = |mass: f64| {
        let mut load = BodyLoad::ZERO;
        load.add(&(structure.gravity * mass), &Vec3::zeros(), &Vec3::zeros());
        load
    };
    let mut loads: Vec<BodyLoad> = structure.bodies.iter().map(|body| weigh(body.mass)).collect();
    for load in &structure.loads {
        let com = structure.bodies[load.body].com;
        let lever = load.at.map_or_else(Vec3::zeros, |at| at - com);
        loads[load.body].add(&load.force, &load.torque, &lever);
    }
    loads
}

/// Adds to every body what hangs from it through the blocks it is root of.
/// `blocks` come root first, so the last ones are lumped first.
pub(super) fn lump(structure: &Structure, blocks: &[Block], mut loads: Vec<BodyLoad>) -> Vec<BodyLoad> {
    for block in blocks.iter().rev() {
        if let Vertex::Body(root) = block.root {
            let mut total = BodyLoad::ZERO;
            for &body in &block.bodies {
                total += loads[body].moved(&(structure.bodies[body].com - structure.bodies[root].com));
            }
            loads[root] += total;
        }
    }
    loads
}
