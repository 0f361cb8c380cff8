//! Where the modules of a linkage are, and what makes two states of it different ones.

use crate::reconfigure::linkage::assembly::Touched;
use crate::reconfigure::partial_order::Because;
use crate::robot::linkage::{Linkage, MEETING};

/// Parts of a metre, and of the length of an axis, in which places are told from each other: far above the rounding
/// of poses, and far below a micro-degree.
const PARTS: f64 = 1e9;

/// All of a state but its connections: positions of the joints, poses, and what holds together, since that is what
/// a move carries.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Place {
    joints: Vec<Vec<i32>>,
    /// Of each module its position and its axes.
    poses: Vec<[i64; 12]>,
    components: Vec<usize>,
}

impl Place {
    /// Where a state has its modules.
    pub fn of(state: &Linkage) -> Self {
        let pose = |module: usize| {
            let pose = state.modules[module].pose.to_homogeneous();
            std::array::from_fn(|i| (pose[(i % 3, i / 3)] * PARTS).round() as i64)
        };
        Self {
            joints: state.modules.iter().map(|module| module.joints.clone()).collect(),
            poses: (0..state.modules.len()).map(pose).collect(),
            components: state.components(),
        }
    }
}

/// What makes two states of one robot different ones: their connections or their joints in integers, or that their
/// modules are elsewhere in the world; `None` where they are the same.
pub fn difference(one: &Linkage, other: &Linkage) -> Option<Because<Touched>> {
    let joints = |state: &Linkage| state.modules.iter().map(|module| module.joints.clone()).collect::<Vec<_>>();
    let codes = |state: &Linkage| state.connections.iter().map(|held| state.code(held)).collect::<Vec<_>>();
    if one.connections != other.connections || joints(one) != joints(other) || codes(one) != codes(other) {
        return Some(Because::OtherState);
    }
    let is_elsewhere = |module: usize| {
        let [a, b] = [one, other].map(|state| &state.modules[module].pose);
        let apart = (a.translation.vector - b.translation.vector).norm();
        let same = apart <= MEETING * one.module_type(module).size() && a.rotation.angle_to(&b.rotation) <= MEETING;
        !same
    };
    (0..one.modules.len()).any(is_elsewhere).then_some(Because::OtherPlaces)
}
