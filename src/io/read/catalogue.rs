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
use super::names::Names;
use super::rotation::vector;
use crate::robot::{BUILT_IN, BodyType, Catalogue, LatticeType, ModuleType, Shape};
use crate::spatial::{Pose, Vec3};

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
    let reader = Reader { connectors: Names::new("connectors", names, |_| place.clone(), findings) };
    let module_types: Vec<_> = wire
        .module_types
        .iter()
        .enumerate()
        .map(|(index, (name, wire))| reader.module_type(name, wire, &types.entry(index), findings))
        .collect();
    let complete = module_types.iter().all(Option::is_some);
    let catalogue = Catalogue {
        name: wire.name.clone().unwrap_or_else(|| source.to_string()),
        connectors: connectors(&wire.connectors),
        module_types: module_types.into_iter().flatten().collect(),
    };
    if !complete {
        return None;
    }
    let problems = catalogue.problems();
    faults::of_catalogue(&problems, place, findings);
    problems.is_empty().then_some(catalogue)
}

struct Reader<'a> {
    connectors: Names<'a>,
}

impl Reader<'_> {
    fn module_type(
        &self,
        name: &str,
        wire: &wire::ModuleType,
        place: &Place<'_>,
        findings: &mut Findings,
    ) -> Option<ModuleType> {
        if matches!(wire.ports, wire::Ports::List(_)) {
            let message = "only lattice modules are planned with in this version".to_string();
            findings.add(
                &place.key("ports"),
                codes::UNSUPPORTED,
                message,
                "write \"ports\": \"faces\", with `pitch_m` and `connector`".to_string(),
            );
            return None;
        }
        let body = body(wire, place, findings);
        let lattice = self.lattice(wire, place, findings);
        Some(ModuleType::of_lattice(name, body?, lattice?))
    }

    fn lattice(&self, wire: &wire::ModuleType, place: &Place<'_>, findings: &mut Findings) -> Option<LatticeType> {
        let motion = |wanted: wire::Motion| wire.motions.contains(&wanted);
        let (slide, pivot) = (motion(wire::Motion::Slide), motion(wire::Motion::Pivot));
        for (index, other) in wire.motions.iter().enumerate() {
            if matches!(other, wire::Motion::Roll | wire::Motion::Rotate) {
                let hint = "a lattice module can \"slide\" and \"pivot\"".to_string();
                let message = "not a motion of lattice modules";
                findings.add(&place.key("motions").index(index), codes::UNSUPPORTED, message, hint);
            }
        }
        if wire.pitch_m.is_none() {
            let hint = "a module with ports \"faces\" needs the edge length of its cell";
            findings.add(&place.key("pitch_m"), codes::MISSING_KEY, "the key is missing", hint.to_string());
        }
        if wire.connector.is_none() {
            let hint = "a module with ports \"faces\" needs the connector of its faces";
            findings.add(&place.key("connector"), codes::MISSING_KEY, "the key is missing", hint.to_string());
        }
        if pivot && wire.hinge.is_none() {
            let hint = "a module that can pivot needs the connector that holds it at the edge meanwhile";
            findings.add(&place.key("hinge"), codes::MISSING_KEY, "the key is missing", hint.to_string());
        }
        if !wire.joints.is_empty() {
            let message = "joints are not planned with in this version";
            findings.add(&place.key("joints"), codes::UNSUPPORTED, message, "leave the joints out".to_string());
        }
        let mut find = |key: &str, name: &str| self.connectors.find(name, &place.key(key), findings);
        let face = wire.connector.as_ref().and_then(|name| find("connector", name));
        let hinge = wire.hinge.as_ref().map(|name| find("hinge", name));
        if hinge == Some(None) {
            return None; // it names a connector that is not there
        }
        Some(LatticeType { pitch: wire.pitch_m?.0, face: face?, hinge: hinge.flatten(), slide, pivot })
    }
}

fn body(wire: &wire::ModuleType, place: &Place<'_>, findings: &mut Findings) -> Option<BodyType> {
    let place = place.key("bodies");
    let [body] = wire.bodies.as_slice() else {
        let message = format!("a lattice module has one body, found {}", wire.bodies.len());
        findings.add(&place, codes::UNSUPPORTED, message, "join the bodies to one".to_string());
        return None;
    };
    let shape = shape(&body.shape, &place.index(0).key("shape"), findings)?;
    let com = body.com_m.map_or_else(Vec3::zeros, vector);
    Some(BodyType { name: body.name.clone(), mass: body.mass_kg.0, com, shape, shape_pose: Pose::identity() })
}

/// The shape, if this version knows how to collide it.
pub(super) fn shape(wire: &wire::Shape, place: &Place<'_>, findings: &mut Findings) -> Option<Shape> {
    match wire {
        wire::Shape::Cuboid { half_extents_m } => {
            Some(Shape::Cuboid { half_extents: Vec3::from(half_extents_m.map(|half| half.0)) })
        }
        wire::Shape::Cylinder { .. } | wire::Shape::Ball { .. } => {
            let hint = "use a \"cuboid\"".to_string();
            findings.add(place, codes::UNSUPPORTED, "only cuboids are planned with in this version", hint);
            None
        }
    }
}
