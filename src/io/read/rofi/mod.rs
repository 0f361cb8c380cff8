//! Readers of the RoFI platform's files (github.com/paradise-fi/RoFI): JSON worlds, text, and voxels.
//!
//! Each is parsed into one [`World`], which says in the platform's terms what there is, and then built
//! into a [`Linkage`] of the catalogue `rofi`. Lengths in these files are in cells. They say nothing of
//! gravity or surroundings: a start has none, a goal takes its start's.

mod build;
mod json;
mod text;
mod voxels;
mod world;

pub(super) use world::World;

use std::sync::Arc;

use super::super::findings::{Document, Findings};
use super::super::form::Form;
use super::configuration::Surroundings;
use super::environment::MODULE_FRICTION;
use super::matching;
use crate::robot::linkage::{Goal, Linkage};
use crate::robot::{Environment, Matching, Requirement};
use crate::spatial::Vec3;

/// The world that a document of one of the platform's formats describes; `None` after a problem, or
/// for another format.
pub(super) fn parse<'a>(document: &'a Document<'a>, findings: &mut Findings) -> Option<World<'a>> {
    match document.form {
        Form::Own | Form::Tables => None,
        Form::RofiWorld => json::parse(&document.root(), findings),
        Form::RofiText => text::parse(document, findings),
        Form::RofiVoxels => voxels::parse(&document.root(), findings),
    }
}

/// The robot of a world on its own, of a catalogue that has what it and another one need.
pub(super) fn start(world: &World<'_>, other: Option<&World<'_>>, findings: &mut Findings) -> Option<Linkage> {
    let mut needs = build::Needs::default();
    needs.add(world);
    other.into_iter().for_each(|other| needs.add(other));
    let surroundings = Surroundings {
        gravity: Vec3::zeros(),
        environment: Environment { module_friction: MODULE_FRICTION, ..Environment::default() },
        loads: Vec::new(),
        require: Requirement::default(),
    };
    build::build(world, Arc::new(needs.catalogue()), surroundings, findings)
}

/// A world as the goal of a start, whose catalogue and surroundings hold. Modules of one type may swap places, and where
/// nothing holds or pulls the start, the goal may be met anywhere: the platform tells its worlds apart by shape only.
pub(super) fn goal(world: &World<'_>, start: &Linkage, findings: &mut Findings) -> Option<Goal> {
    let surroundings = Surroundings {
        gravity: start.gravity,
        environment: start.environment.clone(),
        loads: Vec::new(),
        require: start.require.clone(),
    };
    let goal = build::build(world, Arc::clone(&start.catalogue), surroundings, findings)?;
    let matching = Matching { labelled: false, free_frame: is_free(start) };
    let mut linkage = matching::in_order_of(start, goal, matching, world.whole.place(), findings)?;
    linkage.loads.clone_from(&start.loads);
    Some(Goal { linkage, matching })
}

/// Whether nothing tells one place from another.
fn is_free(start: &Linkage) -> bool {
    let Environment { ground, obstacles, .. } = &start.environment;
    start.gravity == Vec3::zeros()
        && start.loads.is_empty()
        && ground.is_none()
        && obstacles.is_empty()
        && !start.modules.iter().any(|module| module.fixed)
}
