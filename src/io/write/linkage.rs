//! A linkage or a goal for one to `configuration/1`.

use super::super::assembled::port_name;
use super::super::wire::{self, Real};
use super::catalogue::referred;
use super::configuration::{environment, matching, module_load, require};
use super::{vector, xyzw};
use crate::robot::linkage::{Goal, Linkage, Module};
use crate::spatial::Rotation;

/// A linkage that stands on its own.
pub(super) fn start(linkage: &Linkage) -> wire::Configuration {
    let loads = linkage.loads.iter().map(|load| module_load(&linkage.modules[load.module].id, load));
    wire::Configuration {
        catalogue: Some(referred(&linkage.catalogue)),
        gravity_m_s2: Some(vector(linkage.gravity)),
        environment: Some(environment(&linkage.environment)),
        loads: Some(loads.collect()),
        require: Some(require(&linkage.require, |module| linkage.modules[module].id.as_str())),
        ..robot(linkage)
    }
}

/// A goal, which takes everything else from its start.
pub(super) fn goal(goal: &Goal) -> wire::Configuration {
    wire::Configuration { matching: Some(matching(goal.matching)), ..robot(&goal.linkage) }
}

fn robot(linkage: &Linkage) -> wire::Configuration {
    let pairs = linkage
        .connections
        .iter()
        .map(|connection| wire::PairConnection::Pair(connection.ports.map(|port| port_name(linkage, port))));
    wire::Configuration {
        format: wire::ConfigurationFormat::V1,
        catalogue: None,
        gravity_m_s2: None,
        environment: None,
        modules: linkage.modules.iter().map(|m| module(linkage, m)).collect(),
        connections: wire::Connections::List(pairs.collect()),
        loads: None,
        require: None,
        matching: None,
    }
}

/// A module with its pose in full, also where a cell would say it: that reads back bit for bit.
fn module(linkage: &Linkage, module: &Module) -> wire::Module {
    let kind = &linkage.catalogue.module_types[module.module_type];
    let joints = kind.joints.iter().zip(&module.joints);
    let degrees = joints.map(|(joint, &position)| (joint.name.clone(), Real(f64::from(position) * joint.step_degrees)));
    let rotation = module.pose.rotation;
    wire::Module {
        id: module.id.clone(),
        module_type: kind.name.clone(),
        cell: None,
        position_m: Some(vector(module.pose.translation.vector)),
        rotation_xyzw: (rotation != Rotation::identity()).then(|| xyzw(&rotation)),
        joints_deg: (!kind.joints.is_empty()).then(|| degrees.collect()),
        fixed: module.fixed,
    }
}
