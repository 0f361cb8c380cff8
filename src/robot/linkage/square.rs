//! Robots in which everything is turned by quarters against everything else, and stays so.

use crate::robot::module_type::{ModuleType, PortPlace};
use crate::spatial::Rotation;

use super::Linkage;
use super::symmetry::{is_multiple, is_quartered};

/// Whether in these robots of one catalogue, and in all that moves make of them, modules are turned by
/// quarters against each other: so are their ports, and joints and rolling ports turn by quarters about
/// their axes. Ports then sit on the axes of balls only.
pub fn is_square(linkages: &[&Linkage]) -> bool {
    let Some(reference) = linkages.iter().find_map(|linkage| linkage.modules.first()) else { return true };
    let back: Rotation = reference.pose.rotation.inverse();
    linkages.iter().all(|linkage| {
        linkage.modules.iter().enumerate().all(|(index, module)| {
            is_quartered(&(back * module.pose.rotation)) && keeps_square(linkage.module_type(index))
        })
    })
}

/// Whether a type has ports and joints along its axes only, and moves by quarter turns.
fn keeps_square(kind: &ModuleType) -> bool {
    let ports = kind.ports.iter().all(|port| match &port.place {
        PortPlace::Point { frame, orientations } => {
            is_quartered(&frame.rotation) && matches!(orientations, 0 | 1 | 2 | 4)
        }
        PortPlace::Surface => is_quartered(&kind.bodies[port.body].shape_pose.rotation),
    });
    let along_an_axis = |axis: &crate::spatial::Vec3| axis.amax() >= 1.0 - super::MEETING;
    let joints = kind.joints.iter().all(|joint| along_an_axis(&joint.axis) && is_multiple(joint.step_degrees, 90.0));
    ports && joints && kind.roll_step_degrees.is_none_or(|step| is_multiple(step - 90.0, 360.0))
}
