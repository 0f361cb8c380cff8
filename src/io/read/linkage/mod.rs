//! A robot some of whose modules are outside lattices.

mod connections;
mod module;
mod placing;

use super::super::codes;
use super::super::findings::{Findings, Place};
use super::super::wire;
use super::configuration::{Draft, Surroundings};
use super::faults;
use super::names::Names;
use crate::geometry::linkage_problems;
use crate::robot::linkage::Linkage;
use crate::robot::{Fault, Problem};

pub(super) use connections::{angles, port};

/// The robot of a draft, whatever its modules.
pub(super) fn build(draft: Draft<'_>, findings: &mut Findings) -> Option<Linkage> {
    let Draft { wire, names, catalogue, surroundings, place } = draft;
    let types = catalogue.module_types.iter().map(|module_type| module_type.name.as_str()).collect();
    let types = Names::new("module types", types, |_| place.clone(), findings);
    let modules_at = place.key("modules");
    let before = findings.count();
    let modules: Vec<_> = wire
        .modules
        .iter()
        .enumerate()
        .map(|(index, wire)| module::module(wire, &types, &catalogue, &modules_at.index(index), findings))
        .collect();
    let listed = match &wire.connections {
        wire::Connections::Touching(_) => None,
        wire::Connections::List(list) => {
            let kinds: Vec<_> = wire.modules.iter().map(|module| catalogue.find(&module.module_type)).collect();
            let reader = connections::Reader { modules: names, kinds: &kinds, catalogue: &catalogue };
            Some(reader.listed(list, &place.key("connections"), findings))
        }
    };
    if findings.count() > before {
        return None; // where nothing is sure, nothing more can be said
    }
    let (modules, mut placed): (Vec<_>, Vec<_>) = modules.into_iter().flatten().unzip();
    let Surroundings { gravity, environment, loads, require } = surroundings;
    let mut linkage = Linkage { catalogue, gravity, environment, modules, connections: Vec::new(), loads, require };
    let listed = listed.as_deref();
    placing::place(&mut linkage, listed.unwrap_or_default(), &mut placed);
    unplaced(&linkage, &placed, listed, &modules_at, findings);
    if findings.count() > before {
        return None;
    }
    linkage.connections = match listed {
        Some(listed) => listed.iter().map(|listed| listed.connection).collect(),
        None => linkage.touching(),
    };
    check(&linkage, listed.unwrap_or_default(), place, findings);
    linkage.connections.sort_unstable();
    Some(linkage)
}

/// Reports the modules that neither have a place nor get one.
fn unplaced(
    linkage: &Linkage,
    placed: &[bool],
    listed: Option<&[connections::Listed]>,
    place: &Place<'_>,
    findings: &mut Findings,
) {
    for (module, _) in placed.iter().enumerate().filter(|(_, placed)| !**placed) {
        let undirected = |listed: &connections::Listed| {
            let modules = listed.connection.modules();
            listed.code().is_none() && modules.contains(&module) && modules.iter().any(|&other| placed[other])
        };
        let hint = match listed {
            None => "give its `position_m`, or list the connections that place it".to_string(),
            Some(listed) => match listed.iter().position(undirected) {
                Some(index) => format!("give its `position_m`, or the `direction` of connections[{index}]"),
                None => "give its `position_m`, or connect it to a module that has a place".to_string(),
            },
        };
        let message = match linkage.module_type(module).lattice {
            Some(_) => "has neither a cell nor a position, and no connection places it",
            None => "has no position, and no connection places it",
        };
        findings.add(&place.index(module), codes::MISSING_KEY, message, hint);
    }
}

/// What the core finds wrong, less what follows from something said already.
fn check(linkage: &Linkage, listed: &[connections::Listed], place: &Place<'_>, findings: &mut Findings) {
    let ids: Vec<_> = linkage.modules.iter().map(|module| module.id.as_str()).collect();
    let report = |problems: &[Problem], findings: &mut Findings| faults::of_robot(problems, &ids, place, findings);
    let mut problems = linkage.problems();
    let apart = problems
        .iter()
        .any(|problem| matches!(problem.fault, Fault::PortsApart | Fault::SelfConnection | Fault::PortsDoNotFit));
    if apart {
        problems.retain(|problem| problem.fault != Fault::Disconnected);
    }
    report(&problems, findings);
    for (index, listed) in listed.iter().enumerate() {
        listed.compare(linkage, &place.key("connections").index(index), findings);
    }
    report(&linkage_problems(linkage), findings);
}
