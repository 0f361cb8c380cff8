//! A block's wrench field, with the forces at the points of its faces.
//!
//! What a face demands takes an iteration to find (see `patch`), but not where it is
//! known how its points share the wrench: forces inside their friction cones that add
//! up to the wrench and a preload show that this preload is enough. So faces are
//! carried, balanced and put back by their points.

use crate::spatial::{Vec3, Wrench};

use super::super::blocks::Link;
use super::super::bracket::Problem;
use super::super::connector::{Connector, Model};
use super::super::patch::face_forces;
use super::super::spread::Spread;
use super::super::structure::Structure;
use super::super::tolerances::ROUNDING;

/// Share of the level that a face's preload leaves unused, to cover rounding.
const SPARE: f64 = 1e-6;

/// Rounding of a sum over a face's points, relative to their normal force: three
/// orders more than it can be where `Spread` accepts the points.
const ERROR: f64 = 1e-9;

/// How near to its friction cone's boundary a point may be where springs share the wrench.
const SPRINGS: f64 = 0.9;

/// Wrenches of a block's links, and what the points of its faces carry of them.
#[derive(Clone, Default)]
pub(super) struct Field {
    /// Per link, in its frame.
    pub wrenches: Vec<Wrench>,
    /// Forces in N at the points of all faces, one face after the other, each in its frame: together they are
    /// the face's wrench and its preload.
    pub points: Vec<Vec3>,
}

/// A face: its connector and points.
#[derive(Clone, Copy)]
pub(super) struct Face<'s> {
    connector: &'s Connector,
    friction: f64,
    pub points: &'s [[f64; 2]],
}

/// The face that a link is, if it is one.
pub(super) fn face(structure: &Structure, link: Link) -> Option<Face<'_>> {
    let Link::Connection(i) = link else { return None };
    let connector = &structure.connectors[structure.connections[i].connector];
    match &connector.model {
        Model::Patch { friction, points } => Some(Face { connector, friction: *friction, points }),
        Model::Cone { .. } | Model::Box { .. } => None,
    }
}

impl Face<'_> {
    /// Its preload at strengths `level` times the rated ones.
    pub(super) fn preload(&self, level: f64) -> f64 {
        level * self.connector.strength * (1.0 - SPARE)
    }

    /// Whether `forces` can be how the points share `wrench` at a preload.
    pub(super) fn is_shared_by(&self, wrench: &Wrench, forces: &[Vec3], preload: f64) -> bool {
        let total: f64 = forces.iter().map(|force| force.z).sum();
        forces.len() == self.points.len() && (total - wrench.force.z - preload).abs() <= SPARE * preload
    }

    /// How the points can share `wrench` at a preload: as springs where that is well
    /// inside the friction cones, else as with the least preload.
    pub(super) fn share(&self, wrench: &Wrench, preload: f64) -> Vec<Vec3> {
        let pressed = Wrench::new(wrench.force + Vec3::z() * preload, wrench.torque);
        let spread = Spread::new(self.points);
        let springs: Vec<Vec3> = self.points.iter().map(|p| spread.force(p, &pressed)).collect();
        let inside = |force: &Vec3| force.xy().norm() <= SPRINGS * self.friction * force.z;
        if springs.iter().all(inside) {
            return springs;
        }
        face_forces(&pressed, self.friction, self.points, 0.0).unwrap_or(springs)
    }

    /// The wrench that `forces` at its points and the preload add up to.
    pub(super) fn wrench(&self, forces: &[Vec3], preload: f64) -> Wrench {
        let mut sum = Wrench::new(Vec3::z() * -preload, Vec3::zeros());
        for (p, force) in self.points.iter().zip(forces) {
            sum += at(p, force);
        }
        sum
    }

    /// Upper bound on the utilisation that `wrench` demands, as `forces` at the points
    /// or springs prove it. `None` where they prove nothing.
    pub(super) fn at_most(&self, wrench: &Wrench, forces: &[Vec3], enough: f64) -> Option<f64> {
        let spread = Spread::new(self.points);
        let f_z = wrench.force.z;
        let demand =
            |normal: f64| (normal - f_z + f_z.abs() * ROUNDING).max(0.0) / self.connector.strength * (1.0 + ROUNDING);
        let springs = demand(spread.ample_normal_force(wrench, self.friction));
        if springs <= enough {
            return Some(springs);
        }
        let (mut total, mut sum) = (0.0, Wrench::ZERO);
        for (p, force) in self.points.iter().zip(forces) {
            let held = force.xy().norm() / self.friction * (1.0 + ROUNDING);
            let pressed = Vec3::new(force.x, force.y, force.z.max(held));
            total += pressed.z;
            sum += at(p, &pressed);
        }
        // What the points lack, rounding included, springs carry on top.
        let rest = spread.ample_normal_force(&(*wrench - sum), self.friction);
        let least = demand(total * (1.0 + ERROR) + rest).min(springs);
        (least < f64::INFINITY).then_some(least)
    }
}

/// A force at a point of the plane z = 0, about the origin.
fn at(p: &[f64; 2], force: &Vec3) -> Wrench {
    Wrench::new(*force, Vec3::new(p[0], p[1], 0.0).cross(force))
}

impl Field {
    /// The field of `wrenches` at strengths `level` times the rated ones. `known` has the
    /// forces that are remembered at the points of a face, if any.
    pub(super) fn new(
        problem: &Problem<'_>,
        wrenches: Vec<Wrench>,
        level: f64,
        known: impl Fn(Link) -> Vec<Vec3>,
    ) -> Self {
        let mut points = Vec::new();
        for (&link, wrench) in problem.block.links.iter().zip(&wrenches) {
            if let Some(face) = face(problem.structure, link) {
                let (preload, known) = (face.preload(level), known(link));
                let fits = face.is_shared_by(wrench, &known, preload);
                points.extend(if fits { known } else { face.share(wrench, preload) });
            }
        }
        Self { wrenches, points }
    }

    /// Adds `change` times `factor`.
    pub(super) fn add(&mut self, change: &Self, factor: f64) {
        for (wrench, change) in self.wrenches.iter_mut().zip(&change.wrenches) {
            *wrench += *change * factor;
        }
        for (point, change) in self.points.iter_mut().zip(&change.points) {
            *point += change * factor;
        }
    }
}
