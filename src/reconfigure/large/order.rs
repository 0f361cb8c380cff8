//! In which order cells are filled and freed, and what dead ends taught about that.
//!
//! Knows cells; knows neither moves nor forces.

use std::cmp::Reverse;
use std::collections::BTreeMap;

use crate::reconfigure::layout::{Layout, Placed};
use crate::robot::{Cell, Environment};
use crate::spatial::Vec3;

use super::journey::Direction;
use super::shape::{Targets, distances, lot, surplus, vacant};

/// How early a cell is taken, smallest first: how often it was not left empty at a dead end, two measures of how close it is,
/// and a lot.
pub type Rank = (Reverse<u32>, i64, i64, u64);

/// What counts first where dead ends taught nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum First {
    /// What is high is freed and what is low is filled first: whatever is left or done stands on what is below it.
    Height,
    /// What is far from what is in place is freed, and what is close to it is filled first.
    Steps,
}

impl First {
    /// Where there is something to stand on, height; without it modules hang from what is held.
    pub fn natural(environment: &Environment) -> Self {
        let is_empty = environment.ground.is_none() && environment.obstacles.is_empty();
        if is_empty { Self::Steps } else { Self::Height }
    }

    /// The other one.
    #[must_use]
    pub fn other(self) -> Self {
        match self {
            Self::Height => Self::Steps,
            Self::Steps => Self::Height,
        }
    }
}

/// In which order cells come where dead ends taught nothing.
#[derive(Clone, Copy, Debug)]
pub struct Order {
    first: First,
    /// The step from cell to cell that leads up, if there is a gravity.
    up: Cell,
    /// Decides between equals.
    pub seed: u64,
}

impl Order {
    /// Under a gravity.
    pub fn new(first: First, gravity: &Vec3, seed: u64) -> Self {
        let mut up = [0; 3];
        let axis = gravity.iamax();
        if gravity[axis] != 0.0 {
            up[axis] = if gravity[axis] > 0.0 { -1 } else { 1 };
        }
        Self { first, up, seed }
    }

    /// How early a cell is filled that is so many steps from what is in place. Freed are the last ones first.
    fn of(&self, cell: Cell, steps: Option<&u32>) -> (i64, i64, u64) {
        let steps = i64::from(steps.copied().unwrap_or(u32::MAX));
        let height = (0..3).map(|axis| i64::from(self.up[axis]) * i64::from(cell[axis])).sum();
        let lot = lot(self.seed, cell);
        match self.first {
            First::Height => (height, steps, lot),
            First::Steps => (steps, height, lot),
        }
    }
}

/// What dead ends taught.
#[derive(Debug, Default)]
pub struct Lessons {
    /// How often cells of the goal were empty at one.
    empty: BTreeMap<Cell, u32>,
    /// How often cells held a module at one that was wanted elsewhere.
    full: BTreeMap<Cell, u32>,
}

impl Lessons {
    /// Those of the way forwards as they are seen in some direction, or the other way round: backwards, the cells
    /// to fill are those that are to be freed forwards.
    #[must_use]
    pub fn seen(self, direction: Direction) -> Self {
        match direction {
            Direction::Forwards => self,
            Direction::Backwards => Self { empty: self.full, full: self.empty },
        }
    }

    /// Takes note of a dead end.
    pub fn note(&mut self, layout: &Layout, targets: &Targets) {
        for cell in vacant(layout, targets).into_keys() {
            *self.empty.entry(cell).or_default() += 1;
        }
        for placed in surplus(layout, targets) {
            *self.full.entry(placed.cell).or_default() += 1;
        }
    }

    /// Empty cells of the goal with how early they should be filled: first those that stayed empty at dead ends.
    pub fn filling_order(
        &self,
        home: &[Cell],
        vacant: &BTreeMap<Cell, u16>,
        targets: &Targets,
        order: &Order,
    ) -> BTreeMap<Cell, Rank> {
        let from_home = distances(home.iter().copied(), |cell| targets.contains_key(&cell));
        let rank = |cell: Cell| {
            let empty = self.empty.get(&cell).copied().unwrap_or(0);
            let (first, then, lot) = order.of(cell, from_home.get(&cell));
            (Reverse(empty), first, then, lot)
        };
        vacant.keys().map(|&cell| (cell, rank(cell))).collect()
    }

    /// Modules in the order in which they should leave: first those in cells that were not freed at dead ends.
    pub fn freeing_order(&self, home: &[Cell], movers: &[Placed], layout: &Layout, order: &Order) -> Vec<Placed> {
        let from_home = distances(home.iter().copied(), |cell| layout.is_filled(cell));
        let mut movers = movers.to_vec();
        movers.sort_by_key(|placed| {
            let full = self.full.get(&placed.cell).copied().unwrap_or(0);
            Reverse((full, order.of(placed.cell, from_home.get(&placed.cell))))
        });
        movers
    }
}

/// All cells within the bounds by how close they are to some.
pub fn by_steps(cells: impl Iterator<Item = Cell>, [low, high]: [Cell; 2], order: &Order) -> BTreeMap<Cell, Rank> {
    let within = |cell: Cell| (0..3).all(|i| low[i] <= cell[i] && cell[i] <= high[i]);
    let order = Order { first: First::Steps, ..*order };
    let rank = |(cell, steps): (Cell, u32)| {
        let (first, then, lot) = order.of(cell, Some(&steps));
        (cell, (Reverse(0), first, then, lot))
    };
    distances(cells, within).into_iter().map(rank).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A column beside what is in place at the origin, and a row away from it.
    const CELLS: [Cell; 5] = [[1, 0, 0], [1, 0, 1], [1, 0, 2], [2, 0, 0], [3, 0, 0]];

    /// What is freed first of the cells, and what is filled first, under a gravity.
    fn firsts(first: First, gravity: Vec3) -> [Cell; 2] {
        let order = Order::new(first, &gravity, 1);
        let (lessons, home) = (Lessons::default(), [[0; 3]]);
        let placed = |&cell: &Cell| Placed { cell, class: 0, orientation: crate::robot::Orientation::IDENTITY };
        let layout = Layout::new(home.iter().chain(&CELLS).map(placed).collect());
        let targets = crate::reconfigure::large::shape::targets(&layout);
        let movers: Vec<Placed> = CELLS.iter().map(placed).collect();
        let vacant = movers.iter().map(|mover| (mover.cell, 0)).collect();
        let to_fill = lessons.filling_order(&home, &vacant, &targets, &order);
        let earliest = to_fill.iter().min_by_key(|(_, rank)| **rank).unwrap();
        [lessons.freeing_order(&home, &movers, &layout, &order)[0].cell, *earliest.0]
    }

    #[test]
    fn height_is_against_gravity_and_steps_are_from_what_is_in_place() {
        let down = Vec3::new(0.0, 0.0, -9.81);
        assert_eq!(firsts(First::Height, down), [[1, 0, 2], [1, 0, 0]]);
        // On the ceiling the column hangs down.
        assert_eq!(firsts(First::Height, -down), [[3, 0, 0], [1, 0, 2]]);
        assert_eq!(firsts(First::Height, Vec3::new(9.81, 0.0, 0.0)), [[1, 0, 2], [3, 0, 0]]);
        // As far as the end of the row is only the top of the column, which is higher.
        assert_eq!(firsts(First::Steps, down), [[1, 0, 2], [1, 0, 0]]);
        assert_eq!(firsts(First::Steps, -down), [[3, 0, 0], [1, 0, 0]]);
        assert_eq!(firsts(First::Height, Vec3::zeros())[1], [1, 0, 0], "without gravity steps are all");
    }

    #[test]
    fn what_stayed_at_dead_ends_comes_first() {
        let order = Order::new(First::Height, &Vec3::new(0.0, 0.0, -1.0), 1);
        let placed = |cell: Cell| Placed { cell, class: 0, orientation: crate::robot::Orientation::IDENTITY };
        let layout = Layout::new(vec![placed([0; 3]), placed([1, 0, 0])]);
        let targets = Targets::from([([0; 3], 0), ([0, 0, 3], 0)]);
        let mut lessons = Lessons::default();
        lessons.note(&layout, &targets);
        let movers = [placed([2, 0, 9]), placed([1, 0, 0])];
        assert_eq!(lessons.freeing_order(&[], &movers, &layout, &order)[0].cell, [1, 0, 0]);
        let vacant = BTreeMap::from([([0, 0, 3], 0), ([0, 0, 1], 0)]);
        let to_fill = lessons.filling_order(&[], &vacant, &targets, &order);
        assert!(to_fill[&[0, 0, 3]] < to_fill[&[0, 0, 1]]);
    }
}
