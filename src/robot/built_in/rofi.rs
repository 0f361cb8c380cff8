//! The built-in catalogue `rofi`: universal modules of the open RoFI platform, and pads.
//!
//! Knows the module, not the files of that project: those are read in `io`. The frames of shoes and
//! docks are theirs (`softwareComponents/configuration` in github.com/paradise-fi/RoFI), carried over to the
//! convention that all bodies of a module share one frame at joint zero: that of shoe A.

use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::Arc;

use nalgebra::Vector3;

use crate::robot::catalogue::Catalogue;
use crate::robot::hull::Hull;
use crate::robot::module_type::{BodyType, JointType, ModuleType, PortPlace, PortType};
use crate::robot::shape::Shape;
use crate::spatial::{Pose, Rotation, Vec3};
use crate::statics::{Connector, Model};

/// Edge length of a cell in m, the distance of the two shoes' axes. Published: in the platform's
/// simulator (`data/gazebo/models/universalModule/model.sdf`) the axes lie 50 mm from the module's
/// middle, and docks 43 mm from the axes plus 7 mm by which a connector extends.
pub const CELL: f64 = 0.1;

/// Distance in m of a retracted dock from its shoe's axis. Published, see [`CELL`].
const DOCK: f64 = 0.043;

/// Radius in m of a dock. Published: the connector has a diameter of 50 mm
/// (ro.fi.muni.cz/hardware/connector; `data/gazebo/models/roficom/model.sdf`). With [`DOCK`] its edge
/// lies 49.7 mm from the middle of the cell: the module stays within the spheres inscribed in its two
/// cells, as the platform's description of the module demands.
const DOCK_RADIUS: f64 = 0.025;

/// Mass of a body in kg and distance of its centre of mass from the shoe's axis, towards the other
/// body, in m. Published (simulator, as [`CELL`]).
const BODY: (f64, f64) = (0.201_058, 0.050 - 0.029_663);

/// Mass of a shoe in kg and distance of its centre of mass from its axis, away from the other shoe, in m,
/// without connectors. Published (simulator, as [`CELL`]).
const SHOE: (f64, f64) = (0.089_474, 0.012_973);

/// Mass of a connector in kg. Published (`roficom/model.sdf`: 10 g for each of its two parts, marked
/// there as still to be checked).
const CONNECTOR: f64 = 0.020;

/// Distance of a connector's centre of mass from the shoe's axis in m: its two parts are centred 8.5 mm
/// and 3.5 mm behind the dock. Published, as [`CONNECTOR`].
const CONNECTOR_CENTRE: f64 = DOCK - 0.006;

/// Holding torque of a joint in N m. Published (simulator: the largest torque of each of the three joints).
const JOINT_TORQUE: f64 = 2.0;

/// Pull in N that a connection holds. Published (ro.fi.muni.cz/hardware/connector: normal load 110 N).
const TENSION: f64 = 110.0;

/// Shear in N that a connection holds. Published (as [`TENSION`]: shear load 50 N).
const SHEAR: f64 = 50.0;

/// Bending moment in N m that a connection holds. **Estimate**: the pull at the lever of the dock's radius.
const BENDING: f64 = TENSION * DOCK_RADIUS;

/// Torsion in N m that a connection holds. **Estimate**: the shear at the dock's radius.
const TORSION: f64 = SHEAR * DOCK_RADIUS;

/// Mass of a pad in kg for each of its docks. **Estimate**; pads are fixed, so that it does not matter.
const PAD_MASS: f64 = 0.1;

/// Step of the joints in degrees in the built-in catalogue.
pub const STEP_DEGREES: u32 = 90;

/// Sizes of the pads in the built-in catalogue, in docks.
const PADS: [[u32; 2]; 4] = [[1, 1], [2, 2], [3, 3], [4, 4]];

/// Names of a shoe's docks, in the order of the project's components.
const DOCKS: [&str; 3] = ["-X", "+X", "-Z"];

impl Catalogue {
    /// RoFI universal modules (`universal`) whose joints turn in steps of 90 degrees, and square pads
    /// (`pad-1x1` to `pad-4x4`).
    ///
    /// Sizes, masses, joint torques and the connectors' pull and shear are published; the moments that
    /// a connection holds, and the outline of the bodies, are estimates. A shoe is the hull of its three docks, a body
    /// that of the same squares on the sides that its shoe leaves free: everything stays within the spheres inscribed in
    /// the module's cells, in all positions of its joints. A connected dock extends by 7 mm to meet its
    /// partner; the part that extends is not modelled as a solid.
    pub fn rofi() -> Self {
        let dock = Connector {
            name: "dock".into(),
            strength: TENSION,
            model: Model::Box {
                shear: [SHEAR; 2],
                tension: TENSION,
                compression: f64::INFINITY,
                bending: [BENDING; 2],
                torsion: TORSION,
            },
        };
        let types = std::iter::once(universal(STEP_DEGREES)).chain(PADS.map(pad));
        Self { name: "rofi".into(), connectors: vec![dock], motions: Vec::new(), module_types: types.collect() }
    }

    /// The catalogue with another step of the joints in degrees, a divisor of 90, and with pads of further sizes (in
    /// docks, neither side 0); the built-in one when it has all that already.
    ///
    /// # Panics
    /// When the step does not divide 90 or a pad has no dock.
    pub fn rofi_with(step_degrees: u32, pads: &[[u32; 2]]) -> Self {
        let mut catalogue = Self::rofi();
        if step_degrees != STEP_DEGREES {
            assert!(step_degrees > 0 && STEP_DEGREES.is_multiple_of(step_degrees), "the step divides 90 degrees");
            catalogue.module_types[0] = universal(step_degrees);
            catalogue.name += &format!(" in steps of {step_degrees} degrees");
        }
        for size in pads {
            if catalogue.find(&pad_name(*size)).is_none() {
                catalogue.name += &format!(" with {}", pad_name(*size));
                catalogue.module_types.push(pad(*size));
            }
        }
        catalogue
    }
}

/// Name of the type of a pad with `width` times `height` docks.
pub fn pad_name([width, height]: [u32; 2]) -> String {
    format!("pad-{width}x{height}")
}

/// Frame of half B of a module in the module's frame at joint zero: the same half, a cell further along z
/// and turned by half a turn about y.
pub fn other_half() -> Pose {
    Pose::from_parts(Vec3::new(0.0, 0.0, CELL).into(), Rotation::from_axis_angle(&Vector3::y_axis(), PI))
}

/// Pose of a dock's port (z outwards) in the frame that RoFI gives the dock: that one sits in the middle
/// of the cell and looks along -x. The port's x is RoFI's z.
pub fn port_in_dock() -> Pose {
    let outwards = Rotation::from_axis_angle(&Vector3::y_axis(), -FRAC_PI_2);
    Pose::from_parts(Vec3::new(-CELL / 2.0, 0.0, 0.0).into(), outwards)
}

/// Frames of a shoe's docks in the shoe's, as RoFI has them, in the order of [`DOCKS`].
fn docks() -> [Rotation; 3] {
    let half_turn_about_z = Rotation::from_axis_angle(&Vector3::z_axis(), PI);
    [
        Rotation::identity(),
        Rotation::from_axis_angle(&Vector3::y_axis(), PI),
        half_turn_about_z * Rotation::from_axis_angle(&Vector3::y_axis(), -FRAC_PI_2),
    ]
}

fn universal(step_degrees: u32) -> ModuleType {
    let halves = [("a", Pose::identity()), ("b", other_half())];
    let shoes = halves.map(|(half, frame)| shoe(half, frame));
    let [body_a, body_b] = halves.map(|(half, frame)| body(half, frame));
    let [shoe_a, shoe_b] = shoes;
    let quarter = (STEP_DEGREES / step_degrees) as i32;
    let joint = |name: &str, parent, child, axis, origin, is_limited: bool| JointType {
        name: name.into(),
        parent,
        child,
        axis,
        origin,
        range: is_limited.then_some([-quarter, quarter]),
        step_degrees: f64::from(step_degrees),
        torque: JOINT_TORQUE,
    };
    let ports =
        ["A", "B"].into_iter().zip([(0, Pose::identity()), (3, other_half())]).flat_map(|(side, (body, half))| {
            DOCKS.into_iter().zip(docks()).map(move |(dock, turn)| PortType {
                name: format!("{side}{dock}"),
                body,
                place: PortPlace::Point { frame: half * turn * port_in_dock(), orientations: 4 },
                connector: Some(0),
            })
        });
    ModuleType {
        name: "universal".into(),
        bodies: vec![shoe_a, body_a, body_b, shoe_b],
        joints: vec![
            joint("alpha", 1, 0, Vector3::x_axis(), Vec3::zeros(), true),
            joint("beta", 2, 3, -Vector3::x_axis(), Vec3::new(0.0, 0.0, CELL), true),
            joint("gamma", 1, 2, Vector3::z_axis(), Vec3::zeros(), false),
        ],
        ports: ports.collect(),
        rotates: true,
        roll_step_degrees: None,
        lattice: None,
    }
}

/// The shoe of a half: the hull of its docks, retracted.
fn shoe(half: &str, frame: Pose) -> BodyType {
    let mass = SHOE.0 + 3.0 * CONNECTOR;
    // The connectors at -X and +X balance each other.
    let behind = (SHOE.0 * SHOE.1 + CONNECTOR * CONNECTOR_CENTRE) / mass;
    BodyType {
        name: format!("shoe-{half}"),
        mass,
        com: (frame * nalgebra::Point3::new(0.0, 0.0, -behind)).coords,
        shape: squares([-Vec3::x(), Vec3::x(), -Vec3::z()]),
        shape_pose: frame,
    }
}

/// The body of a half. Its outline is an **estimate**: what the shoe leaves free.
fn body(half: &str, frame: Pose) -> BodyType {
    BodyType {
        name: format!("body-{half}"),
        mass: BODY.0,
        com: (frame * nalgebra::Point3::new(0.0, 0.0, BODY.1)).coords,
        shape: squares([-Vec3::y(), Vec3::y(), Vec3::z()]),
        shape_pose: frame,
    }
}

/// The hull of squares inscribed in docks that look along these axes.
fn squares(axes: [Vec3; 3]) -> Shape {
    let half_side = DOCK_RADIUS / 2.0_f64.sqrt();
    let corners = axes.into_iter().flat_map(|axis| {
        let (u, v) = (Vec3::new(axis.y, axis.z, axis.x), Vec3::new(axis.z, axis.x, axis.y));
        [[1.0, 1.0], [1.0, -1.0], [-1.0, -1.0], [-1.0, 1.0]].map(|[a, b]| axis * DOCK + (u * a + v * b) * half_side)
    });
    let hull = Hull::new(corners.collect()).expect("three squares do not lie in a plane");
    Shape::Convex(Arc::new(hull))
}

/// A pad: docks in a plane, number i * height + j of them at (0, i, j) cells, all looking along -x.
/// It fills its cells but for what docks are retracted.
fn pad([width, height]: [u32; 2]) -> ModuleType {
    assert!(width > 0 && height > 0, "a pad has docks");
    let extent = Vec3::new(2.0 * DOCK, f64::from(width) * CELL, f64::from(height) * CELL);
    let middle = Vec3::new(0.0, f64::from(width - 1) * CELL / 2.0, f64::from(height - 1) * CELL / 2.0);
    let dock = |index: u32| {
        let cell = Vec3::new(0.0, f64::from(index / height), f64::from(index % height)) * CELL;
        let frame = Pose::from_parts(cell.into(), Rotation::identity()) * port_in_dock();
        let place = PortPlace::Point { frame, orientations: 4 };
        PortType { name: index.to_string(), body: 0, place, connector: Some(0) }
    };
    ModuleType {
        name: pad_name([width, height]),
        bodies: vec![BodyType {
            name: "board".into(),
            mass: PAD_MASS * f64::from(width) * f64::from(height),
            com: middle,
            shape: Shape::Cuboid { half_extents: extent / 2.0 },
            shape_pose: Pose::from_parts(middle.into(), Rotation::identity()),
        }],
        joints: Vec::new(),
        ports: (0..width * height).map(dock).collect(),
        rotates: false,
        roll_step_degrees: None,
        lattice: None,
    }
}
