//! Whether a goal is out of reach, where the space looks the same from many states: by exhausting classes of states
//! instead of states.

use std::collections::{HashMap, VecDeque};

use crate::budget::Limit;
use crate::graph::{Arrow, End, Glance, START};
use crate::lattice::{Displacement, Lattice, difference, sum};
use crate::outcome::Outcome;
use crate::progress::Pass;
use crate::registry::StateId;
use crate::search::{Bounds, FIRST_SHARE, PathOf, Search, is_wide_enough};
use crate::space::Periodic;

/// What tells classes apart.
#[derive(Clone, Copy, PartialEq, Eq)]
enum By {
    /// [`Periodic::kind`].
    Kind,
    /// [`Periodic::class`].
    Class,
}

/// Ways that turn out not to stand, before nothing is taken for wide enough any more at a glance.
const MISTAKES: u32 = 16;

/// How closely transitions are looked at.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Care {
    /// What a glance does not rule out counts as wide enough.
    Glance,
    /// All are decided.
    Decision,
}

/// Whether there may be a path of some width.
enum Finding {
    /// There is none.
    Apart,
    /// There is one.
    Joined,
    /// There is one, unless it leads through a transition whose width cannot be told from the floor.
    Open,
    /// Not known yet.
    Stopped(Limit),
}

/// What is known of the classes of a space. Memory of what a search has asked.
#[derive(Default)]
pub(crate) struct Classes {
    /// The representative of every state that was asked for, and the displacement from it.
    of: [HashMap<StateId, (StateId, Displacement)>; 2],
    /// The largest floor at which there is known to be a path, though none may have been found.
    pub joined: Option<f64>,
    /// The largest floor at which nothing more can be told.
    open: Option<f64>,
    /// The least floor at which there is no path.
    apart: Option<f64>,
    /// No path is wider, by the transitions that all paths have to take one of.
    width_at_most: Option<f64>,
}

impl Classes {
    /// No path is wider, as far as classes tell.
    pub fn width_at_most(&self) -> f64 {
        self.width_at_most.unwrap_or(f64::INFINITY)
    }

    /// Whether something is to be learnt about a floor.
    fn is_worth_asking(&self, floor: f64) -> bool {
        [self.joined, self.open].into_iter().flatten().all(|known| floor > known)
    }

    /// Approximate memory, in bytes.
    pub fn bytes(&self) -> usize {
        // As in the registry: slots that are free, and a byte of control for each.
        let slots = self.of.iter().map(HashMap::capacity).sum::<usize>() * 8 / 7;
        slots * (size_of::<(StateId, (StateId, Displacement))>() + 1)
    }
}

/// A transition to another class, looked at from one end.
struct Way {
    arrow: Arrow,
    class: StateId,
    /// Where it leads to, measured from where the exploration began.
    at: Displacement,
}

/// How a class is reached.
#[derive(Clone, Copy)]
struct Reached {
    /// One displacement at which it is.
    at: Displacement,
    /// The last transition on the way there, unless the way begins there.
    via: Option<Arrow>,
}

/// All classes that are reached from one end.
struct Explorer {
    end: End,
    reached: HashMap<StateId, Reached>,
    open: VecDeque<Way>,
    asked: u64,
    /// Upper bound on the widths of all transitions that were refused.
    refused: f64,
}

impl Explorer {
    fn new(end: End) -> Self {
        Explorer { end, reached: HashMap::new(), open: VecDeque::new(), asked: 0, refused: f64::NEG_INFINITY }
    }

    fn bytes(&self) -> usize {
        self.open.len() * size_of::<Way>() + self.reached.capacity() * 8 / 7 * (size_of::<(StateId, Reached)>() + 1)
    }
}

/// Explorations from both ends, and the displacements that ways from a class to itself add up to.
struct Exploration {
    by: By,
    care: Care,
    floor: f64,
    sides: [Explorer; 2],
    loops: Lattice,
    /// By how much the first class that both ends reached is displaced, seen from the one and from the other.
    gap: Option<Displacement>,
    /// That class.
    meeting: Option<StateId>,
    /// Whether some transition counted as wide enough although that could not be told.
    is_open: bool,
}

impl Exploration {
    fn new(by: By, care: Care, floor: f64) -> Self {
        let sides = [Explorer::new(End::Start), Explorer::new(End::Goal)];
        Exploration { by, care, floor, sides, loops: Lattice::default(), gap: None, meeting: None, is_open: false }
    }

    fn bytes(&self) -> usize {
        self.sides.iter().map(Explorer::bytes).sum()
    }

    fn refuse(&mut self, end: End, width_at_most: f64) {
        let refused = &mut self.sides[end as usize].refused;
        *refused = refused.max(width_at_most);
    }
}

impl<S: Periodic> Search<'_, S> {
    /// The cheapest path from the start to a goal whose width is at least `floor`, like [`Search::from_both_ends`],
    /// in a space that looks the same from many states.
    ///
    /// Such a space may be endless although its states fall into few classes. Where the goal is out of reach, a
    /// search of the states goes on for ever, but one of the classes ends, and proves it: every path leads through the
    /// classes of its states, along transitions of the same widths. If the goal's class is
    /// not among those that can be reached, there is no path. If it is, what counts is the
    /// displacement: ways from a class back to itself displace by sums of those of the loops in the graph of classes, a lattice,
    /// and the goal is out of reach unless it is displaced by one of them from where the class was first reached. Since every
    /// transition can be taken back, that is exact.
    ///
    /// Classes are explored from both ends, and the search ends with the first that is exhausted. It takes turns with the search
    /// of the states, until it is known that there is a path.
    ///
    /// # Guarantees
    ///
    /// Those of [`Search::from_both_ends`].
    pub fn from_both_ends_by_class(&mut self, floor: f64) -> Outcome<PathOf<S>> {
        let mut share = FIRST_SHARE;
        while self.widest.is_none_or(|width| floor > width) && self.classes.is_worth_asking(floor) {
            if self.classes.apart.is_some_and(|apart| floor >= apart) {
                return Outcome::Impossible;
            }
            self.begin();
            self.monitor.progress.pass = Pass::Widest;
            // Half of what is left is for the search of the states.
            let left = self.pause_at.saturating_sub(self.statistics().expanded);
            let (finding, is_paused) = self.sharing(share.min(left / 2), |search| search.finding(floor));
            match finding {
                Finding::Apart => self.classes.apart = Some(floor),
                Finding::Joined => self.classes.joined = Some(floor),
                Finding::Open => self.classes.open = Some(floor),
                Finding::Stopped(limit) if !is_paused => {
                    let bounds = Bounds { width_at_most: self.graph.cap(), cost_at_least: self.graph.remaining(START) };
                    return self.conclude(None, Some(limit), floor, bounds);
                }
                Finding::Stopped(_) => {
                    let (outcome, is_paused) = self.sharing(share, |search| search.from_both_ends(floor));
                    if !is_paused || self.is_paused {
                        return outcome;
                    }
                    share = share.saturating_mul(2);
                }
            }
        }
        self.from_both_ends(floor)
    }

    /// Whether a path may be as wide as `floor`: coarse classes first, since there are fewer, and at a glance, since most of what
    /// leads nowhere need not be known any better. Only a way that would join the ends is looked at closely, and again
    /// another one as long as it does not stand.
    fn finding(&mut self, floor: f64) -> Finding {
        for (by, care) in [(By::Kind, Care::Glance), (By::Class, Care::Glance), (By::Class, Care::Decision)] {
            let mut mistakes = 0;
            loop {
                let care = if mistakes < MISTAKES { care } else { Care::Decision };
                let mut all = Exploration::new(by, care, floor);
                let finding = self.explore(&mut all);
                if !matches!(finding, Finding::Joined | Finding::Open) {
                    return finding;
                }
                if by == By::Class && !all.is_open {
                    return finding;
                }
                if self.stands(&all) {
                    break;
                }
                mistakes += 1;
            }
        }
        Finding::Open
    }

    /// Whether all transitions on the ways to the class in which the ends met may be wide enough, decided.
    fn stands(&mut self, all: &Exploration) -> bool {
        let mut stands = true;
        for side in &all.sides {
            let mut class = all.meeting;
            while let Some(arrow) = class.and_then(|class| side.reached.get(&class)).and_then(|reached| reached.via) {
                stands &= is_wide_enough(self.graph.decide(side.end, arrow, all.floor).upper, all.floor);
                class = Some(arrow.from);
            }
        }
        stands
    }

    /// Whether a transition counts as wide enough: it does where that cannot be told.
    fn passes(&mut self, all: &mut Exploration, end: End, arrow: Arrow) -> bool {
        if all.care == Care::Decision {
            self.graph.decide(end, arrow, all.floor);
        }
        match self.graph.glance(end, arrow, all.floor) {
            Glance::Wide => true,
            Glance::Presumed | Glance::Undecided => {
                all.is_open = true;
                true
            }
            Glance::Narrow => {
                all.refuse(end, self.graph.edge_seen_from(end, arrow).width.upper);
                false
            }
        }
    }

    fn explore(&mut self, all: &mut Exploration) -> Finding {
        if self.graph.is_goal(START) {
            return Finding::Joined;
        }
        let (by, floor) = (all.by, all.floor);
        let (class, at) = self.class_of(by, START);
        self.reach(all, End::Start, class, Reached { at, via: None });
        // Every way to a goal is a root of its own: what leads from one to another counts as a loop, which claims no less
        // than there is.
        let goals: Vec<StateId> = self.graph.space().goals().into_iter().map(|goal| self.graph.intern(goal)).collect();
        for goal in goals {
            self.graph.expand_into(goal);
            for index in 0..self.graph.seen_from(End::Goal, goal).len() {
                let arrow = Arrow { from: goal, index: index as u32 };
                let last = self.graph.edge_seen_from(End::Goal, arrow).to;
                if !self.graph.is_goal(last) && is_wide_enough(self.graph.decide(End::Goal, arrow, floor).upper, floor)
                {
                    let (class, at) = self.class_of(by, last);
                    self.reach(all, End::Goal, class, Reached { at, via: None });
                }
            }
        }
        loop {
            if all.gap.is_some_and(|gap| all.loops.contains(gap)) {
                return if all.is_open { Finding::Open } else { Finding::Joined };
            }
            let [start, goal] = &mut all.sides;
            if let Some(exhausted) = [&*start, &*goal].into_iter().find(|side| side.open.is_empty()) {
                // Every path takes one of the transitions that were refused to it.
                let known = self.classes.width_at_most();
                self.classes.width_at_most = Some(exhausted.refused.min(known));
                return Finding::Apart;
            }
            let side = if start.asked <= goal.asked { start } else { goal };
            let end = side.end;
            let Way { arrow, class, at } = side.open.pop_front().expect("neither side is exhausted");
            // A loop that adds nothing is not asked for.
            if side.reached.get(&class).is_some_and(|known| all.loops.contains(difference(at, known.at))) {
                continue;
            }
            side.asked += 1;
            if let Some(limit) = self.tick(all.bytes()) {
                return Finding::Stopped(limit);
            }
            if self.passes(all, end, arrow) {
                self.reach(all, end, class, Reached { at, via: Some(arrow) });
            }
        }
    }

    /// Books that a class is reached at some displacement, and opens the ways on from it if it is new.
    fn reach(&mut self, all: &mut Exploration, end: End, class: StateId, reached: Reached) {
        let at = reached.at;
        if let Some(known) = all.sides[end as usize].reached.get(&class) {
            all.loops.insert(difference(at, known.at));
            return;
        }
        all.sides[end as usize].reached.insert(class, reached);
        if let Some(other) = all.sides[end.other() as usize].reached.get(&class) {
            let gap = difference(at, other.at);
            let gap = if end == End::Start { gap } else { gap.map(|c| -c) };
            let first = *all.gap.get_or_insert(gap);
            all.meeting.get_or_insert(class);
            all.loops.insert(difference(gap, first));
        }
        // Explorations begin anew again and again: what is known already is no work.
        if !self.graph.is_expanded(end, class) {
            self.monitor.progress.statistics.expanded += 1;
        }
        match end {
            End::Start => self.graph.expand(class),
            End::Goal => self.graph.expand_into(class),
        }
        for index in 0..self.graph.seen_from(end, class).len() {
            let arrow = Arrow { from: class, index: index as u32 };
            let edge = self.graph.edge_seen_from(end, arrow);
            let far = edge.to;
            if self.graph.is_goal(far) {
                continue;
            }
            if !is_wide_enough(edge.width.upper, all.floor) {
                all.refuse(end, edge.width.upper);
            } else {
                let (class, by) = self.class_of(all.by, far);
                all.sides[end as usize].open.push_back(Way { arrow, class, at: sum(at, by) });
            }
        }
    }

    /// The representative of a state's class, and the displacement from it.
    fn class_of(&mut self, by: By, id: StateId) -> (StateId, Displacement) {
        if let Some(&known) = self.classes.of[by as usize].get(&id) {
            return known;
        }
        let state = self.graph.state(id);
        let (representative, displacement) = match by {
            By::Kind => (self.graph.space().kind(state), [0; 3]),
            By::Class => self.graph.space().class(state),
        };
        let class = (self.graph.intern(representative), displacement);
        self.classes.of[by as usize].insert(id, class);
        class
    }
}
