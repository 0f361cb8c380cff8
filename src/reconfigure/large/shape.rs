//! What a robot still lacks to be the goal, in which order to fill and to free cells, and what must stay open.
//!
//! Knows cells; knows neither moves nor forces.

use std::collections::{BTreeMap, BTreeSet, HashMap, VecDeque};

use crate::reconfigure::layout::{Layout, Placed, neighbour};
use crate::robot::{Cell, Face};

/// Cells where modules are wanted, each with the class that it wants.
pub type Targets = BTreeMap<Cell, u16>;

/// A layout as what is wanted.
pub fn targets(layout: &Layout) -> Targets {
    layout.placed().iter().map(|placed| (placed.cell, placed.class)).collect()
}

/// Modules that are not where the goal wants one of their class, ascending.
pub fn surplus(layout: &Layout, targets: &Targets) -> Vec<Placed> {
    layout.placed().iter().copied().filter(|placed| targets.get(&placed.cell) != Some(&placed.class)).collect()
}

/// Cells of the goal that no module fills, ascending.
pub fn vacant(layout: &Layout, targets: &Targets) -> BTreeMap<Cell, u16> {
    targets.iter().filter(|(cell, _)| !layout.is_filled(**cell)).map(|(cell, class)| (*cell, *class)).collect()
}

/// How many steps from face to face every cell of `within` is from the nearest of `sources`.
pub fn distances(sources: impl IntoIterator<Item = Cell>, within: impl Fn(Cell) -> bool) -> HashMap<Cell, u32> {
    let mut found: HashMap<Cell, u32> = sources.into_iter().map(|cell| (cell, 0)).collect();
    // Which of those equally far comes first changes no distance.
    let mut queue: VecDeque<Cell> = found.keys().copied().collect();
    while let Some(cell) = queue.pop_front() {
        let next = found[&cell] + 1;
        for beside in Face::ALL.map(|face| neighbour(cell, face)) {
            if within(beside) && !found.contains_key(&beside) {
                found.insert(beside, next);
                queue.push_back(beside);
            }
        }
    }
    found
}

/// Whether all modules of a layout hang together.
pub fn is_connected(layout: &Layout) -> bool {
    let Some(first) = layout.placed().first() else { return true };
    distances([first.cell], |cell| layout.is_filled(cell)).len() == layout.placed().len()
}

/// Lowest and highest cell of all these, with so much room around.
pub fn bounds(cells: impl IntoIterator<Item = Cell>, room: i32) -> [Cell; 2] {
    let mut bounds = [[i32::MAX; 3], [i32::MIN; 3]];
    for cell in cells {
        for axis in 0..3 {
            bounds[0][axis] = bounds[0][axis].min(cell[axis].saturating_sub(room));
            bounds[1][axis] = bounds[1][axis].max(cell[axis].saturating_add(room));
        }
    }
    bounds
}

/// Which of `wanted`, all of them empty, are open to the outside of a layout through empty cells.
pub fn open(layout: &Layout, wanted: &BTreeSet<Cell>) -> BTreeSet<Cell> {
    let all = layout.placed().iter().map(|placed| placed.cell).chain(wanted.iter().copied());
    let [low, high] = bounds(all, 1);
    let is_free = |cell: Cell| (0..3).all(|i| low[i] <= cell[i] && cell[i] <= high[i]) && !layout.is_filled(cell);
    let is_outside = |cell: Cell| (0..3).any(|i| cell[i] == low[i] || cell[i] == high[i]);
    // Most are a few straight steps from the outside, which a search depth first finds at once. What it meets
    // counts as closed until then.
    let mut known: HashMap<Cell, bool> = HashMap::new();
    let is_open = |cell: &&Cell| {
        if let Some(&is_open) = known.get(*cell) {
            return is_open;
        }
        known.insert(**cell, false);
        let (mut seen, mut stack) = (vec![**cell], vec![**cell]);
        while let Some(at) = stack.pop() {
            let mut is_open = is_outside(at);
            for beside in Face::ALL.map(|face| neighbour(at, face)) {
                match known.get(&beside) {
                    Some(&beside) => is_open |= beside,
                    None if is_free(beside) => {
                        known.insert(beside, false);
                        seen.push(beside);
                        stack.push(beside);
                    }
                    None => {}
                }
            }
            if is_open {
                known.extend(seen.into_iter().map(|cell| (cell, true)));
                return true;
            }
        }
        false
    };
    wanted.iter().filter(is_open).copied().collect()
}

/// A number for a cell that depends on the seed and on nothing else: decides between equals.
pub fn lot(seed: u64, cell: Cell) -> u64 {
    cell.into_iter().fold(seed, |mixed, coordinate| {
        // Steele, Lea, Flood: "Fast splittable pseudorandom number generators", 2014 (SplitMix64).
        let mut z = (mixed ^ u64::from(coordinate.cast_unsigned())).wrapping_add(0x9E37_79B9_7F4A_7C15);
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    })
}
