//! A catalogue to `catalogue/1`.

use indexmap::IndexMap;

use super::super::read::port_rotation;
use super::super::wire::{self, AngleRange, NonNegative, Positive, Real};
use super::connector::connectors;
use super::lattice_plan::axis;
use super::{vector, xyzw};
use crate::robot::{
    BodyType, Catalogue, JointType, ModuleType, Motion, MotionType, PortPlace, PortType, Shape, Stencil, Turn,
};
use crate::spatial::{Rotation, Vec3};

/// By name if it is built in, in full otherwise, so that the file stands on its own.
pub(super) fn referred(catalogue: &Catalogue) -> wire::CatalogueRef {
    if Catalogue::built_in(&catalogue.name).as_ref() == Some(catalogue) {
        return wire::CatalogueRef::Name(catalogue.name.clone());
    }
    wire::CatalogueRef::Inline(Box::new(wire(catalogue)))
}

/// The catalogue in full.
pub(super) fn wire(catalogue: &Catalogue) -> wire::Catalogue {
    let types = catalogue.module_types.iter().map(|t| (t.name.clone(), module_type(catalogue, t)));
    wire::Catalogue {
        format: wire::CatalogueFormat::V1,
        name: Some(catalogue.name.clone()),
        connectors: connectors(&catalogue.connectors),
        motions: motions(&catalogue.motions),
        module_types: types.collect(),
    }
}

fn module_type(catalogue: &Catalogue, module_type: &ModuleType) -> wire::ModuleType {
    let connector = |index: usize| catalogue.connectors[index].name.clone();
    let lattice = module_type.lattice.as_ref();
    let bodies = &module_type.bodies;
    wire::ModuleType {
        pitch_m: lattice.map(|lattice| Positive(lattice.pitch)),
        bodies: bodies.iter().map(body).collect(),
        ports: match lattice {
            Some(_) => wire::Ports::Faces(wire::Faces::Faces),
            None => wire::Ports::List(module_type.ports.iter().map(|p| port(catalogue, bodies, p)).collect()),
        },
        connector: lattice.map(|lattice| connector(lattice.face)),
        hinge: lattice.and_then(|lattice| lattice.hinge).map(connector),
        motions: motions_of(catalogue, module_type),
        joints: module_type.joints.iter().map(|j| joint(bodies, j)).collect(),
        roll_step_deg: module_type.roll_step_degrees.map(Positive),
    }
}

/// The names of what modules of a type are capable of.
fn motions_of(catalogue: &Catalogue, module_type: &ModuleType) -> Vec<String> {
    let of_lattice = module_type.lattice.iter().flat_map(|lattice| &lattice.motions);
    let of_lattice = of_lattice.map(|&motion| catalogue.motions[motion].name.as_str());
    let roll = module_type.roll_step_degrees.map(|_| "roll");
    let rotate = module_type.rotates.then_some("rotate");
    of_lattice.chain(roll).chain(rotate).map(String::from).collect()
}

/// The motions that are not built in.
fn motions(motions: &[MotionType]) -> IndexMap<String, Vec<wire::Stencil>> {
    let own = motions.iter().filter(|motion| MotionType::built_in(&motion.name).is_none());
    own.map(|motion| (motion.name.clone(), motion.stencils.iter().map(stencil).collect())).collect()
}

fn stencil(stencil: &Stencil) -> wire::Stencil {
    let about = match stencil.motion {
        Motion::Translation { .. } => None,
        Motion::Rotation { support, towards, turn } => Some(wire::Edge {
            support: support.step(),
            towards: axis(towards),
            angle_deg: match turn {
                Turn::Quarter => 90,
                Turn::Half => 180,
            },
        }),
    };
    wire::Stencil {
        to: stencil.motion.by(),
        occupied: stencil.occupied.clone(),
        free: stencil.free.clone(),
        about,
        mirrored: stencil.mirrored,
    }
}

fn body(body: &BodyType) -> wire::BodyType {
    let (position, rotation) = (body.shape_pose.translation.vector, body.shape_pose.rotation);
    wire::BodyType {
        name: body.name.clone(),
        mass_kg: NonNegative(body.mass),
        com_m: (body.com != position).then(|| vector(body.com)),
        shape: shape(&body.shape),
        shape_position_m: (position != Vec3::zeros()).then(|| vector(position)),
        shape_rotation_xyzw: (rotation != Rotation::identity()).then(|| xyzw(&rotation)),
    }
}

fn joint(bodies: &[BodyType], joint: &JointType) -> wire::Joint {
    let degrees = |position: i32| Real(f64::from(position) * joint.step_degrees);
    wire::Joint {
        name: joint.name.clone(),
        parent: bodies[joint.parent].name.clone(),
        child: bodies[joint.child].name.clone(),
        axis: vector(joint.axis.into_inner()),
        origin_m: vector(joint.origin),
        range_deg: AngleRange(joint.range.map(|ends| ends.map(degrees))),
        step_deg: Positive(joint.step_degrees),
        torque_nm: Positive(joint.torque),
    }
}

fn port(catalogue: &Catalogue, bodies: &[BodyType], port: &PortType) -> wire::PortType {
    let bare = wire::PortType {
        name: port.name.clone(),
        body: bodies[port.body].name.clone(),
        position_m: None,
        axis: None,
        x_axis: None,
        rotation_xyzw: None,
        orientations: None,
        connector: port.connector.map(|index| catalogue.connectors[index].name.clone()),
        surface: false,
    };
    let PortPlace::Point { frame, orientations } = &port.place else { return wire::PortType { surface: true, ..bare } };
    let [x, z] = [Vec3::x(), Vec3::z()].map(|axis| (frame.rotation * axis).map(tidy));
    let legible = port_rotation(vector(z), vector(x)) == Some(frame.rotation);
    wire::PortType {
        position_m: Some(vector(frame.translation.vector)),
        axis: legible.then(|| vector(z)),
        x_axis: legible.then(|| vector(x)),
        rotation_xyzw: (!legible).then(|| xyzw(&frame.rotation)),
        orientations: Some(*orientations),
        ..bare
    }
}

/// A component that rounding has kept from being a whole number.
fn tidy(component: f64) -> f64 {
    let whole = component.round() + 0.0;
    if (component - whole).abs() <= 4.0 * f64::EPSILON { whole } else { component }
}

fn shape(shape: &Shape) -> wire::Shape {
    match shape {
        Shape::Cuboid { half_extents } => wire::Shape::Cuboid { half_extents_m: positive(half_extents) },
        Shape::Cylinder { radius, height } => {
            wire::Shape::Cylinder { radius_m: Positive(*radius), height_m: Positive(*height) }
        }
        Shape::Ball { radius } => wire::Shape::Ball { radius_m: Positive(*radius) },
        Shape::Convex(hull) => wire::Shape::Convex { points_m: hull.points().iter().copied().map(vector).collect() },
    }
}

pub(super) fn positive(v: &Vec3) -> [Positive; 3] {
    [v.x, v.y, v.z].map(Positive)
}
