//! `catalogue/1` to a catalogue, and the catalogue that a configuration names.

use std::sync::Arc;

use super::super::codes;
use super::super::document::Resolve;
use super::super::findings::{Findings, Place};
use super::super::json::clipped;
use super::super::{suggest, wire};
use super::connector::connectors;
use super::decode::decode;
use super::faults;
use super::lattice_type::lattice_type;
use super::module_type::module_type;
use super::motion::motions;
use super::names::Names;
use super::terrain;
use crate::robot::{BUILT_IN, BUILT_IN_MOTIONS, Catalogue, Shape};
use crate::spatial::Vec3;

/// Reads a catalogue that is a file of its own.
pub(super) fn read(root: &Place<'_>, findings: &mut Findings) -> Option<Catalogue> {
    let wire = decode("catalogue", root, findings)?;
    convert(&wire, root, root.file(), findings)
}

/// The catalogue that a configuration means, at the place of its reference.
pub(super) fn referred(
    wire: &wire::CatalogueRef,
    place: &Place<'_>,
    resolve: Resolve<'_>,
    findings: &mut Findings,
) -> Option<Arc<Catalogue>> {
    let name = match wire {
        wire::CatalogueRef::Inline(inline) => return convert(inline, place, "inline", findings).map(Arc::new),
        wire::CatalogueRef::Name(name) => name,
    };
    if let Some(built_in) = Catalogue::built_in(name) {
        return Some(Arc::new(built_in));
    }
    if !(name.contains(['/', '\\']) || name.ends_with(".json")) {
        let meant = suggest::closest(name, BUILT_IN).map(|meant| format!("did you mean `{meant}`?"));
        let hint = meant.unwrap_or_else(|| {
            format!(
                "built in: {}; a catalogue of your own is named by its path, e.g. ./catalogue.json",
                suggest::listed(&BUILT_IN)
            )
        });
        findings.add(place, codes::UNKNOWN_NAME, format!("`{}` is not a built-in catalogue", clipped(name)), hint);
        return None;
    }
    match resolve(place.file(), name) {
        Ok(file) => {
            let document = findings.open(&file)?;
            read(&document.root(), findings).map(Arc::new)
        }
        Err(problem) => {
            let hint = "the path is relative to the file that names it".to_string();
            findings.add(place, codes::UNREADABLE, format!("cannot read `{}`: {problem}", clipped(name)), hint);
            None
        }
    }
}

fn convert(wire: &wire::Catalogue, place: &Place<'_>, source: &str, findings: &mut Findings) -> Option<Catalogue> {
    let types = place.key("module_types");
    let names = wire.connectors.keys().map(String::as_str).collect();
    let connector_names = Names::new("connectors", names, |_| place.clone(), findings);
    let motions_at = place.key("motions");
    let motions = motions(wire, &motions_at, findings);
    let own = wire.motions.keys().map(String::as_str).filter(|name| !BUILT_IN_MOTIONS.contains(name));
    let names = BUILT_IN_MOTIONS.into_iter().chain(own).collect();
    let motion_names = Names::new("motions", names, |_| motions_at.clone(), findings);
    let read = |(index, (name, wire)): (usize, (&String, &wire::ModuleType))| {
        let place = types.entry(index);
        match &wire.ports {
            wire::Ports::Faces(_) => lattice_type(name, wire, &connector_names, &motion_names, &place, findings),
            wire::Ports::List(ports) => module_type(name, wire, ports, &connector_names, &place, findings),
        }
    };
    let module_types: Vec<_> = wire.module_types.iter().enumerate().map(read).collect();
    let complete = module_types.iter().all(Option::is_some);
    let catalogue = Catalogue {
        name: wire.name.clone().unwrap_or_else(|| source.to_string()),
        connectors: connectors(&wire.connectors),
        motions: motions?,
        module_types: module_types.into_iter().flatten().collect(),
    };
    if !complete {
        return None;
    }
    let problems = catalogue.problems();
    faults::of_catalogue(&problems, catalogue.motions.len() - wire.motions.len(), place, findings);
    problems.is_empty().then_some(catalogue)
}

/// The shape of a body.
pub(super) fn shape(wire: &wire::Shape, place: &Place<'_>, findings: &mut Findings) -> Option<Shape> {
    match wire {
        wire::Shape::Cuboid { half_extents_m } => {
            Some(Shape::Cuboid { half_extents: Vec3::from(half_extents_m.map(|half| half.0)) })
        }
        wire::Shape::Cylinder { radius_m, height_m } => {
            Some(Shape::Cylinder { radius: radius_m.0, height: height_m.0 })
        }
        wire::Shape::Ball { radius_m } => Some(Shape::Ball { radius: radius_m.0 }),
        wire::Shape::Convex { points_m } => terrain::hull(points_m, &place.key("convex").key("points_m"), findings),
    }
}
