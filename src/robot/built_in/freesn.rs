//! The built-in catalogue of FreeSN: freeform robots of struts and nodes.
//!
//! Source, where a number is called published: "Quasi-static stability of modular self-reconfigurable
//! robots", whose simulations (section 5) and experiments (section 6) use this robot.

use nalgebra::Vector3;

use crate::robot::catalogue::Catalogue;
use crate::robot::module_type::{BodyType, ModuleType, PortPlace, PortType};
use crate::robot::shape::Shape;
use crate::spatial::{Pose, Rotation, Vec3};
use crate::statics::{Connector, Model};

/// Radius of a node in m. Published: 60 mm.
const NODE_RADIUS: f64 = 0.06;

/// Mass of a node in kg. Published: 361 g.
const NODE_MASS: f64 = 0.361;

/// Height of a strut in m, from one surface that it holds to the other. Published: 87 mm.
const STRUT_HEIGHT: f64 = 0.087;

/// Mass of a strut in kg. Published: 492 g.
const STRUT_MASS: f64 = 0.492;

/// Radius in m of the cylinder that stands for a strut. **Estimate**: two wide enough for tyres, omni
/// wheels and magnets that leave room for six struts around a node at right angles.
const STRUT_RADIUS: f64 = 0.04;

/// Height in m of that cylinder. **Estimate**: a strut that lets go of one node turns about the
/// node at its other end, and its rounded wheels clear the ball that it leaves. The corner of a cylinder of height
/// h passes that ball when hypot(h / 2 + 103.5 mm, 40 mm) <= 147 mm, for h up to 75.9 mm.
const SOLID_HEIGHT: f64 = 0.075;

/// Rated characteristic strength in N of a strut's connection. Published: 109.2 N, the pull of its magnets.
const STRENGTH: f64 = 109.2;

/// Friction coefficients along the connection's x and y. Published is that rubber tyres in x hold more than
/// the omni wheels in y (section 6.1); the numbers are **estimates** for rubber and for small plastic rollers on steel.
const FRICTION: [f64; 2] = [0.8, 0.5];

/// Radii in m by which the strength resists torques about x, y and z. **Estimate**: half the distance between
/// opposite wheels, about 25 mm, for tilting, and less for turning, to which the wheels oppose friction only.
const RADIUS: [f64; 3] = [0.025, 0.025, 0.02];

/// Step in degrees in which a strut rolls over a node. Ours: directions along and across each other.
const ROLL_STEP: f64 = 90.0;

impl Catalogue {
    /// FreeSN, as published but for what its source calls an estimate:
    ///
    /// - `node`: a ball of 60 mm radius and 361 g, the whole surface of which is the port `surface`;
    /// - `strut`: 492 g, 87 mm high, a magnetic connector at either end (ports `bottom`, along -z, and
    ///   `top`, along +z), so that nodes at its two ends are 207 mm apart. It rolls over nodes in steps of 90 degrees.
    ///
    /// The connector `magnet` is a `cone` of 109.2 N: friction 0.8 along x and 0.5 along y, radii 25, 25 and 20 mm. Ports
    /// count angles from the strut's x axis. They hold on to nodes only, not to each other.
    pub fn freesn() -> Self {
        let magnet = Connector {
            name: "magnet".into(),
            strength: STRENGTH,
            model: Model::Cone { friction: FRICTION, radius: RADIUS },
        };
        Self {
            name: "freesn".into(),
            connectors: vec![magnet],
            motions: Vec::new(),
            module_types: vec![node(), strut()],
        }
    }
}

fn node() -> ModuleType {
    let surface = PortType { name: "surface".into(), body: 0, place: PortPlace::Surface, connector: None };
    ModuleType {
        name: "node".into(),
        bodies: vec![body("shell", NODE_MASS, Shape::Ball { radius: NODE_RADIUS })],
        joints: Vec::new(),
        ports: vec![surface],
        rotates: false,
        roll_step_degrees: None,
        lattice: None,
    }
}

fn strut() -> ModuleType {
    let down = Rotation::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI);
    ModuleType {
        name: "strut".into(),
        bodies: vec![body("body", STRUT_MASS, Shape::Cylinder { radius: STRUT_RADIUS, height: SOLID_HEIGHT })],
        joints: Vec::new(),
        ports: vec![end("bottom", -STRUT_HEIGHT / 2.0, down), end("top", STRUT_HEIGHT / 2.0, Rotation::identity())],
        rotates: false,
        roll_step_degrees: Some(ROLL_STEP),
        lattice: None,
    }
}

fn body(name: &str, mass: f64, shape: Shape) -> BodyType {
    BodyType { name: name.into(), mass, com: Vec3::zeros(), shape, shape_pose: Pose::identity() }
}

fn end(name: &str, z: f64, rotation: Rotation) -> PortType {
    let frame = Pose::from_parts(Vec3::new(0.0, 0.0, z).into(), rotation);
    PortType { name: name.into(), body: 0, place: PortPlace::Point { frame, orientations: 0 }, connector: Some(0) }
}
