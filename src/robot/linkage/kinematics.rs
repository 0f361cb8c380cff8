//! Where the bodies and ports of modules are.

use nalgebra::Vector3;

use crate::robot::module_type::{ModuleType, PortPlace};
use crate::spatial::{Pose, Rotation};

use super::{Linkage, Port};

impl ModuleType {
    /// Poses of the bodies in the frame of the first one, with the joints at these positions.
    ///
    /// The joints of a sound module type make its bodies one tree, so each body has one pose;
    /// a body that no joint leads to keeps the module's frame.
    pub fn body_poses(&self, joints: &[i32]) -> Vec<Pose> {
        let mut poses: Vec<Option<Pose>> = vec![None; self.bodies.len()];
        poses[0] = Some(Pose::identity());
        for _ in 1..self.bodies.len() {
            for (joint, &position) in self.joints.iter().zip(joints) {
                match (poses[joint.parent], poses[joint.child]) {
                    (Some(parent), None) => poses[joint.child] = Some(parent * joint.pose(position)),
                    (None, Some(child)) => poses[joint.parent] = Some(child * joint.pose(position).inverse()),
                    _ => {}
                }
            }
        }
        poses.into_iter().map(Option::unwrap_or_default).collect()
    }
}

impl Linkage {
    /// Poses of a module's bodies in W.
    pub fn body_poses(&self, module: usize) -> Vec<Pose> {
        let Self { modules, .. } = self;
        let local = self.module_type(module).body_poses(&modules[module].joints);
        local.into_iter().map(|pose| modules[module].pose * pose).collect()
    }

    /// Pose of the body that a port sits on, in W.
    pub fn body_of(&self, port: Port) -> Pose {
        let body = self.module_type(port.module).ports[port.port].body;
        self.body_poses(port.module)[body]
    }

    /// Frame of a port at a point, in W: z outwards. `None` for a surface.
    pub fn port_frame(&self, port: Port) -> Option<Pose> {
        match &self.module_type(port.module).ports[port.port].place {
            PortPlace::Point { frame, .. } => Some(self.body_of(port) * frame),
            PortPlace::Surface => None,
        }
    }
}

/// Frame of a port that is engaged with a port at `frame` (both at points, z outwards), turned by
/// `roll` in rad right-handed about the first one's outward axis: at the same place, its z opposite,
/// its x that of `frame` turned by `roll`.
pub fn mated(frame: &Pose, roll: f64) -> Pose {
    let turned = Rotation::from_axis_angle(&Vector3::z_axis(), roll);
    let reversed = Rotation::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI);
    frame * turned * reversed
}

/// Pose in W of a module of this type whose port (at a point) has the frame `port_frame` in W, with
/// its joints at these positions.
///
/// `None` for a surface, which has no frame.
pub fn child_pose(module_type: &ModuleType, port: usize, joints: &[i32], port_frame: &Pose) -> Option<Pose> {
    let port = &module_type.ports[port];
    let PortPlace::Point { frame, .. } = &port.place else { return None };
    Some(port_frame * (module_type.body_poses(joints)[port.body] * frame).inverse())
}
