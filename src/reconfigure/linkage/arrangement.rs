//! Where the modules of a robot are, up to all that makes no difference: the states of a search.
//!
//! Modules of one class are interchangeable, each up to the symmetries of its type; in an empty world
//! the whole robot up to any displacement, on a bare ground up to those along it.

use std::sync::{Arc, Mutex};

use nalgebra::Vector3;

use crate::spatial::{Pose, Rotation, Vec3};

use super::places::{Descriptions, Place, PlaceId, Places};
use super::problem::Class;

/// Share of a horizontal axis above which it tells where a module looks. No multiple of a
/// usual step, so that no robot is on the edge of it.
const LEVEL: f64 = 0.012_34;

/// Up to which displacement robots are the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Frame {
    /// None: there is something in the world, or the goal is in a place of its own.
    World,
    /// Those along the ground and about the vertical, z.
    Ground,
    /// All.
    Free,
}

/// Numbers of the modules' places, ascending, in a frame that follows from them.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Arrangement(pub Arc<[PlaceId]>);

/// Arrangements of the modules of one problem.
#[derive(Debug)]
pub struct Arrangements {
    frame: Frame,
    places: Mutex<Places>,
}

/// An arrangement with the frame that its places are in, in the one that it was made from.
#[derive(Clone, Debug)]
pub struct Framed {
    /// The arrangement.
    pub arrangement: Arrangement,
    /// Its frame.
    pub frame: Pose,
    /// The place of each module that it was made from, in their order.
    pub of_module: Vec<PlaceId>,
}

impl Arrangements {
    /// Of modules of these classes, the same up to displacements of `frame`.
    pub fn new(classes: &[Class], frame: Frame) -> Self {
        Self { frame, places: Mutex::new(Places::new(classes)) }
    }

    /// The modules of an arrangement, in the order of their places.
    pub fn modules(&self, arrangement: &Arrangement) -> Vec<Arc<Place>> {
        let places = self.lock();
        arrangement.0.iter().map(|&id| Arc::clone(places.place(id))).collect()
    }

    /// The arrangement of modules, each by class, pose and joint positions.
    pub fn of(&self, modules: &[(usize, Pose, Arc<[i32]>)]) -> Framed {
        let mut places = self.lock();
        let described: Vec<Arc<Descriptions>> =
            modules.iter().map(|(class, _, joints)| places.descriptions(*class, joints)).collect();
        let mut best: Option<Framed> = None;
        for frame in self.frames(modules, &described) {
            let back = frame.inverse();
            let of_module: Vec<PlaceId> = modules
                .iter()
                .zip(&described)
                .map(|((class, pose, _), described)| places.number(*class, &(back * pose), described))
                .collect();
            let mut sorted = of_module.clone();
            sorted.sort_unstable();
            if best.as_ref().is_none_or(|best| sorted[..] < *best.arrangement.0) {
                best = Some(Framed { arrangement: Arrangement(sorted.into()), frame, of_module });
            }
        }
        best.expect("a robot has a frame")
    }

    /// The frames that a robot may be described in: the world's, or one for each way to describe those of its
    /// modules that are of the rarest kind.
    fn frames(&self, modules: &[(usize, Pose, Arc<[i32]>)], described: &[Arc<Descriptions>]) -> Vec<Pose> {
        if self.frame == Frame::World || modules.is_empty() {
            return vec![Pose::identity()];
        }
        let kind = |index: usize| (modules[index].0, &described[index].joints);
        let ways = |index: usize| {
            let alike = (0..modules.len()).filter(|&other| kind(other) == kind(index));
            alike.map(|other| described[other].frames.len()).sum::<usize>()
        };
        let rarest = (0..modules.len()).min_by_key(|&index| (ways(index), kind(index))).expect("there are modules");
        let alike = (0..modules.len()).filter(|&index| kind(index) == kind(rarest));
        let frames = alike.flat_map(|index| described[index].frames.iter().map(move |frame| modules[index].1 * frame));
        match self.frame {
            Frame::Free => frames.collect(),
            Frame::World | Frame::Ground => frames.flat_map(|frame| upright(&frame)).collect(),
        }
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, Places> {
        self.places.lock().expect("no thread panics while it holds the places")
    }
}

/// Frames on the ground below a frame, each looking where one of its axes does.
fn upright(frame: &Pose) -> Vec<Pose> {
    let below = Vec3::new(frame.translation.x, frame.translation.y, 0.0);
    let axes = [Vec3::x(), Vec3::y(), Vec3::z()].map(|axis| frame.rotation * axis);
    let level = axes.into_iter().filter(|axis| axis.x.hypot(axis.y) > LEVEL);
    let yaw = level.map(|axis| Rotation::from_axis_angle(&Vector3::z_axis(), axis.y.atan2(axis.x)));
    yaw.map(|yaw| Pose::from_parts(below.into(), yaw)).collect()
}
