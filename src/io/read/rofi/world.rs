//! What the platform's files say, in its own terms: before frames and catalogues.

use super::super::super::codes::Code;
use super::super::super::findings::{Findings, Place};
use super::super::super::json::Span;
use super::super::super::rofi::DOCKS;
use crate::spatial::Pose;

/// A place in a file that problems are shown at.
#[derive(Clone, Debug)]
pub(in super::super) struct Mark<'a> {
    place: Place<'a>,
    span: Span,
}

impl<'a> Mark<'a> {
    /// A part of a text that is no JSON; `root` is all of it.
    pub(super) fn in_text(root: Place<'a>, span: Span) -> Self {
        Self { place: root, span }
    }

    /// The value that it is in.
    pub(in super::super) fn place(&self) -> &Place<'a> {
        &self.place
    }

    /// Adds a problem there.
    pub(super) fn report(
        &self,
        findings: &mut Findings,
        code: Code,
        message: impl Into<String>,
        hint: impl Into<String>,
    ) {
        findings.add_at(&self.place, self.span, code, message.into(), Some(hint.into()));
    }
}

impl<'a> From<Place<'a>> for Mark<'a> {
    fn from(place: Place<'a>) -> Self {
        let span = place.span();
        Self { place, span }
    }
}

/// Modules, how they are joined, and where they are.
#[derive(Clone, Debug)]
pub(in super::super) struct World<'a> {
    pub(super) modules: Vec<Module<'a>>,
    pub(super) joints: Joints<'a>,
    /// Where components are. Without any, the first module's shoe A is the origin.
    pub(super) anchors: Vec<Anchor<'a>>,
    /// All of the file.
    pub(in super::super) whole: Mark<'a>,
}

/// A module.
#[derive(Clone, Debug)]
pub(super) struct Module<'a> {
    pub(super) id: String,
    pub(super) kind: Kind<'a>,
    pub(super) mark: Mark<'a>,
}

/// What a module is.
#[derive(Clone, Debug)]
pub(super) enum Kind<'a> {
    /// A universal module with its joints alpha, beta and gamma in degrees, and where the file says so.
    Universal([(f64, Mark<'a>); 3]),
    /// A pad with so many docks, width times height.
    Pad([u32; 2]),
}

/// Which docks are joined.
#[derive(Clone, Debug)]
pub(super) enum Joints<'a> {
    /// Those of a list.
    Listed(Vec<Joint<'a>>),
    /// All that face each other.
    Facing,
}

/// Two joined docks.
#[derive(Clone, Debug)]
pub(super) struct Joint<'a> {
    /// Index of the module and number of its dock, which is that of the port.
    pub(super) ends: [(usize, usize); 2],
    /// By how many quarter turns the second port is turned against the first, right-handed about the first
    /// one's outward axis.
    pub(super) quarters: u8,
    pub(super) mark: Mark<'a>,
}

/// Where a component of a module is.
#[derive(Clone, Debug)]
pub(super) struct Anchor<'a> {
    pub(super) module: usize,
    /// Number of the component, from 0: docks, then shoe A, body A, body B, shoe B.
    pub(super) component: usize,
    /// Pose of the component in the world, in cells.
    pub(super) pose: Pose,
    pub(super) mark: Mark<'a>,
}

impl Kind<'_> {
    /// How many docks it has.
    pub(super) fn docks(&self) -> usize {
        match self {
            Self::Universal(_) => DOCKS.len(),
            // Pads that are larger than any file were refused when they were read.
            Self::Pad([width, height]) => *width as usize * *height as usize,
        }
    }
}
