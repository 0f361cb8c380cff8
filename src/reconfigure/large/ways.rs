//! What a move of one module needs of those around it, found once for all places that look alike.
//!
//! Knows the moving module and what holds it; what the others carry is asked elsewhere.

use std::collections::HashMap;
use std::sync::atomic::AtomicU64;
use std::sync::{Arc, Mutex};

use crate::reconfigure::assembly::{Engagement, Transient};
use crate::reconfigure::course::{Course, engagement};
use crate::reconfigure::domain::Domain;
use crate::reconfigure::hanging::{Grip, Reach, best_grip};
use crate::reconfigure::layout::{Bond, Layout, Placed, displaced};
use crate::reconfigure::moves::Move;
use crate::reconfigure::sampling;
use crate::reconfigure::worst::{Instant, Worst, of_course};
use crate::robot::{Cell, Configuration, Module, Occupancy, Placement};
use crate::spatial::Vec3;
use crate::statics::Bracket;

/// What is needed to take a move while the moving module hangs on one other at a time.
#[derive(Clone, Debug)]
pub struct Way {
    /// Margin of what holds the module, from the connections before the move to those after it.
    pub margin: Bracket,
    /// Phase at which it is attained, 1 at rest after the move, 0 at rest before it.
    pub phase: f64,
    /// The cell of the module that holds it then, from the cell that the move leaves.
    pub weakest: Cell,
    /// Where the module's weight acts on which modules, from the cell that the move leaves.
    pub reaches: Vec<(Cell, Reach)>,
}

/// Where a move begins, up to a displacement: the move, the class, and the modules around with their types.
type Key = (Move, u16, Vec<(Cell, usize)>);

/// All ways that were met so far.
pub struct Ways<'a> {
    domain: &'a Domain<'a>,
    known: HashMap<Key, Option<Arc<Way>>>,
}

impl<'a> Ways<'a> {
    /// For the moves of a domain.
    pub fn new(domain: &'a Domain<'a>) -> Self {
        Self { domain, known: HashMap::new() }
    }

    /// What a fitting move of a module of some class over `rest` needs; `None` where no single
    /// module holds it at some moment.
    pub fn of(&mut self, rest: &Layout, class: u16, step: Move) -> Option<Arc<Way>> {
        let back = step.from.map(|c| -c);
        let bonds = [step.departure(rest), step.landing(rest)].concat();
        let ends = [step.from, step.to()];
        let ends = bonds.iter().flat_map(|bond| bond.cells()).filter(|cell| !ends.contains(cell));
        let mut around: Vec<(Cell, usize)> = step
            .sides()
            .into_iter()
            .map(|(cell, _)| cell)
            .chain(ends)
            .filter_map(|cell| {
                let holder = rest.placed()[rest.at(cell)?].class;
                Some((displaced(cell, back), self.domain.problem.class(holder).module_type))
            })
            .collect();
        around.sort_unstable();
        around.dedup();
        let key = (Move { from: [0; 3], ..step }, class, around);
        if let Some(known) = self.known.get(&key) {
            return known.clone();
        }
        let way = self.find(&key).map(Arc::new);
        self.known.insert(key, way.clone());
        way
    }

    /// The largest margin of a way met so far that is below another.
    pub fn largest_margin_below(&self, margin: f64) -> Option<f64> {
        let margins = self.known.values().flatten().map(|way| way.margin.lower);
        margins.filter(|&own| own < margin).max_by(f64::total_cmp)
    }

    fn find(&self, (step, class, around): &Key) -> Option<Way> {
        let step = *step;
        let start = self.domain.problem.start();
        let of =
            |module_type| Module { id: String::new(), module_type, placement: Placement::new([0; 3]), fixed: false };
        let own = self.domain.problem.class(*class);
        let modules = std::iter::once(own.module_type).chain(around.iter().map(|(_, module_type)| *module_type));
        let few = Configuration {
            modules: modules.map(of).collect(),
            connections: Vec::new(),
            loads: Vec::new(),
            ..start.clone()
        };
        if !own.loads.is_empty() {
            return None;
        }
        let cells: Vec<Cell> = std::iter::once([0; 3]).chain(around.iter().map(|(cell, _)| *cell)).collect();
        let found = Found::new(&few, &cells);

        let before = found.at_rest(&cells, &step.departure(&layout(&cells)), 0.0)?;
        let mut after = cells.clone();
        after[0] = step.to();
        let after = found.at_rest(&after, &step.landing(&layout(&cells)), 1.0)?;
        let placements: Vec<Placement> = cells.iter().map(|&cell| Placement::new(cell)).collect();
        let course = Course::new(placements, &[], step, few.pitch())?;
        let ask = |phase: f64| found.ask(&course.at(phase), Instant::Phase(phase));
        let asked = AtomicU64::new(0);
        let worst = of_course(sampling::of(step), &ask, f64::NEG_INFINITY, &asked).ok()?;
        let worst = worst.or_worse(before).or_worse(after);
        let Instant::Phase(phase) = worst.instant else { return None };
        let reaches = found.reaches.into_inner().expect("no thread panics while it adds");
        let reaches = cells.iter().zip(reaches).filter_map(|(&cell, reach)| Some((cell, reach?))).collect();
        Some(Way { margin: worst.margin, phase, weakest: cells[worst.weakest?], reaches })
    }
}

/// Grips on the first of a few modules, and how far its weight reaches on the others.
struct Found<'c> {
    few: &'c Configuration,
    reaches: Mutex<Vec<Option<Reach>>>,
}

impl<'c> Found<'c> {
    fn new(few: &'c Configuration, cells: &[Cell]) -> Self {
        Self { few, reaches: Mutex::new(vec![None; cells.len()]) }
    }

    fn ask(&self, state: &Transient, instant: Instant) -> Worst<usize> {
        let Some(Grip { support, utilisation, weight_at }) = best_grip(self.few, state, 0) else {
            return Worst { margin: Bracket::exact(f64::NEG_INFINITY), instant, weakest: None };
        };
        let mut reaches = self.reaches.lock().expect("no thread panics while it adds");
        let reach = Reach::point(weight_at);
        reaches[support] = Some(reaches[support].map_or(reach, |known| known.joined(reach)));
        let margin = Bracket::new(1.0 - utilisation.upper, 1.0 - utilisation.lower);
        Worst { margin, instant, weakest: Some(support) }
    }

    /// At rest in these cells, with these connections.
    fn at_rest(&self, cells: &[Cell], bonds: &[Bond], phase: f64) -> Option<Worst<usize>> {
        let placements: Vec<Placement> = cells.iter().map(|&cell| Placement::new(cell)).collect();
        let occupancy = Occupancy::of_placements(&placements);
        let engaged: Vec<Engagement> = bonds.iter().filter_map(|&bond| engagement(&occupancy, bond)).collect();
        let state = Transient { placements: &placements, moving: None, engaged: &engaged };
        let worst = self.ask(&state, Instant::Phase(phase));
        worst.weakest.is_some().then_some(worst)
    }
}

fn layout(cells: &[Cell]) -> Layout {
    let placed = |&cell: &Cell| Placed { cell, class: 0, orientation: crate::robot::Orientation::IDENTITY };
    Layout::new(cells.iter().map(placed).collect())
}

/// How far a cell is from another, in m.
pub fn shift(cell: Cell, pitch: f64) -> Vec3 {
    Vec3::from(cell.map(f64::from)) * pitch
}
