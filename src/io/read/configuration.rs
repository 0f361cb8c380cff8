//! `configuration/1` to a robot: what all robots have in common.

use std::sync::Arc;

use super::super::document::Resolve;
use super::super::findings::{Findings, Place};
use super::super::{codes, wire};
use super::decode::decode;
use super::names::Names;
use super::rotation::vector;
use super::{catalogue, environment, lattice, linkage};
use crate::robot::linkage::Linkage;
use crate::robot::{Catalogue, Configuration, Environment, ModuleLoad, Requirement};
use crate::spatial::Vec3;

/// Stands for a module type that was not found, so that lists keep their order.
pub(super) const UNKNOWN: usize = usize::MAX;

/// A robot as a file says it is.
pub(super) enum Robot {
    /// All modules sit in a lattice.
    Lattice(Configuration),
    /// Some modules do not.
    Linkage(Linkage),
}

/// What surrounds a robot and what is asked of it, which a goal takes from its start.
#[derive(Clone, Debug)]
pub(super) struct Surroundings {
    pub(super) gravity: Vec3,
    pub(super) environment: Environment,
    pub(super) loads: Vec<ModuleLoad>,
    pub(super) require: Requirement,
}

/// A file whose modules and connections are still to be read.
pub(super) struct Draft<'a> {
    pub(super) wire: &'a wire::Configuration,
    /// The modules' ids.
    pub(super) names: &'a Names<'a>,
    pub(super) catalogue: Arc<Catalogue>,
    pub(super) surroundings: Surroundings,
    pub(super) place: &'a Place<'a>,
}

impl Draft<'_> {
    /// Whether no module is known to be of a type outside lattices.
    pub(super) fn is_lattice(&self) -> bool {
        let outside = |module: &wire::Module| {
            let found = self.catalogue.find(&module.module_type);
            found.is_some_and(|index| self.catalogue.module_types[index].lattice.is_none())
        };
        !self.wire.modules.iter().any(outside)
    }

    /// The robot that it is.
    pub(super) fn build(self, findings: &mut Findings) -> Option<Robot> {
        match self.is_lattice() {
            true => lattice::build(self, findings).map(Robot::Lattice),
            false => linkage::build(self, findings).map(Robot::Linkage),
        }
    }
}

/// Reads a configuration that stands on its own, a start, and makes of it what `build` does.
pub(super) fn read_start<T>(
    place: &Place<'_>,
    resolve: Resolve<'_>,
    findings: &mut Findings,
    build: impl FnOnce(Draft<'_>, &mut Findings) -> Option<T>,
) -> Option<T> {
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
    let names = module_names(&wire, place, findings);
    let loads = wire.loads.as_deref().unwrap_or_default();
    let surroundings = Surroundings {
        gravity: wire.gravity_m_s2.map_or_else(Vec3::zeros, vector),
        environment: environment?,
        loads: environment::loads(loads, &names, &place.key("loads"), findings),
        require: environment::requirement(wire.require.as_ref(), &names, &place.key("require"), findings),
    };
    build(Draft { wire: &wire, names: &names, catalogue: catalogue?, surroundings, place }, findings)
}

/// The modules' ids.
pub(super) fn module_names<'w>(wire: &'w wire::Configuration, place: &Place<'_>, findings: &mut Findings) -> Names<'w> {
    let ids = wire.modules.iter().map(|module| module.id.as_str()).collect();
    Names::new("modules", ids, |index| place.key("modules").index(index).key("id"), findings)
}
