//! A linkage in integers, and what actions do to it: exactly, so that an action and its reversal return the
//! identical state.
//!
//! Poses follow from the joints and from how ports engage ([`Linkage::placed_by`]). Where the module that the
//! others follow from moves itself, its displacement from where it was at first is on a grid.

use crate::geometry::Motion;
use crate::robot::linkage::{Code, Connection, Linkage};
use crate::spatial::{Pose, Rotation};

use super::action::Action;
use super::moves::{Step, View};

/// Steps of the grid of displacements in a metre, and in the unit of a quaternion: far below every tolerance, far
/// above the rounding of poses.
const GRID: f64 = (1_u64 << 36) as f64;

/// A linkage with a code for each of its connections.
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    linkage: Linkage,
    codes: Vec<Code>,
    /// Where each module was at first.
    home: Vec<Pose>,
}

impl State {
    /// A linkage with its connections sorted and its modules where the codes of these place them.
    pub fn new(mut linkage: Linkage) -> Self {
        linkage.connections.sort_unstable();
        let codes = linkage.connections.iter().map(|connection| linkage.code(connection)).collect();
        let mut state = Self { linkage, codes, home: Vec::new() };
        state.derive();
        state.home = state.linkage.modules.iter().map(|module| module.pose).collect();
        state
    }

    /// The linkage.
    pub fn linkage(&self) -> &Linkage {
        &self.linkage
    }

    /// Engages a connection whose ports meet.
    pub fn attach(&mut self, connection: Connection) {
        let at = self.linkage.connections.partition_point(|other| *other < connection);
        self.codes.insert(at, self.linkage.code(&connection));
        self.linkage.connections.insert(at, connection);
        self.derive();
    }

    /// Releases a connection; one that is not engaged is left alone.
    pub fn detach(&mut self, connection: Connection) {
        if let Ok(at) = self.linkage.connections.binary_search(&connection) {
            self.linkage.connections.remove(at);
            self.codes.remove(at);
            self.derive();
        }
    }

    /// Makes a move of the linkage, whose modules `view` shows in their order. What joins the two sides must have been
    /// released.
    pub fn take(&mut self, view: &View, step: &Step) {
        for module in 0..self.linkage.modules.len() {
            if view.moves(step, module, 0) {
                let moved = displaced(&self.linkage.modules[module].pose, &step.motion, &self.home[module]);
                self.linkage.modules[module].pose = moved;
            }
        }
        match step.action {
            Action::Rotate { module, joint, to, .. } => self.linkage.modules[module].joints[joint] = to,
            Action::Roll { connection, to, .. } => {
                if let Ok(at) = self.linkage.connections.binary_search(&connection) {
                    self.codes[at] = Code::OnSurface(to);
                }
            }
            Action::Attach(_) | Action::Detach(_) => {}
        }
        self.derive();
    }

    /// Places the modules by their codes.
    fn derive(&mut self) {
        let poses = self.linkage.placed_by(&self.codes);
        for (module, pose) in self.linkage.modules.iter_mut().zip(poses) {
            module.pose = pose;
        }
    }
}

/// A pose after a motion, displaced from `home` by what is nearest on the grid.
fn displaced(pose: &Pose, motion: &Motion, home: &Pose) -> Pose {
    let displacement = motion.pose(pose, 1.0) * home.inverse();
    let on_grid = |x: f64| (x * GRID).round() / GRID;
    // Of a quaternion and its opposite, the same rotation, the one whose largest part is positive.
    let quaternion = displacement.rotation.coords;
    let sign = if quaternion[quaternion.iamax()] < 0.0 { -1.0 } else { 1.0 };
    let rotation = Rotation::from_quaternion((sign * quaternion).map(on_grid).into());
    Pose::from_parts(displacement.translation.vector.map(on_grid).into(), rotation) * home
}
