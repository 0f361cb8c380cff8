//! The built-in catalogue of cubes.

use crate::spatial::{Pose, Vec3};
use crate::statics::{Connector, Model};

use crate::robot::catalogue::Catalogue;
use crate::robot::module_type::{BodyType, LatticeType, ModuleType};
use crate::robot::shape::Shape;
use crate::robot::stencil::MotionType;

/// Edge length in m. Published: M-Blocks are cubes of 50 mm (J. W. Romanishin,
/// K. Gilpin, D. Rus: "M-Blocks: momentum-driven, magnetic modular robots",
/// IROS 2013; the specification sheet at wevolver.com/wevolver.staff/m-blocks
/// states 50 mm x 50 mm x 50 mm).
const PITCH: f64 = 0.05;

/// Mass in kg. Published: 143 g (same sources).
const MASS: f64 = 0.143;

/// Preload of a magnetic face in N. **Estimate**: the face-to-face pull is not
/// in the sources we could read. 25 N makes a horizontal cantilever of four
/// cubes nearly its limit: the moment of n cubes at the root, n^2/2 m g PITCH,
/// against the preload's lever of half an edge gives the utilisation
/// `n^2 m g / S = 0.056 n^2`, 0.90 for four and 1.40 for five.
const MAGNET_STRENGTH: f64 = 25.0;

/// Friction coefficient of a magnetic face. **Estimate**: dry smooth plastic on
/// plastic, 0.3 to 0.5.
const MAGNET_FRICTION: f64 = 0.4;

/// Pull of a latch in N. **Estimate**: with the bending limit below and the
/// pull's lever about the face's edge, a horizontal cantilever of five cubes
/// is nearly its limit: 0.877 N m of 0.94 N m.
const LATCH_STRENGTH: f64 = 30.0;

/// Bending and torsion limit of a latch in N m. **Estimate**, see [`LATCH_STRENGTH`].
const LATCH_TORQUE: f64 = 0.19;

/// Force in N that a hinge carries in any one direction. **Estimate**: four times
/// a cube's weight of 1.4 N.
const HINGE_STRENGTH: f64 = 6.0;

/// Moment in N m across its axis that a hinge carries. **Estimate**: four times
/// that of a cube hanging sideways from its edge, `m g PITCH / sqrt 2 = 0.050 N m`.
const HINGE_BENDING: f64 = 0.2;

/// Quasi-static drive torque in N m about the hinge. **Estimate**: twice the
/// 0.050 N m that hold a cube level beside its edge. (The published 1.6 N m of an
/// M-Block, wevolver.com, is the peak while the flywheel brakes, which is no
/// quasi-static torque.)
const HINGE_DRIVE: f64 = 0.1;

/// As [`HINGE_DRIVE`], for the latched variant. **Estimate**: three times a cube.
const LATCHED_HINGE_DRIVE: f64 = 0.15;

impl Catalogue {
    /// Cubes of the size and mass of M-Blocks (50 mm, 143 g), in two types that
    /// differ in how they hold each other:
    ///
    /// - `cube`: magnetic faces of 25 N with friction 0.4 (a `patch`), and a
    ///   magnetic hinge along every edge;
    /// - `cube-latched`: mechanical latches (a `box` beside the contact of the
    ///   faces) of 30 N and 0.19 N m, and a hinge with half as much drive again.
    ///
    /// The two types do not connect to each other, but pivot on each other.
    /// Size and mass are published; every strength is an estimate, chosen so
    /// that a horizontal cantilever from a held cube is at its limit with four
    /// (magnets) or five (latches) cubes and that a hinge holds and drives one
    /// cube in any pose. Sliding is the idealised motion of the sliding-cube
    /// literature; M-Blocks only pivot.
    pub fn cube() -> Self {
        let magnet = Connector {
            name: "magnet".into(),
            strength: MAGNET_STRENGTH,
            model: Model::Patch { friction: MAGNET_FRICTION, points: Vec::new() },
        };
        let latch = Connector {
            name: "latch".into(),
            strength: LATCH_STRENGTH,
            model: Model::Box {
                shear: [LATCH_STRENGTH; 2],
                tension: LATCH_STRENGTH,
                compression: f64::INFINITY,
                bending: [LATCH_TORQUE; 2],
                torsion: LATCH_TORQUE,
            },
        };
        Self {
            name: "cube".into(),
            connectors: vec![magnet, hinge("hinge", HINGE_DRIVE), latch, hinge("latched-hinge", LATCHED_HINGE_DRIVE)],
            motions: vec![MotionType::slide(), MotionType::pivot()],
            module_types: vec![cube_type("cube", 0, 1), cube_type("cube-latched", 2, 3)],
        }
    }
}

/// A hinge along an edge: z is the edge, torsion is the drive.
fn hinge(name: &str, drive: f64) -> Connector {
    Connector {
        name: name.into(),
        strength: HINGE_STRENGTH,
        model: Model::Box {
            shear: [HINGE_STRENGTH; 2],
            tension: HINGE_STRENGTH,
            compression: HINGE_STRENGTH,
            bending: [HINGE_BENDING; 2],
            torsion: drive,
        },
    }
}

fn cube_type(name: &str, face: usize, hinge: usize) -> ModuleType {
    let half = PITCH / 2.0;
    let body = BodyType {
        name: "body".into(),
        mass: MASS,
        com: Vec3::zeros(),
        shape: Shape::Cuboid { half_extents: Vec3::new(half, half, half) },
        shape_pose: Pose::identity(),
    };
    let lattice = LatticeType { pitch: PITCH, face, hinge: Some(hinge), motions: vec![0, 1] };
    ModuleType::of_lattice(name, body, lattice)
}
