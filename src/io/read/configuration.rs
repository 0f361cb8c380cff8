//! `configuration/1` to a configuration.

use std::sync::Arc;

use super::super::codes;
use super::super::document::Resolve;
use super::super::findings::{Findings, Place};
use super::super::wire;
use super::connections::listed;
use super::decode::decode;
use super::names::Names;
use super::rotation::{orientation, vector};
use super::{catalogue, environment, faults};
use crate::geometry::environment_problems;
use crate::robot::{Catalogue, Configuration, Environment, Module, ModuleLoad, Orientation, Placement, Requirement};
use crate::spatial::Vec3;

/// Stands for a module type that was not found, so that lists keep their order.
const UNKNOWN: usize = usize::MAX;

/// What surrounds a robot and what is asked of it, which a goal takes from its start.
#[derive(Clone, Debug)]
pub(super) struct Surroundings {
    pub(super) gravity: Vec3,
    pub(super) environment: Environment,
    pub(super) loads: Vec<ModuleLoad>,
    pub(super) require: Requirement,
}

/// Reads a configuration that stands on its own: a start.
pub(super) fn read_start(place: &Place<'_>, resolve: Resolve<'_>, findings: &mut Findings) -> Option<Configuration> {
    let wire: wire::Configuration = decode("configuration", place, findings)?;
    for (key, absent) in [("catalogue", wire.catalogue.is_none()), ("gravity_m_s2", wire.gravity_m_s2.is_none())] {
        if absent {
            let hint = "only a goal may leave it out, where its start's holds";
            findings.add(&place.key(key), codes::MISSING_KEY, "the key is missing", hint.to_string());
        }
    }
    let catalogue =
        wire.catalogue.as_ref().and_then(|c| catalogue::referred(c, &place.key("catalogue"), resolve, findings));
    let environment = environment::environment(wire.environment.as_ref(), &place.key("environment"), resolve, findings);
    let modules = module_names(&wire, place, findings);
    let loads = wire.loads.as_deref().unwrap_or_default();
    let surroundings = Surroundings {
        gravity: wire.gravity_m_s2.map_or_else(Vec3::zeros, vector),
        environment: environment?,
        loads: environment::loads(loads, &modules, &place.key("loads"), findings),
        require: environment::requirement(wire.require.as_ref()),
    };
    build(&wire, &modules, catalogue?, surroundings, place, findings)
}

/// The modules' ids.
pub(super) fn module_names<'w>(wire: &'w wire::Configuration, place: &Place<'_>, findings: &mut Findings) -> Names<'w> {
    let ids = wire.modules.iter().map(|module| module.id.as_str()).collect();
    Names::new("modules", ids, |index| place.key("modules").index(index).key("id"), findings)
}

/// Modules and connections in given surroundings.
pub(super) fn build(
    wire: &wire::Configuration,
    names: &Names<'_>,
    catalogue: Arc<Catalogue>,
    surroundings: Surroundings,
    place: &Place<'_>,
    findings: &mut Findings,
) -> Option<Configuration> {
    let types = catalogue.module_types.iter().map(|module_type| module_type.name.as_str()).collect();
    let types = Names::new("module types", types, |_| place.clone(), findings);
    let modules: Vec<_> = wire
        .modules
        .iter()
        .enumerate()
        .map(|(index, wire)| module(wire, &types, &place.key("modules").index(index), findings))
        .collect();
    let placed = modules.iter().all(Option::is_some);
    let Surroundings { gravity, environment, loads, require } = surroundings;
    let before = findings.count();
    let connections = match &wire.connections {
        wire::Connections::Touching(_) => Vec::new(),
        wire::Connections::List(list) => listed(list, names, &place.key("connections"), findings),
    };
    let understood = findings.count() == before;
    if !placed {
        return None;
    }
    let modules = modules.into_iter().flatten().collect();
    let catalogue = Arc::clone(&catalogue);
    let mut configuration = Configuration { catalogue, gravity, environment, modules, connections, loads, require };
    let typed = configuration.modules.iter().all(|module| module.module_type != UNKNOWN);
    if typed && matches!(wire.connections, wire::Connections::Touching(_)) {
        configuration.connections = configuration.touching_connections();
    }
    check(&configuration, typed, understood, place, findings);
    configuration.connections.sort_unstable();
    Some(configuration).filter(|_| typed && understood)
}

/// What the core finds wrong, less what follows from something said already.
fn check(configuration: &Configuration, typed: bool, understood: bool, place: &Place<'_>, findings: &mut Findings) {
    use crate::robot::Fault;
    let mut problems = configuration.problems();
    let apart = problems.iter().any(|problem| {
        matches!(
            problem.fault,
            Fault::SameCell { .. } | Fault::FacesApart | Fault::SelfConnection | Fault::ConnectorsDoNotFit
        )
    });
    if apart || !typed || !understood {
        problems.retain(|problem| problem.fault != Fault::Disconnected);
    }
    faults::of_configuration(&problems, configuration, place, findings);
    if typed {
        faults::of_configuration(&environment_problems(configuration), configuration, place, findings);
    }
}

fn module(wire: &wire::Module, types: &Names<'_>, place: &Place<'_>, findings: &mut Findings) -> Option<Module> {
    let module_type = types.find(&wire.module_type, &place.key("type"), findings).unwrap_or(UNKNOWN);
    for (key, present) in [("position_m", wire.position_m.is_some()), ("joints_deg", wire.joints_deg.is_some())] {
        if present {
            let hint = "give its `cell`, and `rotation_xyzw` if it is turned";
            findings.add(
                &place.key(key),
                codes::UNSUPPORTED,
                "a lattice module is placed by its cell",
                hint.to_string(),
            );
        }
    }
    let orientation = match wire.rotation_xyzw {
        Some(xyzw) => orientation(xyzw, &place.key("rotation_xyzw"), findings),
        None => Orientation::IDENTITY,
    };
    let Some(cell) = wire.cell else {
        if wire.position_m.is_none() {
            let hint = "`cell` is 3 whole numbers: cell [x, y, z] fills [x, x+1] x [y, y+1] x [z, z+1] times the pitch";
            findings.add(&place.key("cell"), codes::MISSING_KEY, "the key is missing", hint.to_string());
        }
        return None;
    };
    Some(Module { id: wire.id.clone(), module_type, placement: Placement { cell, orientation }, fixed: wire.fixed })
}
