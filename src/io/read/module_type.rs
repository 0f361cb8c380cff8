//! Module types outside lattices: several bodies, joints, ports at points and on surfaces.

use nalgebra::Translation3;

use super::super::findings::{Findings, Place};
use super::super::{codes, wire};
use super::angle::{MICRO, steps};
use super::catalogue::shape;
use super::motion::OUTSIDE_LATTICES;
use super::names::Names;
use super::rotation::{direction, frame_along, rotation, vector};
use crate::robot::{BUILT_IN_MOTIONS, BodyType, JointType, ModuleType, PortPlace, PortType};
use crate::spatial::{Pose, Rotation, Vec3};

/// Step in degrees in which ports roll where a file says nothing.
const ROLL_STEP: f64 = 90.0;

/// Angles at which a port engages where a file says nothing.
const ORIENTATIONS: u32 = 4;

/// The module type at `place` with these ports; names of connectors are those of `connectors`.
pub(super) fn module_type(
    name: &str,
    wire: &wire::ModuleType,
    ports: &[wire::PortType],
    connectors: &Names<'_>,
    place: &Place<'_>,
    findings: &mut Findings,
) -> Option<ModuleType> {
    not_of_lattices(wire, place, findings);
    let bodies_at = place.key("bodies");
    let names = wire.bodies.iter().map(|body| body.name.as_str()).collect();
    let names = Names::new("bodies", names, |index| bodies_at.index(index).key("name"), findings);
    let bodies: Vec<_> =
        wire.bodies.iter().enumerate().map(|(i, wire)| body(wire, &bodies_at.index(i), findings)).collect();
    let joints_at = place.key("joints");
    let joint_names = wire.joints.iter().map(|joint| joint.name.as_str()).collect();
    Names::new("joints", joint_names, |index| joints_at.index(index).key("name"), findings);
    let joints: Vec<_> =
        wire.joints.iter().enumerate().map(|(i, wire)| joint(wire, &names, &joints_at.index(i), findings)).collect();
    let ports_at = place.key("ports");
    let port_names = ports.iter().map(|port| port.name.as_str()).collect();
    Names::new("ports", port_names, |index| ports_at.index(index).key("name"), findings);
    let ports: Vec<_> = ports
        .iter()
        .enumerate()
        .map(|(i, wire)| port(wire, &names, connectors, &ports_at.index(i), findings))
        .collect();
    let (rotates, roll_step_degrees) = motions(wire, place, findings);
    Some(ModuleType {
        name: name.into(),
        bodies: bodies.into_iter().collect::<Option<_>>()?,
        joints: joints.into_iter().collect::<Option<_>>()?,
        ports: ports.into_iter().collect::<Option<_>>()?,
        rotates,
        roll_step_degrees,
        lattice: None,
    })
}

/// Adds that a key has no place here.
pub(super) fn refuse(place: &Place<'_>, message: &str, hint: &str, findings: &mut Findings) {
    findings.add(place, codes::UNSUPPORTED, message, hint.to_string());
}

fn not_of_lattices(wire: &wire::ModuleType, place: &Place<'_>, findings: &mut Findings) {
    let keys =
        [("pitch_m", wire.pitch_m.is_some()), ("connector", wire.connector.is_some()), ("hinge", wire.hinge.is_some())];
    for (key, present) in keys {
        if present {
            let hint = "leave it out, or write \"ports\": \"faces\"; a listed port names its own connector";
            refuse(&place.key(key), "is a key of lattice modules", hint, findings);
        }
    }
}

/// Whether its joints move, and the step in which its ports roll.
fn motions(wire: &wire::ModuleType, place: &Place<'_>, findings: &mut Findings) -> (bool, Option<f64>) {
    let known = Names::new("motions", OUTSIDE_LATTICES.into(), |_| place.clone(), findings);
    let can = |wanted: &str| wire.motions.iter().any(|motion| motion == wanted);
    for (index, found) in wire.motions.iter().enumerate() {
        let place = place.key("motions").index(index);
        match found.as_str() {
            "rotate" if wire.joints.is_empty() => {
                let hint = "list its joints, or leave the motion out";
                refuse(&place, "a module without joints has nothing to rotate", hint, findings);
            }
            "rotate" | "roll" => {}
            name if BUILT_IN_MOTIONS.contains(&name) => {
                let hint = "a module with listed ports can \"roll\" and \"rotate\"";
                refuse(&place, "is a motion of lattice modules", hint, findings);
            }
            name => {
                known.find(name, &place, findings);
            }
        }
    }
    let step_at = place.key("roll_step_deg");
    if let Some(step) = wire.roll_step_deg {
        if !can("roll") {
            refuse(
                &step_at,
                "the module does not roll",
                "add \"roll\" to its motions, or leave the step out",
                findings,
            );
        }
        let micro = step.0 * MICRO;
        let whole = (1.0..=180.0 * MICRO).contains(&micro) && (micro - micro.round()).abs() <= 1e-6 * micro;
        if !(whole && (180.0 * MICRO) % micro.round() == 0.0) {
            let message = format!("does not divide half a turn, found {}", step.0);
            let hint = "from pole to pole there are whole steps, e.g. of 90, 60, 45, 30, 22.5 or 15".to_string();
            findings.add(&step_at, codes::OUT_OF_RANGE, message, hint);
        }
    }
    let step = can("roll").then(|| wire.roll_step_deg.map_or(ROLL_STEP, |step| step.0));
    (can("rotate"), step)
}

/// The body at `place`.
pub(super) fn body(wire: &wire::BodyType, place: &Place<'_>, findings: &mut Findings) -> Option<BodyType> {
    let shape = shape(&wire.shape, &place.key("shape"), findings);
    let position = wire.shape_position_m.map_or_else(Vec3::zeros, vector);
    let rotation = match wire.shape_rotation_xyzw {
        Some(xyzw) => rotation(xyzw, &place.key("shape_rotation_xyzw"), findings),
        None => Rotation::identity(),
    };
    Some(BodyType {
        name: wire.name.clone(),
        mass: wire.mass_kg.0,
        com: wire.com_m.map_or(position, vector),
        shape: shape?,
        shape_pose: Pose::from_parts(Translation3::from(position), rotation),
    })
}

fn joint(wire: &wire::Joint, bodies: &Names<'_>, place: &Place<'_>, findings: &mut Findings) -> Option<JointType> {
    let parent = bodies.find(&wire.parent, &place.key("parent"), findings);
    let child = bodies.find(&wire.child, &place.key("child"), findings);
    if parent.is_some() && parent == child {
        let message = format!("joins `{}` to itself", wire.child);
        let hint = "parent and child are two bodies of the module".to_string();
        findings.add(&place.key("child"), codes::SELF_CONNECTION, message, hint);
    }
    let axis = direction(wire.axis, &place.key("axis"), findings);
    let step = wire.step_deg.0;
    let range = match wire.range_deg.0 {
        None => None,
        Some(ends) => Some(range(ends.map(|end| end.0), step, &place.key("range_deg"), findings)?),
    };
    Some(JointType {
        name: wire.name.clone(),
        parent: parent?,
        child: child?,
        axis: axis?,
        origin: vector(wire.origin_m),
        range,
        step_degrees: step,
        torque: wire.torque_nm.0,
    })
}

/// The ends of a joint's range in steps.
fn range(ends: [f64; 2], step: f64, place: &Place<'_>, findings: &mut Findings) -> Option<[i32; 2]> {
    let whole = [0, 1].map(|end| {
        let found = steps(ends[end], step);
        if found.is_none() {
            let message = format!("{} degrees are no whole number of steps of {step}", ends[end]);
            let hint = "a joint stops at whole steps from 0: choose the step, or the end, so that one fits".to_string();
            findings.add(&place.index(end), codes::OUT_OF_RANGE, message, hint);
        }
        found
    });
    let [low, high] = [whole[0]?, whole[1]?];
    if low > high {
        let message = format!("the smallest position, {}, is above the largest, {}", ends[0], ends[1]);
        findings.add(place, codes::OUT_OF_RANGE, message, "the smaller one comes first".to_string());
        return None;
    }
    Some([low, high])
}

fn port(
    wire: &wire::PortType,
    bodies: &Names<'_>,
    connectors: &Names<'_>,
    place: &Place<'_>,
    findings: &mut Findings,
) -> Option<PortType> {
    if wire.name.contains(':') {
        let hint = "files write ports as `module:port`".to_string();
        findings.add(&place.key("name"), codes::BAD_ID, "the name of a port has no colon", hint);
    }
    let body = bodies.find(&wire.body, &place.key("body"), findings);
    let connector = wire.connector.as_ref().map(|name| connectors.find(name, &place.key("connector"), findings));
    let found = if wire.surface { on_surface(wire, place, findings) } else { at_point(wire, place, findings) };
    if connector == Some(None) {
        return None; // it names a connector that is not there
    }
    Some(PortType { name: wire.name.clone(), body: body?, place: found?, connector: connector.flatten() })
}

fn on_surface(wire: &wire::PortType, place: &Place<'_>, findings: &mut Findings) -> Option<PortPlace> {
    let keys = [
        ("position_m", wire.position_m.is_some()),
        ("axis", wire.axis.is_some()),
        ("x_axis", wire.x_axis.is_some()),
        ("rotation_xyzw", wire.rotation_xyzw.is_some()),
        ("orientations", wire.orientations.is_some()),
        ("connector", wire.connector.is_some()),
    ];
    for (key, present) in keys {
        if present {
            let hint = "it is the whole surface of its body, and connectors of others hold on to it: leave it out";
            refuse(&place.key(key), "is a key of ports at a point", hint, findings);
        }
    }
    Some(PortPlace::Surface)
}

fn at_point(wire: &wire::PortType, place: &Place<'_>, findings: &mut Findings) -> Option<PortPlace> {
    let mut missing = |key: &str, hint: &str| {
        findings.add(&place.key(key), codes::MISSING_KEY, "the key is missing", hint.to_string());
    };
    if wire.position_m.is_none() {
        missing("position_m", "a port is at a point, or \"surface\": true says that it is the whole surface");
    }
    if wire.axis.is_none() && wire.rotation_xyzw.is_none() {
        missing("axis", "a port at a point looks outwards along its axis");
    }
    if wire.rotation_xyzw.is_some() {
        for (key, present) in [("axis", wire.axis.is_some()), ("x_axis", wire.x_axis.is_some())] {
            if present {
                let hint = "give either the axes or the rotation";
                refuse(&place.key(key), "is said by `rotation_xyzw` already", hint, findings);
            }
        }
    }
    let turned = match (wire.rotation_xyzw, wire.axis) {
        (Some(xyzw), _) => Some(rotation(xyzw, &place.key("rotation_xyzw"), findings)),
        (None, Some(axis)) => frame_along(axis, wire.x_axis, place, findings),
        (None, None) => None,
    };
    let position = vector(wire.position_m?);
    let frame = Pose::from_parts(Translation3::from(position), turned?);
    Some(PortPlace::Point { frame, orientations: wire.orientations.unwrap_or(ORIENTATIONS) })
}
