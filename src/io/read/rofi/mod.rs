//! Readers of the RoFI platform's files (github.com/paradise-fi/RoFI): JSON worlds, text, and voxels.
//!
//! Each is parsed into one [`World`], which says in the platform's terms what there is, and then built
//! into a [`Linkage`](crate::robot::linkage::Linkage) of the catalogue `rofi`. Lengths in these files are in cells.
//! Knows nothing of gravity or surroundings, which no such file can express.

mod build;
mod json;
mod text;
mod voxels;
mod world;

pub(super) use build::{Needs, build};
pub(super) use world::World;

use super::super::findings::{Document, Findings};
use super::super::form::Form;

/// The world that a document of one of the platform's formats describes; `None` after a problem, or for another format.
pub(super) fn parse<'a>(document: &'a Document<'a>, findings: &mut Findings) -> Option<World<'a>> {
    match document.form {
        Form::Own => None,
        Form::RofiWorld => json::parse(&document.root(), findings),
        Form::RofiText => text::parse(document, findings),
        Form::RofiVoxels => voxels::parse(&document.root(), findings),
    }
}
