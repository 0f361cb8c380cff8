//! Module types that look the same when described in another way: the symmetries of a type, derived from
//! its data.
//!
//! A symmetry is a rigid map for each body onto a body of the same type that keeps everything a robot could
//! notice: masses, centres of mass, solids, ports with their connectors, and the joints with axes, ranges and
//! torques. Knows nothing of where modules are.

use nalgebra::{Unit, Vector3};

use crate::robot::catalogue::Catalogue;
use crate::robot::lattice::Face;
use crate::robot::module_type::{BodyType, JointType, ModuleType, PortPlace, PortType};
use crate::robot::shape::Shape;
use crate::spatial::{Point, Pose, Rotation, Vec3};
use crate::statics::Model;

use super::MEETING;

/// Turns of ports and balls that are tried, in degrees.
const TURN: f64 = 15.0;

/// Where on a ball ports may come to sit, as far as turns of it depend on that.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Directions<'a> {
    /// On its axes only, turned by quarters: see [`super::is_square`]. It looks the same from all of them.
    Axes,
    /// Anywhere; ports roll over it in these steps, in degrees. It is only turned so that a path in such steps
    /// stays one: about its z axis, and upside down.
    Steps(&'a [f64]),
}

/// How a position of one joint reads as one of another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct JointMap {
    to: usize,
    sign: i32,
    offset: i32,
}

/// Another description of the same module: another pose and other joint positions with which all its bodies
/// are where they are, up to which is which.
#[derive(Clone, Debug, PartialEq)]
pub struct Symmetry {
    /// The body that is described as the first one.
    first: usize,
    /// The frame of the first body as described, in that body's frame.
    turn: Pose,
    joints: Vec<JointMap>,
}

impl Symmetry {
    /// Pose and joint positions (within one turn, where joints turn without end) of the other description
    /// of a module with this pose and these joint positions.
    pub fn described(&self, module_type: &ModuleType, pose: &Pose, joints: &[i32]) -> (Pose, Vec<i32>) {
        let body = if self.first == 0 { Pose::identity() } else { module_type.body_poses(joints)[self.first] };
        (pose * body * self.turn, self.positions(module_type, joints))
    }

    /// Whether a point of the module frame, in m, is at the same place in the other description, up to a distance in m.
    pub fn keeps_point(&self, point: &Vec3, tolerance: f64) -> bool {
        self.first == 0 && ((self.turn * Point::from(*point)).coords - point).norm() <= tolerance
    }

    /// The joint positions of [`Symmetry::described`].
    pub fn positions(&self, module_type: &ModuleType, joints: &[i32]) -> Vec<i32> {
        let mut positions = vec![0; joints.len()];
        for (map, position) in self.joints.iter().zip(joints) {
            positions[map.to] = module_type.joints[map.to].canonical(map.sign * position + map.offset);
        }
        positions
    }
}

impl Catalogue {
    /// The symmetries of a module type, the identity first.
    ///
    /// All that map ports onto ports, or a ball as [`Directions`] allow in steps of 15 degrees; a body with neither
    /// has the identity alone. A port is turned by as much as its connector and its angles allow.
    pub fn symmetries(&self, module_type: usize, directions: Directions) -> Vec<Symmetry> {
        let kind = &self.module_types[module_type];
        let tolerance = MEETING * kind.size().max(f64::MIN_POSITIVE);
        Search { catalogue: self, kind, directions, tolerance }.all()
    }
}

/// What is tried for one module type.
struct Search<'a> {
    catalogue: &'a Catalogue,
    kind: &'a ModuleType,
    directions: Directions<'a>,
    /// Distance in m up to which places are the same.
    tolerance: f64,
}

/// For each body the one that it is described as and that one's frame in its own, as far as decided.
#[derive(Clone)]
struct Partial {
    bodies: Vec<Option<(usize, Pose)>>,
    joints: Vec<Option<JointMap>>,
}

impl Search<'_> {
    fn all(&self) -> Vec<Symmetry> {
        let count = self.kind.bodies.len();
        let root = self.kind.ports.first().map_or(0, |port| port.body);
        let order = self.order(root);
        let mut found = Vec::new();
        for to in 0..count {
            for turn in self.candidates(root, to) {
                let mut partial = Partial { bodies: vec![None; count], joints: vec![None; self.kind.joints.len()] };
                if self.keeps_body(root, to, &turn) {
                    partial.bodies[root] = Some((to, turn));
                    self.extend(&order, partial, &mut found);
                }
            }
        }
        let is_identity = |symmetry: &Symmetry| {
            let same = |(joint, map): (usize, &JointMap)| *map == JointMap { to: joint, sign: 1, offset: 0 };
            symmetry.first == 0
                && self.is_same(&symmetry.turn, &Pose::identity())
                && symmetry.joints.iter().enumerate().all(same)
        };
        let joints = (0..self.kind.joints.len()).map(|to| JointMap { to, sign: 1, offset: 0 }).collect();
        let mut all = vec![Symmetry { first: 0, turn: Pose::identity(), joints }];
        all.extend(found.into_iter().filter(|symmetry| !is_identity(symmetry)));
        all
    }

    /// The joints from a body outwards, each with the body that it starts from.
    fn order(&self, root: usize) -> Vec<(usize, usize)> {
        let (mut order, mut reached) = (Vec::new(), vec![root]);
        let mut at = 0;
        while at < reached.len() {
            let body = reached[at];
            for (index, joint) in self.kind.joints.iter().enumerate() {
                let far = if joint.parent == body { joint.child } else { joint.parent };
                if (joint.parent == body || joint.child == body) && !reached.contains(&far) {
                    order.push((index, body));
                    reached.push(far);
                }
            }
            at += 1;
        }
        order
    }

    /// Maps of a body onto another worth trying: those that carry its first port onto a port.
    fn candidates(&self, from: usize, to: usize) -> Vec<Pose> {
        let turns = (0..24).map(|i| (f64::from(i) * TURN).to_radians());
        let about_z = |angle| Rotation::from_axis_angle(&Vector3::z_axis(), angle);
        let Some(port) = self.kind.ports.iter().find(|port| port.body == from) else { return vec![Pose::identity()] };
        let mut candidates = Vec::new();
        for other in self.kind.ports.iter().filter(|other| other.body == to) {
            match (&port.place, &other.place) {
                (PortPlace::Point { frame: a, .. }, PortPlace::Point { frame: b, .. }) => {
                    candidates.extend(turns.clone().map(|angle| a * about_z(angle) * b.inverse()));
                }
                (PortPlace::Surface, PortPlace::Surface) => {
                    let [a, b] = [from, to].map(|body| self.kind.bodies[body].shape_pose.translation.vector);
                    // z to any axis, and about it: of these `keeps_grid` leaves what the directions allow.
                    for turn in turns.clone().flat_map(|t| Face::ALL.map(|face| face.outward_frame() * about_z(t))) {
                        candidates.push(Pose::from_parts((a - turn * b).into(), turn));
                    }
                }
                _ => {}
            }
        }
        candidates
    }

    /// Adds all symmetries that complete a partial one, joint by joint.
    fn extend(&self, order: &[(usize, usize)], partial: Partial, found: &mut Vec<Symmetry>) {
        let Some((&(index, near), rest)) = order.split_first() else {
            let joints = partial.joints.into_iter().map(|map| map.expect("all joints are in the order")).collect();
            let described = |&(_, body): &(usize, &Option<(usize, Pose)>)| body.is_some_and(|(to, _)| to == 0);
            if let Some((first, Some((_, turn)))) = partial.bodies.iter().enumerate().find(described) {
                found.push(Symmetry { first, turn: *turn, joints });
            }
            return;
        };
        let joint = &self.kind.joints[index];
        let far = if joint.parent == near { joint.child } else { joint.parent };
        let (described, turn) = partial.bodies[near].expect("the order starts from bodies that are decided");
        for (to, other) in self.kind.joints.iter().enumerate() {
            let far_to = match described {
                body if other.parent == body => other.child,
                body if other.child == body => other.parent,
                _ => continue,
            };
            let is_free = partial.joints.iter().flatten().all(|map| map.to != to)
                && partial.bodies.iter().flatten().all(|(body, _)| *body != far_to);
            let Some(along) = self.along(joint, other, &turn).filter(|_| is_free && alike(joint, other)) else {
                continue;
            };
            // Seen from the near body, a joint turns its far body forwards if the near one is its parent.
            let forwards = |joint: &JointType, near: usize| if joint.parent == near { 1 } else { -1 };
            let sign = forwards(joint, near) * along * forwards(other, described);
            for offset in offsets(joint, other, sign) {
                let angle = f64::from(offset * forwards(other, described)) * other.step_degrees.to_radians();
                let rotation = Rotation::from_axis_angle(&other.axis, angle);
                let turn = turn * Pose::rotation_wrt_point(rotation, Point::from(other.origin));
                if self.keeps_body(far, far_to, &turn) {
                    let mut partial = partial.clone();
                    partial.bodies[far] = Some((far_to, turn));
                    partial.joints[index] = Some(JointMap { to, sign, offset });
                    self.extend(rest, partial, found);
                }
            }
        }
    }

    /// Whether a map carries one joint's axis to that of another: 1 along it, -1 against it.
    fn along(&self, joint: &JointType, other: &JointType, turn: &Pose) -> Option<i32> {
        let axis: Unit<Vec3> = turn.rotation * other.axis;
        let apart = (turn * Point::from(other.origin)).coords - joint.origin;
        let on_line = joint.axis.cross(&axis).norm() <= MEETING && joint.axis.cross(&apart).norm() <= self.tolerance;
        on_line.then_some(if joint.axis.dot(&axis) > 0.0 { 1 } else { -1 })
    }

    /// Whether a map (the frame of `to` in that of `from`) carries one body with its ports onto another.
    fn keeps_body(&self, from: usize, to: usize, turn: &Pose) -> bool {
        let [a, b] = [from, to].map(|body| &self.kind.bodies[body]);
        let ports = |body: usize| self.kind.ports.iter().filter(move |port| port.body == body);
        a.mass == b.mass
            && ((turn * Point::from(b.com)).coords - a.com).norm() <= self.tolerance
            && self.keeps_solid(a, b, turn)
            && ports(from).count() == ports(to).count()
            && ports(from).all(|port| ports(to).any(|other| self.keeps_port(port, other, turn)))
    }

    fn keeps_solid(&self, a: &BodyType, b: &BodyType, turn: &Pose) -> bool {
        let between = a.shape_pose.inverse() * turn * b.shape_pose;
        let centred = between.translation.vector.norm() <= self.tolerance;
        match (&a.shape, &b.shape) {
            (Shape::Cuboid { half_extents: a }, Shape::Cuboid { half_extents: b }) => {
                let turned = between.rotation.to_rotation_matrix().into_inner().abs();
                centred && is_quartered(&between.rotation) && (turned * b - a).norm() <= self.tolerance
            }
            (Shape::Cylinder { radius: a, height: h }, Shape::Cylinder { radius: b, height: k }) => {
                let along = between.rotation * Vec3::z();
                centred && a == b && h == k && along.x.hypot(along.y) <= MEETING
            }
            (Shape::Ball { radius: a }, Shape::Ball { radius: b }) => centred && a == b,
            (Shape::Convex(a), Shape::Convex(b)) => {
                let moved = |p: &Vec3| (between * Point::from(*p)).coords;
                let is_corner = |p: Vec3| a.corners().iter().any(|q| (p - q).norm() <= self.tolerance);
                a.corners().len() == b.corners().len() && b.corners().iter().all(|p| is_corner(moved(p)))
            }
            (Shape::Cuboid { .. } | Shape::Cylinder { .. } | Shape::Ball { .. } | Shape::Convex(_), _) => false,
        }
    }

    fn keeps_port(&self, port: &PortType, other: &PortType, turn: &Pose) -> bool {
        if port.connector != other.connector {
            return false;
        }
        match (&port.place, &other.place) {
            (PortPlace::Point { frame: a, orientations: m }, PortPlace::Point { frame: b, orientations: n }) => {
                let between = a.inverse() * turn * b;
                let z = between.rotation * Vec3::z();
                let x = between.rotation * Vec3::x();
                let angle = x.y.atan2(x.x);
                m == n
                    && between.translation.vector.norm() <= self.tolerance
                    && (z - Vec3::z()).norm() <= MEETING
                    // A port that engages with surfaces only has no angles.
                    && (*m == 0 || is_multiple(angle.to_degrees(), 360.0 / f64::from(*m)))
                    // Rolling over the poles of a ball goes by the port's own axes.
                    && self.kind.roll_step_degrees.is_none_or(|step| is_multiple(angle.to_degrees(), step))
                    && port.connector.is_none_or(|connector| self.allows_turn(connector, angle))
            }
            (PortPlace::Surface, PortPlace::Surface) => {
                let [a, b] = [port.body, other.body].map(|body| &self.kind.bodies[body].shape_pose);
                let centre = (turn * Point::from(b.translation.vector)).coords;
                (centre - a.translation.vector).norm() <= self.tolerance && self.keeps_grid(&turn.rotation)
            }
            _ => false,
        }
    }

    /// Whether a turn carries paths over a ball in the steps of its ports to such paths.
    fn keeps_grid(&self, turn: &Rotation) -> bool {
        match self.directions {
            Directions::Axes => is_quartered(turn),
            Directions::Steps(steps) => {
                let (z, x) = (turn * Vec3::z(), turn * Vec3::x());
                let upright = (z.z.abs() - 1.0).abs() <= MEETING;
                let angle = x.y.atan2(x.x).to_degrees();
                upright && steps.iter().all(|&step| is_multiple(angle, step))
            }
        }
    }

    /// Whether a connector's limits are the same after a turn by this angle in rad about its z axis.
    fn allows_turn(&self, connector: usize, angle: f64) -> bool {
        let half = is_multiple(angle.to_degrees(), 180.0);
        match &self.catalogue.connectors[connector].model {
            Model::Cone { friction, radius } => half || (friction[0] == friction[1] && radius[0] == radius[1]),
            Model::Box { shear, bending, .. } => {
                let is_square = shear[0] == shear[1] && bending[0] == bending[1];
                half || (is_square && is_multiple(angle.to_degrees(), 90.0))
            }
            Model::Patch { points, .. } => {
                let (sin, cos) = angle.sin_cos();
                let turned = |p: &[f64; 2]| [cos * p[0] - sin * p[1], sin * p[0] + cos * p[1]];
                let near = |p: &[f64; 2], q: &[f64; 2]| (p[0] - q[0]).hypot(p[1] - q[1]) <= self.tolerance;
                points.iter().all(|p| points.iter().any(|q| near(&turned(p), q)))
            }
        }
    }

    fn is_same(&self, a: &Pose, b: &Pose) -> bool {
        let between = a.inverse() * b;
        between.translation.vector.norm() <= self.tolerance && between.rotation.angle() <= MEETING
    }
}

/// Whether two joints are the same but for where they are and what their positions are counted from.
fn alike(a: &JointType, b: &JointType) -> bool {
    a.step_degrees == b.step_degrees && a.torque == b.torque
}

/// The offsets with which `sign * position + offset` carries the range of one joint onto that of another.
fn offsets(a: &JointType, b: &JointType, sign: i32) -> Vec<i32> {
    match (a.range, b.range) {
        (Some([low, high]), Some([low_to, high_to])) => {
            let offset = if sign > 0 { low_to - low } else { low_to + high };
            let end = if sign > 0 { high + offset } else { offset - low };
            if end == high_to { vec![offset] } else { Vec::new() }
        }
        (None, None) => {
            let turn = (360.0 / a.step_degrees).round() as i32;
            if a.canonical(turn) == 0 { (0..turn).collect() } else { vec![0] }
        }
        _ => Vec::new(),
    }
}

/// Whether a rotation carries axes to axes: one of the 24 of a cube.
pub(super) fn is_quartered(rotation: &Rotation) -> bool {
    let entries = rotation.to_rotation_matrix().into_inner().abs();
    entries.iter().all(|entry| entry.min(1.0 - entry) <= MEETING)
}

/// Whether one angle in degrees is a whole number of another.
pub(super) fn is_multiple(angle: f64, of: f64) -> bool {
    let count = angle / of;
    (count - count.round()).abs() * of <= MEETING.to_degrees()
}
