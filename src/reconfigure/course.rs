//! The transient states of one move: where the moving module is at a phase, and
//! what holds the robot together meanwhile.
//!
//! Knows placements and connections; asks no oracle.

use nalgebra::{Translation3, Unit};

use crate::geometry;
use crate::robot::{Face, Motion, Occupancy, Placement, axis_of_turn};
use crate::spatial::{Pose, Vec3};

use super::assembly::{Engagement, Moving, Transient};
use super::layout::{Bond, neighbour};
use super::moves::Move;

/// A move of one module of a robot.
#[derive(Clone, Debug)]
pub struct Course {
    placements: Vec<Placement>,
    engaged: Vec<Engagement>,
    module: usize,
    start: Pose,
    motion: geometry::Motion,
}

impl Course {
    /// A move of the module in `placements` that is in the cell it starts from.
    /// `bonds` are the connections engaged before it; those of the module itself are
    /// replaced by what holds it on its way. `None` when the cell is empty.
    ///
    /// In a translation the module is held by every face that it overlaps, as far as it
    /// overlaps; in a rotation by the hinge alone.
    pub fn new(placements: Vec<Placement>, bonds: &[Bond], step: Move, pitch: f64) -> Option<Self> {
        let occupancy = Occupancy::of_placements(&placements);
        let module = occupancy.at(step.from)?;
        let others = bonds.iter().filter(|bond| !bond.touches(step.from));
        let mut engaged: Vec<_> = others.filter_map(|&bond| engagement(&occupancy, bond)).collect();
        match step.motion {
            Motion::Translation { .. } => engaged.extend(
                step.sides().into_iter().filter_map(|(cell, side)| Some(face([module, occupancy.at(cell)?], side))),
            ),
            Motion::Rotation { support, towards, .. } => {
                let parent = occupancy.at(neighbour(step.from, support))?;
                let edge = edge_centre(step, support, towards, pitch);
                let frame = Pose::from_parts(Translation3::from(edge), axis_of_turn(support, towards).outward_frame());
                engaged.push(Engagement::Hinge { parent, child: module, frame });
            }
        }
        let start = placements[module].pose(pitch);
        Some(Self { placements, engaged, module, start, motion: motion(step, pitch) })
    }

    /// The state at a phase from 0 to 1.
    pub fn at(&self, phase: f64) -> Transient<'_> {
        let moving = Moving { module: self.module, pose: self.motion.pose(&self.start, phase) };
        Transient { placements: &self.placements, moving: Some(moving), engaged: &self.engaged }
    }
}

/// The motion of the moving module in W.
pub fn motion(step: Move, pitch: f64) -> geometry::Motion {
    match step.motion {
        Motion::Translation { by } => geometry::Motion::Translation { by: Vec3::from(by.map(f64::from)) * pitch },
        Motion::Rotation { support, towards, turn } => geometry::Motion::Rotation {
            centre: edge_centre(step, support, towards, pitch),
            axis: Unit::new_unchecked(axis_of_turn(support, towards).normal()),
            angle: turn.degrees().to_radians(),
        },
    }
}

/// The connection of two resting modules.
pub fn engagement(occupancy: &Occupancy, bond: Bond) -> Option<Engagement> {
    let [first, second] = bond.cells();
    Some(face([occupancy.at(first)?, occupancy.at(second)?], bond.face()))
}

/// Two connected faces, the module of smaller index first.
fn face(modules: [usize; 2], towards: Face) -> Engagement {
    let [a, b] = modules;
    if a < b {
        Engagement::Face { modules, towards }
    } else {
        Engagement::Face { modules: [b, a], towards: towards.opposite() }
    }
}

/// Centre of the edge that a module turns about, in W, in m.
fn edge_centre(step: Move, support: Face, towards: Face, pitch: f64) -> Vec3 {
    Placement::new(step.from).centre(pitch) + (support.normal() + towards.normal()) * (pitch / 2.0)
}
