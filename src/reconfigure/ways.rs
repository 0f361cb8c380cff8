//! The motions of a catalogue in all orientations, and which of them a module can make among others.
//!
//! Knows nothing of obstacles, ground, forces or module names.

use crate::robot::{Catalogue, Cell, Face, Motion, Stencil};

use super::layout::{Bond, Layout, Placed, displaced, neighbour};
use super::moves::Move;

/// A motion in one orientation, for a module in cell `[0, 0, 0]`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Way {
    /// How it leads on.
    pub motion: Motion,
    /// Which motion of the catalogue it is: an index into [`Catalogue::motions`].
    pub kind: u16,
    /// The cells that it sweeps, which must be empty.
    room: Vec<Cell>,
    /// What else it needs: any one of these.
    needs: Vec<Need>,
}

/// What a way may need.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Need {
    occupied: Vec<Cell>,
    free: Vec<Cell>,
}

impl Need {
    fn is_met(&self, from: Cell, layout: &Layout) -> bool {
        self.occupied.iter().all(|&cell| layout.is_filled(displaced(from, cell)))
            && self.free.iter().all(|&cell| !layout.is_filled(displaced(from, cell)))
    }
}

impl Way {
    /// The cells that it may need filled or empty, beside its room, for the module in `from`.
    pub fn needs(&self, from: Cell) -> impl Iterator<Item = Cell> {
        let cells = self.needs.iter().flat_map(|need| need.occupied.iter().chain(&need.free));
        cells.map(move |&cell| displaced(from, cell))
    }

    /// Whether its needs can be met, for the module in `from`, by modules in cells that `may` hold one alone.
    pub fn can_be_met(&self, from: Cell, may: impl Fn(Cell) -> bool) -> bool {
        self.needs.iter().any(|need| need.occupied.iter().all(|&cell| may(displaced(from, cell))))
    }

    /// Whether modules are where it needs them for the module in `from`, and nowhere in its room.
    fn fits(&self, from: Cell, layout: &Layout) -> bool {
        self.room.iter().all(|&cell| !layout.is_filled(displaced(from, cell)))
            && self.needs.iter().any(|need| need.is_met(from, layout))
    }

    /// Whether one of the engaged connections is one that it starts from, for the module in `from`.
    fn is_held_by(&self, from: Cell, layout: &Layout, bonds: &[Bond]) -> bool {
        let engaged = |side: Face| bonds.binary_search(&Bond::new(from, side)).is_ok();
        match self.motion {
            Motion::Rotation { support, .. } => engaged(support),
            Motion::Translation { .. } => {
                let met = self.needs.iter().filter(|need| need.is_met(from, layout));
                let beside = |need: &Need| {
                    let mut sides = self.motion.sides().filter(|side| need.occupied.contains(&side.step()));
                    sides.any(engaged)
                };
                met.into_iter().any(beside)
            }
        }
    }
}

/// What a module can do.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Ability {
    /// Its motions, in a fixed order: translations before rotations.
    ways: Vec<Way>,
    /// Whether its own edges have hinges.
    hinge: bool,
}

impl Ability {
    /// What free modules of a type can do.
    pub fn new(catalogue: &Catalogue, module_type: usize) -> Self {
        let lattice = catalogue.module_types[module_type].cell();
        let mut ways: Vec<Way> = Vec::new();
        for &motion in &lattice.motions {
            let kind = u16::try_from(motion).expect("a catalogue has fewer motions than kinds have numbers");
            for variant in catalogue.motions[motion].stencils.iter().flat_map(Stencil::variants) {
                let need = Need { occupied: variant.occupied, free: variant.free };
                match ways.iter_mut().find(|way| (way.motion, way.kind) == (variant.motion, kind)) {
                    Some(way) => way.needs.push(need),
                    None => {
                        let room = variant.motion.swept();
                        ways.push(Way { motion: variant.motion, kind, room, needs: vec![need] });
                    }
                }
            }
        }
        ways.sort_unstable_by_key(|way| (way.motion, way.kind));
        Self { ways, hinge: lattice.hinge.is_some() }
    }

    /// What modules that never move can do: carry others.
    #[must_use]
    pub fn held(self) -> Self {
        Self { ways: Vec::new(), ..self }
    }

    /// Its motions.
    pub fn ways(&self) -> &[Way] {
        &self.ways
    }

    /// The way that a move takes, if modules with this ability can.
    pub fn way(&self, step: Move) -> Option<&Way> {
        self.ways.iter().find(|way| (way.motion, way.kind) == (step.motion, step.kind))
    }

    /// Whether the engaged connections `bonds` allow a fitting move of a module with this ability: those that it
    /// must have released are, and one that it starts from is engaged.
    pub fn allows(&self, layout: &Layout, bonds: &[Bond], step: Move) -> bool {
        bonds.iter().all(|&bond| !bond.touches(step.from) || step.may_keep(bond))
            && self.way(step).is_some_and(|way| way.is_held_by(step.from, layout, bonds))
    }
}

/// Every move that fits among the modules of `layout`, whatever is engaged. In a
/// fixed order: by the moving module's cell, translations before rotations.
pub fn fitting<'a>(layout: &Layout, ability: impl Fn(u16) -> &'a Ability) -> Vec<Move> {
    layout.placed().iter().flat_map(|placed| fitting_of(layout, placed, &ability)).collect()
}

/// Every move of one module that fits among the others of `layout`, translations before rotations.
pub fn fitting_of<'a>(layout: &Layout, placed: &Placed, ability: impl Fn(u16) -> &'a Ability) -> Vec<Move> {
    let able = ability(placed.class);
    let carries = |support| {
        let at = layout.at(neighbour(placed.cell, support));
        able.hinge && at.is_some_and(|at| ability(layout.placed()[at].class).hinge)
    };
    let is_hinged = |way: &&Way| match way.motion {
        Motion::Translation { .. } => true,
        Motion::Rotation { support, .. } => carries(support),
    };
    let ways = able.ways.iter().filter(|way| way.fits(placed.cell, layout)).filter(is_hinged);
    ways.map(|way| Move { from: placed.cell, motion: way.motion, kind: way.kind }).collect()
}
