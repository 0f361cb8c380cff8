//! Soundness of motions: nothing that a stencil says is believed where its geometry decides.

use super::catalogue::Catalogue;
use super::lattice::{Cell, Face};
use super::module_type::LatticeType;
use super::motion::{Motion, Turn};
use super::problem::{Fault, Findings, Part};
use super::stencil::{FARTHEST_CELL, MotionType, Stencil};

impl Catalogue {
    /// Adds everything that is wrong with the motions.
    pub(super) fn check_motions(&self, findings: &mut Findings) {
        findings.distinct(Part::MotionType, "name", self.motions.iter().map(|motion| motion.name.as_str()));
        for (i, motion) in self.motions.iter().enumerate() {
            let (part, before) = (Part::MotionType(i), findings.0.len());
            if motion.stencils.is_empty() {
                findings.add(part, "", Fault::NoStencils);
            }
            if MotionType::built_in(&motion.name).is_some_and(|built_in| built_in != *motion) {
                findings.add(part, "name", Fault::NotTheBuiltIn);
            }
            for (j, stencil) in motion.stencils.iter().enumerate() {
                stencil.check(findings, Part::Stencil(i, j));
            }
            if findings.0.len() == before {
                motion.check_ways_back(findings, i);
            }
        }
    }

    /// Adds everything that is wrong with the choice of motions of a module type.
    pub(super) fn check_motions_of(&self, findings: &mut Findings, index: usize, lattice: &LatticeType) {
        let count = self.motions.len();
        let mut known = true;
        for (i, &motion) in lattice.motions.iter().enumerate() {
            known &= findings.in_range(Part::MotionOfType(index, i), "", motion, count);
        }
        if !known {
            return;
        }
        let turns = |stencil: &Stencil| matches!(stencil.motion, Motion::Rotation { .. });
        for (i, &motion) in lattice.motions.iter().enumerate() {
            if lattice.hinge.is_none() && self.motions[motion].stencils.iter().any(turns) {
                findings.add(Part::MotionOfType(index, i), "", Fault::NoHinge);
            }
        }
    }
}

impl MotionType {
    /// Adds every stencil that no stencil of the motion reverses. The stencils themselves must be sound.
    fn check_ways_back(&self, findings: &mut Findings, motion: usize) {
        let all: Vec<Stencil> = self.stencils.iter().flat_map(Stencil::variants).collect();
        for (i, stencil) in self.stencils.iter().enumerate() {
            // What leads back from one orientation leads back, turned alike, from all, but for mirror images.
            if !stencil.variants().iter().all(|way| all.iter().any(|back| way.leads_back_by(back))) {
                findings.add(Part::Stencil(motion, i), "", Fault::NoWayBack);
            }
        }
    }
}

impl Stencil {
    /// Adds everything that is wrong with the stencil.
    fn check(&self, findings: &mut Findings, part: Part) {
        let is_far = |cell: Cell| cell.into_iter().any(|c| c.unsigned_abs() > FARTHEST_CELL.unsigned_abs());
        match self.motion {
            Motion::Translation { by: [0, 0, 0] } => return findings.add(part, "by", Fault::NoDisplacement),
            Motion::Translation { by } if is_far(by) => return findings.add(part, "by", Fault::FarCell { cell: 0 }),
            Motion::Rotation { support, towards, .. } if support.axis() == towards.axis() => {
                return findings.add(part, "towards", Fault::NoEdge);
            }
            Motion::Translation { .. } | Motion::Rotation { .. } => {}
        }
        for (field, cells) in [("occupied", &self.occupied), ("free", &self.free)] {
            for (i, &cell) in cells.iter().enumerate() {
                if is_far(cell) {
                    findings.add(part, field, Fault::FarCell { cell: i });
                } else if cell == [0; 3] {
                    findings.add(part, field, Fault::OwnCell { cell: i });
                }
            }
        }
        for (i, cell) in self.free.iter().enumerate() {
            if self.occupied.contains(cell) {
                findings.add(part, "free", Fault::OccupiedAndFree { cell: i });
            }
        }
        let swept = self.motion.swept();
        for (i, cell) in self.occupied.iter().enumerate() {
            if swept.contains(cell) {
                findings.add(part, "occupied", Fault::InTheWay { cell: i });
            }
        }
        self.check_hold(findings, part);
    }

    /// Something must hold the module wherever it is.
    fn check_hold(&self, findings: &mut Findings, part: Part) {
        let beyond = |cell: Cell, side: Face| -> Cell { std::array::from_fn(|i| cell[i] + side.step()[i]) };
        match self.motion {
            Motion::Translation { .. } => {
                let is_held = |cells: &Vec<Cell>| {
                    let mut beside =
                        cells.iter().flat_map(|&cell| self.motion.sides().map(move |side| beyond(cell, side)));
                    beside.any(|cell| self.occupied.contains(&cell))
                };
                if let Some(cells) = self.motion.stations().into_iter().find(|cells| !is_held(cells)) {
                    findings.add(part, "occupied", Fault::NothingAlongside { at: cells[0] });
                }
            }
            Motion::Rotation { support, turn, .. } => {
                let support = support.step();
                if !self.occupied.contains(&support) {
                    findings.add(part, "occupied", Fault::NoSupport { support });
                }
                if let (Turn::Quarter, Some(side)) = (turn, self.motion.landing()) {
                    let landing = beyond(self.motion.by(), side);
                    if !self.occupied.contains(&landing) {
                        findings.add(part, "occupied", Fault::NoLanding { landing });
                    }
                }
            }
        }
    }
}
