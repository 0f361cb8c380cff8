//! Soundness of module types: bodies, joints and ports on their own.

use petgraph::unionfind::UnionFind;

use crate::statics::{Connector, Model};

use super::module_type::{JointType, ModuleType, PortPlace, PortType};
use super::problem::{Fault, Findings, Part};

impl ModuleType {
    /// Adds everything that is wrong with the module type with this index, in a catalogue of these
    /// connectors.
    pub(super) fn check(&self, findings: &mut Findings, index: usize, connectors: &[Connector]) {
        let part = Part::ModuleType(index);
        if self.bodies.is_empty() {
            findings.add(part, "bodies", Fault::NoBodies);
        }
        for (i, body) in self.bodies.iter().enumerate() {
            let part = Part::BodyType(index, i);
            findings.not_negative(part, "mass", &[body.mass]);
            findings.finite(part, "com", body.com.as_slice());
            findings.finite(part, "shape_position", body.shape_pose.translation.vector.as_slice());
            findings.finite(part, "shape_rotation", body.shape_pose.rotation.coords.as_slice());
            body.shape.check(findings, part);
        }
        self.check_joints(findings, index);
        for (i, port) in self.ports.iter().enumerate() {
            self.check_port(findings, Part::PortType(index, i), port, connectors);
        }
        if let Some(step) = self.roll_step_degrees {
            findings.positive(part, "roll_step", &[step]);
        }
    }

    fn check_joints(&self, findings: &mut Findings, index: usize) {
        let count = self.bodies.len();
        let mut sets = UnionFind::<usize>::new(count);
        let mut sound = true;
        let mut joined = 0;
        for (i, joint) in self.joints.iter().enumerate() {
            let part = Part::JointType(index, i);
            check_joint(findings, part, joint);
            let known = [("parent", joint.parent), ("child", joint.child)]
                .map(|(field, body)| findings.in_range(part, field, body, count));
            if known == [true, true] {
                joined += usize::from(sets.union(joint.parent, joint.child));
            } else {
                sound = false;
            }
        }
        if sound && count > 0 && (joined + 1 != count || self.joints.len() != joined) {
            findings.add(Part::ModuleType(index), "joints", Fault::NotATree);
        }
    }

    fn check_port(&self, findings: &mut Findings, part: Part, port: &PortType, connectors: &[Connector]) {
        let known = findings.in_range(part, "body", port.body, self.bodies.len());
        if let Some(connector) = port.connector
            && findings.in_range(part, "connector", connector, connectors.len())
            && self.lattice.is_none()
            && matches!(&connectors[connector].model, Model::Patch { points, .. } if points.is_empty())
        {
            findings.add(part, "connector", Fault::PatchWithoutFace);
        }
        match &port.place {
            PortPlace::Point { frame, .. } => {
                findings.finite(part, "position", frame.translation.vector.as_slice());
                findings.finite(part, "axis", frame.rotation.coords.as_slice());
            }
            PortPlace::Surface if known => {
                if self.bodies[port.body].shape.ball_radius().is_none() {
                    findings.add(part, "surface", Fault::SurfaceNotABall);
                }
            }
            PortPlace::Surface => {}
        }
    }
}

fn check_joint(findings: &mut Findings, part: Part, joint: &JointType) {
    findings.finite(part, "axis", joint.axis.as_slice());
    findings.finite(part, "origin", joint.origin.as_slice());
    findings.positive(part, "step", &[joint.step_degrees]);
    findings.positive(part, "torque", &[joint.torque]);
    if let Some([low, high]) = joint.range
        && !(low <= 0 && 0 <= high)
    {
        findings.add(part, "range", Fault::RangeWithoutZero);
    }
}
