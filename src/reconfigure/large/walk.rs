//! Where one module can get to over the others, and how.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use crate::reconfigure::domain::Domain;
use crate::reconfigure::hanging::Reach;
use crate::reconfigure::layout::{Layout, Placed, displaced};
use crate::reconfigure::moves::Move;
use crate::robot::Cell;

use super::journey::Direction;
use super::ways::{Ways, shift};

/// All cells that a module reaches over the others, by fewest moves.
#[derive(Debug)]
pub struct Walk {
    /// In the order in which they were reached, the module's own cell first.
    pub reached: Vec<Cell>,
    /// By which move of the plan.
    came_by: HashMap<Cell, Move>,
    direction: Direction,
}

impl Walk {
    /// Walks `mover` over `rest` in some direction, by moves whose margin is at least `floor` while it is held by
    /// modules that are not `shunned`, within the `bounds`.
    pub fn new(
        domain: &Domain,
        ways: &mut Ways,
        (rest, mover, direction): (&Layout, Placed, Direction),
        floor: f64,
        shunned: &BTreeSet<Cell>,
        bounds: [Cell; 2],
    ) -> Self {
        let mut walk = Self { reached: vec![mover.cell], came_by: HashMap::new(), direction };
        let mut next = 0;
        while let Some(&cell) = walk.reached.get(next) {
            next += 1;
            for step in domain.moves_of(rest, &Placed { cell, ..mover }) {
                let to = step.to();
                let within = (0..3).all(|axis| bounds[0][axis] <= to[axis] && to[axis] <= bounds[1][axis]);
                if !within || to == mover.cell || walk.came_by.contains_key(&to) {
                    continue;
                }
                let planned = direction.planned(step);
                // The plan begins where this walk leads. Not every module that a move lands on could carry it back.
                let fits = || domain.moves_of(rest, &Placed { cell: to, ..mover }).contains(&planned);
                if direction == Direction::Backwards && !fits() {
                    continue;
                }
                if domain.stability {
                    let Some(way) = ways.of(rest, mover.class, planned) else { continue };
                    let holds = |(support, _): &(Cell, Reach)| !shunned.contains(&displaced(*support, planned.from));
                    if !(way.margin.lower >= floor && way.reaches.iter().all(holds)) {
                        continue;
                    }
                }
                walk.came_by.insert(to, planned);
                walk.reached.push(to);
            }
        }
        walk
    }

    /// The moves that lead to a cell that was reached, or back from it, in the order of the plan.
    pub fn path(&self, to: Cell) -> Vec<Move> {
        let mut path = Vec::new();
        let mut at = to;
        while let Some(&step) = self.came_by.get(&at) {
            path.push(step);
            at = self.direction.origin(step);
        }
        if self.direction == Direction::Forwards {
            path.reverse();
        }
        path
    }
}

/// Where on which modules a walk puts the module's weight, in W.
pub fn reaches(ways: &mut Ways, rest: &Layout, class: u16, path: &[Move], pitch: f64) -> BTreeMap<Cell, Reach> {
    let mut all: BTreeMap<Cell, Reach> = BTreeMap::new();
    for &step in path {
        let Some(way) = ways.of(rest, class, step) else { continue };
        let by = shift(step.from, pitch);
        for (support, reach) in &way.reaches {
            let reach = reach.moved(&by);
            let joined = |known: &mut Reach| *known = known.joined(reach);
            all.entry(displaced(*support, step.from)).and_modify(joined).or_insert(reach);
        }
    }
    all
}
