//! A robot all of whose modules sit in a lattice.

use super::super::findings::{Findings, Place};
use super::super::json::clipped;
use super::super::{codes, wire};
use super::configuration::{Draft, Surroundings, UNKNOWN};
use super::connections::listed;
use super::faults;
use super::names::Names;
use super::rotation::orientation;
use crate::geometry::environment_problems;
use crate::robot::{Catalogue, Configuration, Fault, Module, Orientation, Placement, Problem};

/// The robot of a draft, all of whose modules must be lattice modules.
pub(super) fn build(draft: Draft<'_>, findings: &mut Findings) -> Option<Configuration> {
    let Draft { wire, names, catalogue, surroundings, place } = draft;
    let types = catalogue.module_types.iter().map(|module_type| module_type.name.as_str()).collect();
    let types = Names::new("module types", types, |_| place.clone(), findings);
    let modules: Vec<_> = wire
        .modules
        .iter()
        .enumerate()
        .map(|(index, wire)| module(wire, &types, &catalogue, &place.key("modules").index(index), findings))
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
    let ids: Vec<_> = configuration.modules.iter().map(|module| module.id.as_str()).collect();
    let report = |problems: &[Problem], findings: &mut Findings| faults::of_robot(problems, &ids, place, findings);
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
    report(&problems, findings);
    if typed {
        report(&environment_problems(configuration), findings);
    }
}

fn module(
    wire: &wire::Module,
    types: &Names<'_>,
    catalogue: &Catalogue,
    place: &Place<'_>,
    findings: &mut Findings,
) -> Option<Module> {
    let module_type = types.find(&wire.module_type, &place.key("type"), findings).unwrap_or(UNKNOWN);
    if catalogue.module_types.get(module_type).is_some_and(|found| found.lattice.is_none()) {
        let message = format!("`{}` is no lattice module", clipped(&wire.module_type));
        let hint = "here all modules must be, as in the start of a goal that has no others".to_string();
        findings.add(&place.key("type"), codes::UNSUPPORTED, message, hint);
        return None;
    }
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
