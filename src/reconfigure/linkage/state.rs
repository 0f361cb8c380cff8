//! A linkage in integers, and what actions do to it: exactly, so that an action and its reversal return the
//! identical state.
//!
//! Poses follow from the joints and from how ports engage ([`Linkage::placed_by`]). Where the module that the
//! others follow from moves itself, it comes back to where it was before exactly, not nearly.

use crate::geometry::Motion;
use crate::robot::linkage::{Code, Connection, Linkage};
use crate::spatial::Pose;

use super::action::Action;
use super::moves::{Step, View};

/// Distance in m, and angle in rad, up to which a pose is one that was taken before: far above the rounding of
/// any number of moves, and far below a micro-degree.
const SAME: f64 = 1e-9;

/// A linkage with a code for each of its connections.
#[derive(Clone, Debug)]
pub struct State {
    linkage: Linkage,
    codes: Vec<Code>,
    /// Poses of modules that others follow from, before and after each move of one.
    taken: Vec<Pose>,
}

impl PartialEq for State {
    /// By where it is now, whatever the way.
    fn eq(&self, other: &Self) -> bool {
        self.linkage == other.linkage && self.codes == other.codes
    }
}

impl State {
    /// A linkage with its connections sorted and its modules where the codes of these place them.
    pub fn new(mut linkage: Linkage) -> Self {
        linkage.connections.sort_unstable();
        let codes = linkage.connections.iter().map(|connection| linkage.code(connection)).collect();
        let mut state = Self { linkage, codes, taken: Vec::new() };
        state.derive();
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
        let first = self.linkage.components();
        for module in (0..first.len()).filter(|&module| first[module] == module && view.moves(step, module, 0)) {
            let before = self.linkage.modules[module].pose;
            self.linkage.modules[module].pose = self.again(before, &step.motion);
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

    /// A pose after a motion: the one that was taken there before, if it was.
    fn again(&mut self, before: Pose, motion: &Motion) -> Pose {
        self.remembered(before);
        self.remembered(motion.pose(&before, 1.0))
    }

    fn remembered(&mut self, pose: Pose) -> Pose {
        let is_same = |other: &&Pose| {
            let apart = other.translation.vector - pose.translation.vector;
            apart.norm() <= SAME && other.rotation.angle_to(&pose.rotation) <= SAME
        };
        if let Some(known) = self.taken.iter().find(is_same) {
            return *known;
        }
        self.taken.push(pose);
        pose
    }
}
