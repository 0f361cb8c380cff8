//! Margins of moves that the moving module's own hold decides: found without the rest of the robot, which is only asked
//! whether it carries what the module does to it.
//!
//! With all other modules held immovably their balance drops out, so the module's own utilisation is a lower bound on the
//! robot's. The forces that prove it act on the others as loads; where the rest carries these with no larger utilisation,
//! both together are a balanced field of the whole robot, and that utilisation is the robot's own. The
//! module's own hold is the same wherever its surroundings look alike, away from ground and obstacles.
//!
//! Where the rest of the robot is what limits it, nothing is said.

use std::collections::{HashMap, VecDeque};
use std::sync::{Arc, Mutex};

use crate::robot::{Cell, Occupancy, Orientation};
use crate::statics::{Load, Tally};

use super::course::{Course, engagement};
use super::hanging::Rest;
use super::large::shift;
use super::layout::{Bond, Layout, displaced};
use super::moves::Move;
use super::oracle::{Oracle, Worst};
use super::problem::Problem;

/// Rests that are kept: modules move more than once in a row.
const RESTS: usize = 8;

/// A move with all that may touch its module, from the cell that it leaves; where ground or obstacles may touch
/// it, with that cell.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
struct Surrounded {
    step: Move,
    /// Whether ground or obstacles may touch it.
    is_along: bool,
    class: u16,
    orientation: Orientation,
    /// Filled cells with the types of the modules there, ascending.
    around: Vec<(Cell, usize)>,
}

/// How a move's module is held by modules that do not give way.
struct Own {
    /// The worst sample, cells counted from the one that the move leaves.
    worst: Worst,
    /// What the module does to those around it at each sampled phase, the worst first: by cell, at places from the one
    /// that it leaves.
    on_others: Vec<Vec<(Cell, Load)>>,
}

/// All modules but one, with the connections among them.
#[derive(PartialEq, Eq)]
struct Others {
    layout: Layout,
    class: u16,
    bonds: Vec<Bond>,
}

/// What was found about the holds of one robot's modules. What is kept depends on what is asked, never on time.
#[derive(Default)]
pub struct Held {
    known: HashMap<Surrounded, Option<Arc<Own>>>,
    /// The latest ones, with where their modules are.
    kept: VecDeque<(Others, Occupancy, Rest)>,
}

impl Held {
    /// The margin of a move's samples, taken and refined as in [`Oracle::of_move`] but by the module's own hold, where that decides it; `bonds` are the
    /// connections before it. `is_along` says whether the module may touch ground or obstacles on its way.
    pub fn margin(
        &mut self,
        (problem, oracle): (&Problem, &Oracle),
        layout: &Layout,
        bonds: &[Bond],
        step: Move,
        is_along: bool,
    ) -> Option<Worst> {
        let own = self.own((problem, oracle), layout, step, is_along)?;
        let level = 1.0 - own.worst.margin.lower;
        if !level.is_finite() {
            return None;
        }
        let index = self.find((problem, oracle), layout, bonds, step)?;
        let (_, occupancy, rest) = &mut self.kept[index];
        let by = shift(step.from, problem.start().pitch());
        let mut tally = Tally::default();
        let carries = |loads: &Vec<(Cell, Load)>| {
            let load = |(cell, load): &(Cell, Load)| {
                let body = occupancy.at(displaced(*cell, step.from))?;
                Some(Load { body, at: load.at.map(|at| at + by), ..load.clone() })
            };
            let loads: Option<Vec<Load>> = loads.iter().map(load).collect();
            loads.is_some_and(|loads| rest.under(&loads, level, &mut tally) <= level)
        };
        let is_carried = own.on_others.iter().all(carries);
        oracle.add(&tally);
        if !is_carried {
            return None;
        }
        let mut worst = own.worst;
        if let Some(seam) = &mut worst.weakest {
            seam.cells = seam.cells.map(|cell| displaced(cell, step.from));
        }
        Some(worst)
    }

    fn own(
        &mut self,
        (problem, oracle): (&Problem, &Oracle),
        layout: &Layout,
        step: Move,
        is_along: bool,
    ) -> Option<Arc<Own>> {
        let moving = layout.placed()[layout.at(step.from)?];
        let swept = step.room().into_iter().chain([step.from, step.to()]);
        let bounds = swept.fold([[i32::MAX; 3], [i32::MIN; 3]], |[low, high], cell: Cell| {
            [0, 1].map(|end| {
                std::array::from_fn(|i| if end == 0 { low[i].min(cell[i] - 1) } else { high[i].max(cell[i] + 1) })
            })
        });
        let is_near =
            |cell: Cell| cell != step.from && (0..3).all(|i| bounds[0][i] <= cell[i] && cell[i] <= bounds[1][i]);
        let back = if is_along { [0; 3] } else { step.from.map(|coordinate| -coordinate) };
        let around = layout.placed().iter().filter(|placed| is_near(placed.cell));
        let around = around.map(|p| (displaced(p.cell, back), problem.class(p.class).module_type)).collect();
        let key = Surrounded {
            step: Move { from: displaced(step.from, back), ..step },
            is_along,
            class: moving.class,
            orientation: moving.orientation,
            around,
        };
        if let Some(known) = self.known.get(&key) {
            return known.clone();
        }
        let own = find_own((problem, oracle), layout, step).map(Arc::new);
        self.known.insert(key, own.clone());
        own
    }

    /// Where all modules but the one that moves are kept.
    fn find(
        &mut self,
        (problem, oracle): (&Problem, &Oracle),
        layout: &Layout,
        bonds: &[Bond],
        step: Move,
    ) -> Option<usize> {
        let class = layout.placed()[layout.at(step.from)?].class;
        let rest = layout.placed().iter().copied().filter(|placed| placed.cell != step.from);
        let bonds = bonds.iter().copied().filter(|bond| !bond.touches(step.from));
        let others = Others { layout: Layout::new(rest.collect()), class, bonds: bonds.collect() };
        if let Some(index) = self.kept.iter().position(|(kept, _, _)| *kept == others) {
            return Some(index);
        }
        let placements = problem.placements(layout);
        let occupancy = Occupancy::of_placements(&placements);
        let engaged: Vec<_> = others.bonds.iter().filter_map(|&bond| engagement(&occupancy, bond)).collect();
        let memory = self.kept.front().and_then(|(_, _, rest)| rest.memory().cloned());
        let rest = oracle.rest((occupancy.at(step.from)?, &placements, &engaged), memory);
        self.kept.push_front((others, occupancy, rest));
        self.kept.truncate(RESTS);
        Some(0)
    }

    /// Approximate memory, in bytes.
    pub fn bytes(&self) -> usize {
        // About a dozen samples with two loads each.
        self.known.len() * (size_of::<Surrounded>() + 24 * size_of::<(Cell, Load)>())
    }
}

/// How the module of a move out of a layout is held.
fn find_own((problem, oracle): (&Problem, &Oracle), layout: &Layout, step: Move) -> Option<Own> {
    let pitch = problem.start().pitch();
    let placements = problem.placements(layout);
    let occupancy = Occupancy::of_placements(&placements);
    let cells: Vec<Cell> = placements.iter().map(|placement| placement.cell).collect();
    occupancy.at(step.from)?;
    // What holds the others to each other plays no part.
    let course = Course::new(placements, &[], step, pitch)?;
    let samples = Mutex::new(Vec::new());
    let back = step.from.map(|coordinate| -coordinate);
    let by = shift(step.from, pitch);
    let mut worst = oracle.own_course(&course, step, &|phase, loads: Vec<Load>| {
        let load = |load: Load| (displaced(cells[load.body], back), Load { at: load.at.map(|at| at - by), ..load });
        let loads: Vec<(Cell, Load)> = loads.into_iter().map(load).collect();
        samples.lock().expect("no thread panics while it adds").push((phase, loads));
    })?;
    let worst_at = worst.instant.phase();
    let mut samples = samples.into_inner().expect("no thread panics while it adds");
    samples.sort_by(|(a, _), (b, _)| (*a != worst_at).cmp(&(*b != worst_at)).then(a.total_cmp(b)));
    if let Some(seam) = &mut worst.weakest {
        seam.cells = seam.cells.map(|cell| displaced(cell, back));
    }
    Some(Own { worst, on_others: samples.into_iter().map(|(_, loads)| loads).collect() })
}
