//! What a module is made of: bodies, joints and ports.

use nalgebra::Unit;

use crate::spatial::{Pose, Rotation, Vec3};

use super::lattice::Face;
use super::shape::Shape;

/// Relative difference of angles that are meant to be equal: decimal input.
const SAME_ANGLE: f64 = 1e-9;

/// One rigid body of a module type. Its frame is the module's frame while all
/// joints are at zero.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyType {
    /// Name within the module type.
    pub name: String,
    /// Mass in kg.
    pub mass: f64,
    /// Centre of mass in the body frame, in m.
    pub com: Vec3,
    /// Its solid.
    pub shape: Shape,
    /// Pose of the solid's own frame in the body frame.
    pub shape_pose: Pose,
}

/// A revolute joint between two bodies of a module type.
#[derive(Clone, Debug, PartialEq)]
pub struct JointType {
    /// Name within the module type.
    pub name: String,
    /// The body that it is fixed to: index into [`ModuleType::bodies`].
    pub parent: usize,
    /// The body that it turns: index into [`ModuleType::bodies`].
    pub child: usize,
    /// Direction of its axis in the parent's frame; positive positions turn the
    /// child right-handed about it.
    pub axis: Unit<Vec3>,
    /// A point of its axis in the parent's frame, in m.
    pub origin: Vec3,
    /// Smallest and largest position in steps; `None` where it turns without end.
    pub range: Option<[i32; 2]>,
    /// Step between positions in degrees.
    pub step_degrees: f64,
    /// Holding torque in N m.
    pub torque: f64,
}

impl JointType {
    /// How far the child is turned at a position.
    pub fn rotation(&self, position: i32) -> Rotation {
        Rotation::from_axis_angle(&self.axis, (f64::from(position) * self.step_degrees).to_radians())
    }

    /// Pose of the child's frame in the parent's at a position.
    pub fn pose(&self, position: i32) -> Pose {
        Pose::rotation_wrt_point(self.rotation(position), self.origin.into())
    }

    /// The position that stands for this one and for those whole turns away: itself
    /// unless the joint turns without end and a turn is a whole number of steps, and
    /// then from 0 to one below that number.
    pub fn canonical(&self, position: i32) -> i32 {
        let turn = (360.0 / self.step_degrees).round();
        let is_whole = (turn * self.step_degrees - 360.0).abs() <= 360.0 * SAME_ANGLE;
        if self.range.is_none() && is_whole { position.rem_euclid(turn as i32) } else { position }
    }

    /// Whether a position is within the range.
    pub fn allows(&self, position: i32) -> bool {
        self.range.is_none_or(|[low, high]| (low..=high).contains(&position))
    }
}

/// Where on a body a connector sits.
#[derive(Clone, Debug, PartialEq)]
pub enum PortPlace {
    /// At one point.
    Point {
        /// Pose of the port's frame in the body frame: z outwards, x the direction that
        /// angles of engagement are counted from.
        frame: Pose,
        /// At how many angles, equally spaced over a turn, it engages with another port at a point; 0 for
        /// one that engages with surfaces only.
        orientations: u32,
    },
    /// Anywhere on the body's surface, which is a ball.
    Surface,
}

/// A place where connectors engage.
#[derive(Clone, Debug, PartialEq)]
pub struct PortType {
    /// Name within the module type.
    pub name: String,
    /// The body that it sits on: index into [`ModuleType::bodies`].
    pub body: usize,
    /// Where on the body.
    pub place: PortPlace,
    /// Its connector: index into [`Catalogue::connectors`](super::Catalogue::connectors); `None` for a port that only
    /// connectors of others hold on to.
    pub connector: Option<usize>,
}

/// What makes a module type a lattice module: cubes that dock face to face.
#[derive(Clone, Debug, PartialEq)]
pub struct LatticeType {
    /// Edge length of a cell in m.
    pub pitch: f64,
    /// Connector on every face: index into [`Catalogue::connectors`](super::Catalogue::connectors). A patch
    /// connector without points takes the corners of the face it sits on.
    pub face: usize,
    /// Connector that holds the module at a shared edge while it turns about it, z
    /// along the edge: index into [`Catalogue::connectors`](super::Catalogue::connectors).
    pub hinge: Option<usize>,
    /// What it is capable of: indices into [`Catalogue::motions`](super::Catalogue::motions).
    pub motions: Vec<usize>,
}

impl PortType {
    /// Whether it is at a point rather than on a surface.
    pub const fn is_point(&self) -> bool {
        matches!(self.place, PortPlace::Point { .. })
    }
}

/// A kind of module: bodies, joints between them, and ports.
#[derive(Clone, Debug, PartialEq)]
pub struct ModuleType {
    /// Name that configurations use.
    pub name: String,
    /// Its rigid bodies, at least one. The first one's frame is the module's frame.
    pub bodies: Vec<BodyType>,
    /// Joints between them, which make them one tree.
    pub joints: Vec<JointType>,
    /// Where it connects; of a lattice module its faces in the order of [`Face::ALL`].
    pub ports: Vec<PortType>,
    /// Whether its joints are motions of a plan rather than held as they are.
    pub rotates: bool,
    /// Step in degrees in which its ports roll over surfaces; `None` when they do not.
    pub roll_step_degrees: Option<f64>,
    /// How it sits in a lattice, docks and moves; `None` for modules outside lattices.
    pub lattice: Option<LatticeType>,
}

impl ModuleType {
    /// A lattice module of one body: its ports are the six faces of its cell.
    pub fn of_lattice(name: impl Into<String>, body: BodyType, lattice: LatticeType) -> Self {
        let port = |face: Face| {
            let frame = Pose::from_parts((face.normal() * (lattice.pitch / 2.0)).into(), face.outward_frame());
            let place = PortPlace::Point { frame, orientations: 4 };
            PortType { name: face.name().into(), body: 0, place, connector: Some(lattice.face) }
        };
        Self {
            name: name.into(),
            bodies: vec![body],
            joints: Vec::new(),
            ports: Face::ALL.map(port).into(),
            rotates: false,
            roll_step_degrees: None,
            lattice: Some(lattice),
        }
    }

    /// The one body of a lattice module, the first of others.
    pub fn body(&self) -> &BodyType {
        &self.bodies[0]
    }

    /// How it sits in a lattice.
    ///
    /// # Panics
    /// For a module outside lattices, which no sound [`Configuration`](super::Configuration) has.
    pub fn cell(&self) -> &LatticeType {
        self.lattice.as_ref().expect("a configuration of a lattice has lattice modules only")
    }

    /// The joint with this name, as an index into [`ModuleType::joints`].
    pub fn joint(&self, name: &str) -> Option<usize> {
        self.joints.iter().position(|joint| joint.name == name)
    }

    /// The port with this name, as an index into [`ModuleType::ports`].
    pub fn port(&self, name: &str) -> Option<usize> {
        self.ports.iter().position(|port| port.name == name)
    }
}
