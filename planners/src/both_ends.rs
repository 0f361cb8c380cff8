//! Shortest path of a required width from both ends at once: lazy bidirectional A*.

use std::collections::BTreeMap;

use crate::algebra::Additive;
use crate::budget::Limit;
use crate::graph::{Arrow, DEAD_END, End, Glance, START};
use crate::outcome::{Outcome, Path};
use crate::progress::Pass;
use crate::queue::Queue;
use crate::registry::StateId;
use crate::search::{Bounds, PathOf, Search, is_wide_enough};
use crate::shortest::MISTAKES;
use crate::space::{Reversible, Width};
use crate::tree::Tree;

/// Estimated cost of the whole path, then (later is better) the cost so far.
type Priority = (Additive, u32);

/// A transition between a state that a side has settled and one that it may settle next.
#[derive(Clone, Copy)]
struct Way {
    arrow: Arrow,
    far: StateId,
}

/// A transition between a state that is settled from one end and one that is settled from the other.
#[derive(Clone, Copy)]
struct Bridge {
    /// The end that its arrow is seen from.
    end: End,
    arrow: Arrow,
    far: StateId,
}

/// What one side has done.
struct Side {
    labels: Tree<Additive>,
    open: Queue<Priority, Way>,
    /// How many open ways there are by their cost so far.
    costs: BTreeMap<u32, usize>,
    /// Ways opened so far.
    opened: usize,
}

/// Both sides and what joins them.
struct Both {
    floor: f64,
    /// Whether what a glance does not rule out counts as wide enough.
    is_trusting: bool,
    sides: [Side; 2],
    bridges: Queue<Additive, Bridge>,
    /// Least cost that a path may have through a transition whose interval holds the floor.
    undecided: u32,
    /// The largest width that such a path may have.
    undecided_width: f64,
}

/// How a search ended.
struct Run<P> {
    best: Option<P>,
    limit: Option<Limit>,
    cost_at_least: u32,
    /// If nothing was found: no path is wider.
    width_at_most: f64,
}

impl<S: Reversible> Search<'_, S> {
    /// The cheapest path from the start to a goal whose width is at least `floor`, like
    /// [`Search::shortest`] but searched from both ends: two searches of half the depth are smaller than one where
    /// estimates of the remaining cost tell little, and where only one end lies in the open, the other is soon
    /// exhausted, which proves that there is no path.
    ///
    /// Each side is an A* of its own with its own estimates, opened again where those are inconsistent, and
    /// the one that has opened fewer ways goes on. Transitions that a [glance](crate::Space::glance) does not rule out are taken for wide enough
    /// until a path leads through them; where one of its transitions is not, the search begins anew, knowing that. A path that is not found yet costs at least what either side estimates, and
    /// at least the sum of what the two have spent until they meet.
    ///
    /// # Guarantees
    ///
    /// Those of [`Search::shortest`]. A transition is certified only when no other that is still open, from its
    /// side, is estimated to lead to a goal as cheaply, or when it joins the two sides. If nothing is found, the
    /// proof's `width_at_most` takes all that was searched into account.
    pub fn from_both_ends(&mut self, floor: f64) -> Outcome<PathOf<S>> {
        self.begin();
        self.monitor.progress.pass = Pass::Shortest;
        let mut mistakes = 0;
        let Run { best, limit, cost_at_least, width_at_most } = loop {
            match self.search_from_both_ends(floor, mistakes < MISTAKES) {
                Some(run) => break run,
                None => mistakes += 1,
            }
        };
        self.monitor.progress.best_cost = best.as_ref().map(|path| path.cost);
        self.monitor.report();
        let found = best.as_ref().map(|path| path.width.lower.max(self.graph.cap()));
        let bounds = Bounds { width_at_most: found.unwrap_or(width_at_most), cost_at_least };
        self.conclude(best, limit, floor, bounds)
    }

    /// The search; `None` where a path did not stand when it was looked at closely.
    fn search_from_both_ends(&mut self, floor: f64, is_trusting: bool) -> Option<Run<PathOf<S>>> {
        let cap = self.graph.cap();
        let goals: Vec<StateId> = self.graph.space().goals().into_iter().map(|goal| self.graph.intern(goal)).collect();
        if goals.contains(&START) {
            let best = Some(Path::new(Vec::new()));
            return Some(Run { best, limit: None, cost_at_least: 0, width_at_most: cap });
        }
        let mut both = Both::new(floor, is_trusting);
        both.side(End::Start).labels.settle(START, Additive(0), None);
        for &goal in &goals {
            both.side(End::Goal).labels.settle(goal, Additive(0), None);
        }
        self.open(&mut both, End::Start, START);
        for goal in goals {
            self.open(&mut both, End::Goal, goal);
        }

        let mut proved = 0;
        loop {
            let unseen = both.unseen();
            let bridge = both.bridges.peek().map_or(u32::MAX, |head| head.priority.0);
            // With inconsistent estimates the bound may fall; what was proved stays.
            proved = unseen.min(bridge).min(both.undecided).max(proved);
            if unseen == u32::MAX && bridge == u32::MAX {
                let limit = (both.undecided < u32::MAX).then_some(Limit::Precision);
                let width_at_most = both.undecided_width.max(floor.next_down()).min(cap);
                return Some(Run { best: None, limit, cost_at_least: both.undecided, width_at_most });
            }
            self.monitor.progress.cost_at_least = self.monitor.progress.cost_at_least.max(proved);
            if let Some(limit) = self.tick(both.bytes()) {
                return Some(Run { best: None, limit: Some(limit), cost_at_least: proved, width_at_most: cap });
            }
            if bridge <= unseen {
                let Bridge { end, arrow, far } = both.bridges.pop().expect("it was seen").item;
                let width = self.graph.decide(end, arrow, floor);
                if is_wide_enough(width.lower, floor) {
                    let path = self.joined(&both, end, arrow, far)?;
                    let limit = (proved < path.cost).then_some(Limit::Precision);
                    return Some(Run { best: Some(path), limit, cost_at_least: proved, width_at_most: cap });
                }
                both.note_undecided(width, bridge);
            } else {
                self.settle_next(&mut both);
            }
        }
    }

    /// Settles the best open state of the side that has opened fewer: a side that is exhausted soon ends the search, and
    /// one that goes on for ever in a corridor does not hold up the other.
    fn settle_next(&mut self, both: &mut Both) {
        let [starts, goals] = [End::Start, End::Goal].map(|end| both.side(end).opened);
        let end = if starts <= goals { End::Start } else { End::Goal };
        let (Additive(estimate), cost, Way { arrow, far }) = both.side(end).pop();
        let is_better = |known: Option<Additive>| known.is_none_or(|known| Additive(cost) > known);
        if !is_better(both.side(end).labels.value(far)) || both.is_finished(end.other(), far) {
            return;
        }
        if !both.is_trusting {
            self.graph.decide(end, arrow, both.floor);
        }
        match self.graph.glance(end, arrow, both.floor) {
            Glance::Wide | Glance::Presumed => {
                both.side(end).labels.settle(far, Additive(cost), Some(arrow));
                self.open(both, end, far);
            }
            Glance::Undecided => both.note_undecided(self.graph.edge_seen_from(end, arrow).width, estimate),
            Glance::Narrow => {}
        }
    }

    /// Opens all ways on from a state whose label on a side has improved.
    fn open(&mut self, both: &mut Both, end: End, near: StateId) {
        self.monitor.progress.statistics.expanded += 1;
        match end {
            End::Start => self.graph.expand(near),
            End::Goal => self.graph.expand_into(near),
        }
        let Additive(so_far) = both.side(end).labels.value(near).expect("it is settled");
        for (index, edge) in self.graph.seen_from(end, near).iter().enumerate() {
            let (arrow, far) = (Arrow { from: near, index: index as u32 }, edge.to);
            let cost = so_far.saturating_add(edge.cost);
            let known = both.side(end).labels.value(far);
            if !is_wide_enough(edge.width.upper, both.floor) || known.is_some_and(|known| known >= Additive(cost)) {
                continue;
            }
            let estimate = match end {
                End::Start => self.graph.remaining(far),
                End::Goal => self.graph.spent(far),
            };
            if estimate == DEAD_END {
                continue;
            }
            if let Some(Additive(rest)) = both.side(end.other()).labels.value(far) {
                both.bridges.push(Additive(cost.saturating_add(rest)), Bridge { end, arrow, far });
            }
            both.side(end).push(cost.saturating_add(estimate), cost, Way { arrow, far });
        }
    }

    /// The path over a bridge, if all of it stands when it is as tight as it can be.
    fn joined(&mut self, both: &Both, end: End, arrow: Arrow, far: StateId) -> Option<PathOf<S>> {
        let (first, last) = if end == End::Start { (arrow.from, far) } else { (far, arrow.from) };
        let [start, goal] = &both.sides;
        let before = start.labels.way_to(first).into_iter().map(|arrow| (End::Start, arrow));
        let after = goal.labels.way_to(last).into_iter().rev().map(|arrow| (End::Goal, arrow));
        let way: Vec<(End, Arrow)> = before.chain([(end, arrow)]).chain(after).collect();
        let are_decided = self.are_decided(&way, both.floor);
        let stands = are_decided && way.iter().all(|&(end, arrow)| self.all_stand(end, &[arrow], both.floor));
        stands.then(|| {
            let path = Path::new(way.iter().map(|&(end, arrow)| self.step(end, arrow)).collect());
            self.found(path)
        })
    }
}

impl End {
    pub fn other(self) -> Self {
        match self {
            End::Start => End::Goal,
            End::Goal => End::Start,
        }
    }
}

impl Side {
    fn new() -> Self {
        Side { labels: Tree::new(), open: Queue::new(), costs: BTreeMap::new(), opened: 0 }
    }

    fn push(&mut self, estimate: u32, cost: u32, way: Way) {
        self.open.push((Additive(estimate), cost), way);
        *self.costs.entry(cost).or_default() += 1;
        self.opened += 1;
    }

    /// Estimate, cost so far and way of the best that is open.
    fn pop(&mut self) -> (Additive, u32, Way) {
        let head = self.open.pop().expect("both sides have open ways");
        let (estimate, cost) = head.priority;
        let count = self.costs.get_mut(&cost).expect("open ways are counted");
        *count -= 1;
        if *count == 0 {
            self.costs.remove(&cost);
        }
        (estimate, cost, head.item)
    }

    /// Least estimate of the ways that are open.
    fn estimate(&self) -> Option<u32> {
        self.open.peek().map(|head| head.priority.0.0)
    }

    /// Least cost until the far end of a way that is open.
    fn cost(&self) -> Option<u32> {
        self.costs.first_key_value().map(|(&cost, _)| cost)
    }
}

impl Both {
    fn new(floor: f64, is_trusting: bool) -> Self {
        let sides = [Side::new(), Side::new()];
        Both {
            floor,
            is_trusting,
            sides,
            bridges: Queue::new(),
            undecided: u32::MAX,
            undecided_width: f64::NEG_INFINITY,
        }
    }

    fn side(&mut self, end: End) -> &mut Side {
        &mut self.sides[end as usize]
    }

    /// Whether a side has the least cost to a state: what is open costs as much already. Then every path through
    /// it from a state that the other side has settled goes over a bridge that is known.
    fn is_finished(&self, end: End, id: StateId) -> bool {
        let side = &self.sides[end as usize];
        side.labels.value(id).is_some_and(|Additive(cost)| side.cost().is_none_or(|open| cost <= open))
    }

    /// Least cost of a path that no bridge is part of yet: on either side one of its transitions is open, each with
    /// all that the side has settled of the path behind it. `u32::MAX` when there is none.
    fn unseen(&self) -> u32 {
        let [start, goal] = &self.sides;
        match (start.estimate(), goal.estimate(), start.cost(), goal.cost()) {
            (Some(a), Some(b), Some(from_start), Some(from_goal)) => a.max(b).max(from_start.saturating_add(from_goal)),
            _ => u32::MAX,
        }
    }

    /// Books a transition that is not proved wide enough: paths over it cost at least `cost`.
    fn note_undecided(&mut self, width: Width, cost: u32) {
        if is_wide_enough(width.upper, self.floor) {
            self.undecided = self.undecided.min(cost);
            self.undecided_width = self.undecided_width.max(width.upper);
        }
    }

    fn bytes(&self) -> usize {
        self.sides.iter().map(|side| side.labels.bytes() + side.open.bytes()).sum::<usize>() + self.bridges.bytes()
    }
}
