//! One attempt: carries one module after another to where it is wanted, at one margin.
//!
//! Knows which module goes where next; does not know which margins are worth trying.

use std::collections::{BTreeMap, BTreeSet, HashSet};

use crate::reconfigure::assembly::Engagement;
use crate::reconfigure::course::engagement;
use crate::reconfigure::domain::Domain;
use crate::reconfigure::hanging::{Reach, Rest, Rests};
use crate::reconfigure::in_the_way::Nearest;
use crate::reconfigure::layout::{Layout, Placed};
use crate::reconfigure::moves::Move;
use crate::robot::{Cell, Occupancy, Placement};

use super::journey::{Direction, Journey};
use super::order::{Lessons, Order, Rank, by_steps};
use super::shape::{Targets, bounds, distances, is_connected, lot, open, surplus, vacant};
use super::walk::{Walk, reaches};
use super::ways::Ways;

/// Cells around start and goal that modules may pass through.
const ROOM: i32 = 4;

/// How often a module looks for another way where the robot does not carry it.
const DETOURS: usize = 6;

/// Places that are tried for one module before the next one is.
const PLACES: usize = 3;

/// Carries that bring no more modules home than before, beside three for each that is not, before it counts as a dead end.
const IDLE: usize = 12;

/// How often the wait of a module that was tried in vain doubles.
const LONGEST: u32 = 6;

/// Carries per module, in all, after which an attempt gives up.
const CARRIES: usize = 32;

/// One module carried from one cell to another.
#[derive(Clone, Debug)]
pub struct Carry {
    /// Its moves, in the order of the plan.
    pub path: Vec<Move>,
    /// What the others carry meanwhile is proved to leave this margin.
    pub margin: f64,
}

/// Is called before every walk that is looked at, with the work done in the attempt so far; says whether to go on.
pub type Watch<'w> = dyn FnMut(u64) -> bool + 'w;

/// How an attempt ended.
#[derive(Clone, Debug)]
pub enum Attempt {
    /// All that is wanted is in place: what the plan carries, in its order.
    Done(Vec<Carry>),
    /// Nothing that was tried leads on.
    Stuck(Nearest),
    /// The caller stopped it.
    Stopped(Nearest),
}

/// Work that it is to look where one module can walk to, in questions about what the others carry.
const WALK: u64 = 4;

/// What a carry changes.
struct Before {
    layout: Layout,
    placements: Vec<Placement>,
    /// Modules that were not in place.
    away: usize,
}

/// A robot on its way to where it is wanted.
pub struct Builder<'a, 'l> {
    domain: &'a Domain<'a>,
    direction: Direction,
    targets: &'a Targets,
    /// Margin that is asked of every state.
    floor: f64,
    order: Order,
    bounds: [Cell; 2],
    layout: Layout,
    /// Where each module of the start is.
    placements: Vec<Placement>,
    carries: Vec<Carry>,
    /// What was so before each carry.
    before: Vec<Before>,
    /// What dead ends taught on this way.
    lessons: &'l mut Lessons,
    /// Empty cells of the goal that are open to the outside, and must stay so until they are filled.
    open: BTreeSet<Cell>,
    /// No layout is met twice.
    met: HashSet<Layout>,
    /// Cells of modules that were tried in vain: how often, and how many carries it takes until others come first no more.
    waiting: BTreeMap<Cell, (u32, usize)>,
    /// Dead ends that are still put up with.
    patience: usize,
    /// Questions that had been asked before, and walks that were looked at since.
    solves_before: u64,
    walks: u64,
    is_stopped: bool,
}

impl<'a, 'l> Builder<'a, 'l> {
    /// Where a journey begins, to give up at dead end number `patience + 1`.
    pub fn new(
        domain: &'a Domain<'a>,
        journey: &'a Journey,
        lessons: &'l mut Lessons,
        (floor, order): (f64, Order),
        patience: usize,
    ) -> Self {
        let Journey { direction, layout, placements, targets } = journey;
        let cells = layout.placed().iter().map(|placed| placed.cell).chain(targets.keys().copied());
        Self {
            domain,
            direction: *direction,
            targets,
            floor,
            order,
            bounds: bounds(cells, ROOM),
            placements: placements.clone(),
            carries: Vec::new(),
            before: Vec::new(),
            lessons,
            open: BTreeSet::new(),
            met: HashSet::from([layout.clone()]),
            waiting: BTreeMap::new(),
            patience,
            solves_before: 0,
            walks: 0,
            is_stopped: false,
            layout: layout.clone(),
        }
    }

    /// Carries modules until all are in place.
    ///
    /// On a dead end all carries are undone back to before the last one that brought a module home, on the next
    /// one to before the last two, then four, and so on. As no layout is met twice, other carries follow, and what was
    /// left empty is filled earlier, what was left full freed earlier.
    pub fn run(mut self, ways: &mut Ways<'a>, rests: &mut Rests<'a>, watch: &mut Watch) -> Attempt {
        self.solves_before = rests.solves();
        let modules = self.layout.placed().len();
        let (mut undo, mut fewest, mut idle) = (1, usize::MAX, 0);
        let mut nearest = self.nearest();
        for _ in 0..CARRIES * modules.max(1) {
            let left = surplus(&self.layout, self.targets);
            if left.is_empty() {
                if self.direction == Direction::Backwards {
                    self.carries.reverse();
                }
                return Attempt::Done(self.carries);
            }
            idle = if left.len() < fewest { 0 } else { idle + 1 };
            fewest = fewest.min(left.len());
            // To wander about without bringing more modules home is a dead end as well.
            if idle <= IDLE + 3 * fewest && self.carry_one(&left, ways, rests, watch) {
                continue;
            }
            if left.len() < nearest.modules - nearest.in_place {
                nearest = self.nearest();
            }
            if self.is_stopped {
                return Attempt::Stopped(nearest);
            }
            if self.carries.is_empty() || self.patience == 0 {
                return Attempt::Stuck(nearest);
            }
            self.patience -= 1;
            self.undo(undo);
            undo = (undo * 2).min(modules);
            (fewest, idle) = (usize::MAX, 0);
        }
        Attempt::Stuck(nearest)
    }

    /// How close the robot is to the goal.
    fn nearest(&self) -> Nearest {
        let left = surplus(&self.layout, self.targets);
        let modules = self.layout.placed().len();
        let stuck = left.iter().filter(|&&mover| self.others_if_free(mover).is_none()).count();
        Nearest { modules, in_place: modules - left.len(), stuck }
    }

    /// All other modules, if this one can leave them.
    fn others_if_free(&self, mover: Placed) -> Option<Layout> {
        let problem = self.domain.problem;
        let class = problem.class(mover.class);
        if class.fixed || !class.loads.is_empty() || class.turns {
            return None;
        }
        let others = self.layout.placed().iter().copied().filter(|placed| placed.cell != mover.cell);
        let others = Layout::new(others.collect());
        let is_free = !self.domain.moves_of(&others, &mover).is_empty()
            && (!problem.must_stay_connected() || is_connected(&others));
        is_free.then_some(others)
    }

    /// Undoes carries back to before the last ones that brought so many modules home, or all.
    fn undo(&mut self, homecomings: usize) {
        self.lessons.note(&self.layout, self.targets);
        self.waiting.clear();
        let mut away = surplus(&self.layout, self.targets).len();
        let most = away + homecomings;
        while away < most
            && let (Some(_), Some(before)) = (self.carries.pop(), self.before.pop())
        {
            (self.layout, self.placements, away) = (before.layout, before.placements, before.away);
        }
    }

    /// Carries one module on: to where one is wanted if that can be; else out of the way of others, or out of a cell
    /// that wants another kind; else closer to where modules are wanted.
    fn carry_one(&mut self, left: &[Placed], ways: &mut Ways<'a>, rests: &mut Rests<'a>, watch: &mut Watch) -> bool {
        let vacant = vacant(&self.layout, self.targets);
        self.open = open(&self.layout, &vacant.keys().copied().collect());
        let is_at_home = |placed: &Placed| self.targets.get(&placed.cell) == Some(&placed.class);
        let mut covers: Vec<Placed> = self.layout.placed().iter().copied().filter(is_at_home).collect();
        let home: Vec<Cell> = covers.iter().map(|placed| placed.cell).collect();
        let to_fill = self.lessons.filling_order(&home, &vacant, self.targets, &self.order);
        let mut movers = self.lessons.freeing_order(&home, left, &self.layout, &self.order);
        movers.sort_by_key(|mover| self.is_waiting(mover.cell));
        if movers.iter().any(|&mover| self.carry(mover, &to_fill, ways, rests, watch)) {
            return true;
        }
        // What is buried, or closed off, comes free by what is nearest to it.
        let buried = left.iter().map(|placed| placed.cell).chain(vacant.keys().copied());
        let nearest = distances(buried, |cell| self.layout.is_filled(cell));
        covers.sort_by_key(|placed| {
            let steps = nearest.get(&placed.cell).copied().unwrap_or(u32::MAX);
            (self.is_waiting(placed.cell), steps, lot(self.order.seed, placed.cell))
        });
        if covers.iter().any(|&cover| self.carry(cover, &to_fill, ways, rests, watch)) {
            return true;
        }
        let strangers = movers.iter().filter(|mover| self.targets.contains_key(&mover.cell));
        let strangers: Vec<Placed> = strangers.copied().collect();
        let aside = if strangers.is_empty() { BTreeMap::new() } else { self.aside() };
        if strangers.iter().any(|&stranger| self.carry(stranger, &aside, ways, rests, watch)) {
            return true;
        }
        let closer = self.closer(&vacant);
        movers.iter().any(|&mover| self.carry(mover, &closer, ways, rests, watch))
            || covers.iter().any(|&cover| self.carry(cover, &closer, ways, rests, watch))
    }

    /// All cells around by how close they are to the empty cells of the goal.
    fn closer(&self, vacant: &BTreeMap<Cell, u16>) -> BTreeMap<Cell, Rank> {
        by_steps(vacant.keys().copied(), self.bounds, &self.order)
    }

    /// All cells around that the goal leaves empty, by how close they are to it: for modules in the cells of others.
    fn aside(&self) -> BTreeMap<Cell, Rank> {
        let mut cells = by_steps(self.targets.keys().copied(), self.bounds, &self.order);
        cells.retain(|cell, _| !self.targets.contains_key(cell));
        cells
    }

    /// Carries a module to the first of the ranked cells that it can be carried to, if that is better than
    /// where it is; `false` if there is none.
    fn carry(
        &mut self,
        mover: Placed,
        ranked: &BTreeMap<Cell, Rank>,
        ways: &mut Ways<'a>,
        rests: &mut Rests<'a>,
        watch: &mut Watch,
    ) -> bool {
        if self.is_stopped {
            return false;
        }
        let Some(rest) = self.others_if_free(mover) else { return false };
        let mut shunned = BTreeSet::new();
        let mut others: Option<Rest> = None;
        let mut places = 0;
        let mut refused = BTreeSet::new();
        for _ in 0..DETOURS {
            self.is_stopped |= !watch(rests.solves() - self.solves_before + WALK * self.walks);
            if self.is_stopped {
                return false;
            }
            self.walks += 1;
            let walk = Walk::new(self.domain, ways, (&rest, mover, self.direction), self.floor, &shunned, self.bounds);
            let reached = walk.reached[1..].iter().copied().filter(|cell| !refused.contains(cell));
            let mut reached: Vec<Cell> = reached.filter(|cell| ranked.contains_key(cell)).collect();
            reached.sort_by_key(|cell| ranked[cell]);
            let Some(to) = reached.into_iter().find(|&cell| self.suits(mover, cell, ranked, &rest)) else { break };
            let path = walk.path(to);
            let pitch = self.domain.problem.start().pitch();
            let reaches = reaches(ways, &rest, mover.class, &path, pitch);
            match self.too_weak(mover, &rest, &mut others, &reaches, rests) {
                Ok(margin) => {
                    self.take(mover, to, path, margin);
                    return true;
                }
                Err(support) => {
                    shunned.insert(support);
                    places += 1;
                    if places % PLACES == 0 {
                        refused.insert(to);
                    }
                }
            }
        }
        self.wait(mover.cell);
        false
    }

    /// Lets others come before the module in a cell, twice as long each time.
    fn wait(&mut self, cell: Cell) {
        if self.is_waiting(cell) {
            return;
        }
        let (times, until) = self.waiting.entry(cell).or_insert((0, 0));
        *until = self.carries.len() + (1 << *times);
        *times = (*times + 1).min(LONGEST);
    }

    /// Whether the module in a cell was tried in vain not long ago.
    fn is_waiting(&self, cell: Cell) -> bool {
        self.waiting.get(&cell).is_some_and(|&(_, until)| self.carries.len() < until)
    }

    /// Whether a module may be put into a cell.
    fn suits(&self, mover: Placed, cell: Cell, ranked: &BTreeMap<Cell, Rank>, rest: &Layout) -> bool {
        let Some(rank) = ranked.get(&cell) else { return false };
        let is_wanted = self.targets.get(&cell) == Some(&mover.class);
        // Where nothing is wanted, only steps ahead count.
        let is_closer = ranked.get(&mover.cell).is_none_or(|own| (rank.0, rank.1) < (own.0, own.1));
        if self.targets.get(&cell).is_some_and(|class| *class != mover.class) || !(is_wanted || is_closer) {
            return false;
        }
        let mut placed = rest.placed().to_vec();
        placed.push(Placed { cell, ..mover });
        let after = Layout::new(placed);
        let wanted: BTreeSet<Cell> = self.open.iter().copied().filter(|&open| open != cell).collect();
        !self.met.contains(&after) && open(&after, &wanted) == wanted
    }

    /// The margin that the others are proved to keep on a walk, or the first module that they do not carry the weight on.
    fn too_weak(
        &self,
        mover: Placed,
        rest: &Layout,
        others: &mut Option<Rest>,
        reaches: &BTreeMap<Cell, Reach>,
        rests: &mut Rests<'a>,
    ) -> Result<f64, Cell> {
        if !self.domain.stability {
            return Ok(f64::INFINITY);
        }
        let occupancy = Occupancy::of_placements(&self.placements);
        let module = occupancy.at(mover.cell).expect("a mover is a module");
        let others = others.get_or_insert_with(|| {
            let engaged: Vec<Engagement> =
                rest.touching().into_iter().filter_map(|bond| engagement(&occupancy, bond)).collect();
            rests.without(module, &self.placements, &engaged)
        });
        let supports: Vec<(usize, Reach)> = reaches
            .iter()
            .map(|(&cell, &reach)| (occupancy.at(cell).expect("what holds a module is there"), reach))
            .collect();
        match rests.utilisations(others, &supports, 1.0 - self.floor) {
            Ok(most) => Ok((1.0 - most.into_iter().fold(0.0, f64::max)).max(self.floor)),
            Err(place) => Err(*reaches.keys().nth(place).expect("one of the supports")),
        }
    }

    fn take(&mut self, mover: Placed, to: Cell, path: Vec<Move>, margin: f64) {
        let away = surplus(&self.layout, self.targets).len();
        self.before.push(Before { layout: self.layout.clone(), placements: self.placements.clone(), away });
        self.layout = self.layout.with_moved(mover.cell, Placed { cell: to, ..mover });
        let moved = self.placements.iter_mut().find(|placement| placement.cell == mover.cell);
        if let Some(placement) = moved {
            placement.cell = to;
            // Backwards it does not matter how modules are turned.
            if self.direction == Direction::Forwards {
                let turned = path.iter().fold(placement.orientation, |turned, step| turned.turned(step.rotation()));
                placement.orientation = turned;
            }
        }
        self.met.insert(self.layout.clone());
        self.waiting.remove(&to);
        self.carries.push(Carry { path, margin });
    }
}
