//! What leaves a problem as it is but for where its goal is: displacements over flat ground that has no end,
//! turns about the vertical and mirror images.
//!
//! Knows cells and what stands around them; asks no oracle.

use crate::robot::{Cell, Configuration, Face, Motion, Orientation, Stencil};
use crate::statics::Model;

use super::layout::{Layout, Placed, displaced};
use super::moves::Move;
use super::problem::Problem;

/// Points of a connector closer than this along an axis, in m, count as one.
const SAME_POINT: f64 = 1e-9;

/// The symmetries of a problem that displaces freely.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Symmetry {
    /// Whether there is no ground, so that heights make no difference.
    is_afloat: bool,
    /// What may be done to cells before they are displaced, the identity first.
    images: Vec<Image>,
}

/// A mirroring, or none, and then a rotation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Image {
    /// Whether x changes sign first.
    is_mirrored: bool,
    turn: Orientation,
}

impl Image {
    const IDENTITY: Self = Self { is_mirrored: false, turn: Orientation::IDENTITY };

    /// The image of a cell, up to a displacement that is the same for all cells.
    fn cell(self, [x, y, z]: Cell) -> Cell {
        self.turn.carry([if self.is_mirrored { -x } else { x }, y, z])
    }

    fn face(self, face: Face) -> Face {
        Face::from_step(self.cell(face.step())).expect("a signed permutation keeps unit steps")
    }

    fn motion(self, motion: Motion) -> Motion {
        match motion {
            Motion::Translation { by } => Motion::Translation { by: self.cell(by) },
            Motion::Rotation { support, towards, turn } => {
                Motion::Rotation { support: self.face(support), towards: self.face(towards), turn }
            }
        }
    }

    fn layout(self, layout: &Layout) -> Layout {
        let image = |placed: &Placed| Placed { cell: self.cell(placed.cell), ..*placed };
        Layout::new(layout.placed().iter().map(image).collect())
    }
}

impl Symmetry {
    /// The symmetries of a problem; `None` where displacements are none of them. That is so where anything
    /// has a place: obstacles, modules that are held or may not move, forbidden regions.
    pub fn of(problem: &Problem) -> Option<Self> {
        let start = problem.start();
        let is_bound = !start.environment.obstacles.is_empty()
            || start.modules.iter().any(|module| module.fixed)
            || !start.require.stay.is_empty()
            || !start.require.keep_out.is_empty();
        (!is_bound).then(|| Self { is_afloat: start.environment.ground.is_none(), images: images(problem) })
    }

    /// The layout moved to where the lowest coordinates that make no difference are 0, and the displacement that takes
    /// it back.
    pub fn class(&self, layout: &Layout) -> (Layout, Cell) {
        let corner = self.corner(layout);
        (layout.displaced(corner.map(|c| -c)), corner)
    }

    /// Of all images of the layout, the least: the same for all layouts that are images of each other.
    pub fn kind(&self, layout: &Layout) -> Layout {
        let images = self.images.iter().map(|image| self.class(&image.layout(layout)).0);
        images.min().expect("the identity is an image")
    }

    /// Of all images of a move and the layout that it begins in, the one in which the modules that stay are least: they are
    /// where they are in all moves of one module over the same others.
    pub fn kind_of_move(&self, layout: &Layout, step: Move) -> (Layout, Move) {
        let images = self.images.iter().map(|image| {
            let (whole, from) = (image.layout(layout), image.cell(step.from));
            let staying = whole.placed().iter().copied().filter(|placed| placed.cell != from);
            let (rest, corner) = self.class(&Layout::new(staying.collect()));
            let back = corner.map(|c| -c);
            let step = Move { from: displaced(from, back), motion: image.motion(step.motion), ..step };
            (rest, step, whole, back)
        });
        let (_, step, whole, back) = images.min().expect("the identity is an image");
        (whole.displaced(back), step)
    }

    /// The lowest coordinates along the axes that make no difference, 0 along others.
    fn corner(&self, layout: &Layout) -> Cell {
        let cells = || layout.placed().iter().map(|placed| placed.cell);
        let lowest = |axis: usize| cells().map(|cell| cell[axis]).min().unwrap_or(0);
        [lowest(0), lowest(1), if self.is_afloat { lowest(2) } else { 0 }]
    }
}

/// The images that leave everything as it is. Turns about the vertical do where gravity is vertical and modules are alike in
/// all orientations, which no load changes; mirror images where motions and connectors are their own.
fn images(problem: &Problem) -> Vec<Image> {
    let start = problem.start();
    let is_upright = start.gravity.x == 0.0 && start.gravity.y == 0.0;
    if !is_upright || !start.loads.is_empty() {
        return vec![Image::IDENTITY];
    }
    let quarter = Orientation::quarter_turn(Face::PosZ);
    let quarters = std::iter::successors(Some(Orientation::IDENTITY), |turn| Some(turn.turned(quarter))).take(4);
    let mirrors: &[bool] = if is_its_mirror_image(start) { &[false, true] } else { &[false] };
    let images = mirrors.iter().flat_map(|&is_mirrored| quarters.clone().map(move |turn| Image { is_mirrored, turn }));
    images.collect()
}

/// Whether whatever modules can do and carry, their mirror images can.
fn is_its_mirror_image(start: &Configuration) -> bool {
    let catalogue = &start.catalogue;
    let has_mirrored = |stencil: &Stencil| {
        let own = stencil.variants();
        let both = Stencil { mirrored: true, ..stencil.clone() }.variants();
        both.iter().all(|image| own.contains(image))
    };
    let is_symmetric = |model: &Model| match model {
        Model::Cone { .. } | Model::Box { .. } => true,
        Model::Patch { points, .. } => {
            let is_point = |x: f64, y: f64| points.iter().any(|q| (q[0] - x).abs().max((q[1] - y).abs()) <= SAME_POINT);
            points.iter().all(|&[x, y]| is_point(-x, y) && is_point(x, -y))
        }
    };
    catalogue.motions.iter().flat_map(|motion| &motion.stencils).all(has_mirrored)
        && catalogue.connectors.iter().all(|connector| is_symmetric(&connector.model))
}
