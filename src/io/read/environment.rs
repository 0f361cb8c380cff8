//! What surrounds a robot and acts on it.

use nalgebra::Translation3;

use super::super::document::Resolve;
use super::super::findings::{Findings, Place};
use super::super::{codes, wire};
use super::names::Names;
use super::rotation::{rotation, vector};
use super::terrain::terrain;
use crate::robot::{Environment, Ground, ModuleLoad, Obstacle, Region, Requirement};
use crate::spatial::{Pose, Rotation, Vec3};

/// Friction coefficient between modules that touch without being connected,
/// where a file says nothing. An estimate: dry plastic on plastic.
pub(super) const MODULE_FRICTION: f64 = 0.4;

/// The environment at `place`; empty space when there is none.
pub(super) fn environment(
    wire: Option<&wire::Environment>,
    place: &Place<'_>,
    resolve: Resolve<'_>,
    findings: &mut Findings,
) -> Option<Environment> {
    let Some(wire) = wire else {
        return Some(Environment { module_friction: MODULE_FRICTION, ..Environment::default() });
    };
    let obstacles: Vec<_> = wire
        .obstacles
        .iter()
        .enumerate()
        .map(|(index, wire)| obstacle(wire, &place.key("obstacles").index(index), resolve, findings))
        .collect();
    let ground = wire.ground.as_ref().map(|g| Ground { height: g.height_m.0, friction: g.friction.0 });
    let module_friction = wire.module_friction.map_or(MODULE_FRICTION, |friction| friction.0);
    Some(Environment { ground, obstacles: obstacles.into_iter().collect::<Option<_>>()?, module_friction })
}

fn obstacle(
    wire: &wire::Obstacle,
    place: &Place<'_>,
    resolve: Resolve<'_>,
    findings: &mut Findings,
) -> Option<Obstacle> {
    let shape = terrain(&wire.shape, &place.key("shape"), resolve, findings);
    let rotation = match wire.rotation_xyzw {
        Some(xyzw) => rotation(xyzw, &place.key("rotation_xyzw"), findings),
        None => Rotation::identity(),
    };
    let pose = Pose::from_parts(Translation3::from(vector(wire.position_m)), rotation);
    Some(Obstacle { shape: shape?, pose, friction: wire.friction.0 })
}

/// The loads of a list.
pub(super) fn loads(
    list: &[wire::ModuleLoad],
    modules: &Names<'_>,
    place: &Place<'_>,
    findings: &mut Findings,
) -> Vec<ModuleLoad> {
    let read = |(index, wire): (usize, &wire::ModuleLoad)| {
        let module = modules.find(&wire.module, &place.index(index).key("module"), findings)?;
        let torque = wire.torque_nm.map_or_else(Vec3::zeros, vector);
        Some(ModuleLoad { module, force: vector(wire.force_n), torque, at: wire.at_m.map(vector) })
    };
    list.iter().enumerate().filter_map(read).collect()
}

/// What transient states must satisfy, of a robot with these modules.
pub(super) fn requirement(
    wire: Option<&wire::Require>,
    modules: &Names<'_>,
    place: &Place<'_>,
    findings: &mut Findings,
) -> Requirement {
    let standard = Requirement::default();
    let Some(wire) = wire else { return standard };
    let stay = wire.stay.iter().enumerate();
    let stay = stay.filter_map(|(i, id)| modules.find(id, &place.key("stay").index(i), findings)).collect();
    let regions = wire.keep_out.iter().enumerate();
    let keep_out = regions.map(|(i, wire)| region(wire, &place.key("keep_out").index(i), findings)).collect();
    Requirement {
        margin: wire.margin.map_or(standard.margin, |margin| margin.0),
        connected: wire.connected.unwrap_or(standard.connected),
        stay,
        keep_out,
    }
}

fn region(wire: &wire::Region, place: &Place<'_>, findings: &mut Findings) -> Region {
    let region = Region { low: vector(wire.low_m), high: vector(wire.high_m) };
    if !(region.high - region.low).iter().all(|&extent| extent > 0.0) {
        let hint = "every coordinate of `high_m` is above that of `low_m`".to_string();
        findings.add(&place.key("high_m"), codes::OUT_OF_RANGE, "the box is empty", hint);
    }
    region
}
