//! Shortest path of a required width from both ends at once: lazy bidirectional Dijkstra.

use crate::algebra::Additive;
use crate::graph::START;
use crate::outcome::{Outcome, Path, Step};
use crate::progress::Pass;
use crate::queue::Queue;
use crate::registry::StateId;
use crate::search::{Bounds, PathOf, Search, is_wide_enough};
use crate::space::{Reversible, Width};

/// One of the two searches.
#[derive(Clone, Copy, PartialEq, Eq)]
enum End {
    Start,
    Goal,
}

/// A transition between a state that a side has settled and one that it may settle next.
struct Way<A> {
    near: StateId,
    far: StateId,
    action: A,
    cost: u32,
}

/// How a side has reached a state.
struct Label<A> {
    cost: u32,
    /// The state before it, seen from the end that the side began at, and the transition between them.
    via: Option<(StateId, A, u32, Width)>,
}

/// What one side has done.
struct Side<A> {
    labels: Vec<Option<Label<A>>>,
    open: Queue<Additive, Way<A>>,
}

/// A transition from a state that is settled from the start to one that is settled from a goal.
struct Bridge<A> {
    from: StateId,
    to: StateId,
    action: A,
    cost: u32,
}

/// Both sides and what joins them.
struct Both<A> {
    sides: [Side<A>; 2],
    bridges: Queue<Additive, Bridge<A>>,
    /// Least cost that a path may have through a transition whose interval holds the floor.
    undecided: u32,
}

impl<S: Reversible> Search<'_, S> {
    /// The cheapest path from the start to a goal whose width is at least `floor`, like
    /// [`Search::shortest`] but searched from both ends: where a state has many neighbours and none of them is
    /// known to be nearer to the goal, two searches of half the depth are far smaller than one.
    ///
    /// Estimates of the remaining cost play no part.
    ///
    /// # Guarantees
    ///
    /// Those of [`Search::shortest`]. A transition is certified only when no other that is still open, from its
    /// side, leads to a state as cheaply, or when it joins the two sides.
    pub fn from_both_ends(&mut self, floor: f64) -> Outcome<PathOf<S>> {
        self.begin();
        self.monitor.progress.pass = Pass::Shortest;
        let (best, limit, cost_at_least) = self.search_from_both_ends(floor);
        self.monitor.progress.best_cost = best.as_ref().map(|path| path.cost);
        self.monitor.report();
        let width_at_most = best.as_ref().map_or(f64::NEG_INFINITY, |path| path.width.lower).max(self.graph.cap());
        self.conclude(best, limit, floor, Bounds { width_at_most, cost_at_least })
    }

    fn search_from_both_ends(&mut self, floor: f64) -> (Option<PathOf<S>>, Option<crate::Limit>, u32) {
        let goals: Vec<StateId> = self.graph.space().goals().into_iter().map(|goal| self.graph.intern(goal)).collect();
        if goals.contains(&START) {
            return (Some(Path::new(Vec::new())), None, 0);
        }
        let mut both = Both { sides: [Side::new(), Side::new()], bridges: Queue::new(), undecided: u32::MAX };
        both.side(End::Start).settle(START, Label { cost: 0, via: None });
        for &goal in &goals {
            both.side(End::Goal).settle(goal, Label { cost: 0, via: None });
        }
        self.open(&mut both, End::Start, START, floor);
        for goal in goals {
            self.open(&mut both, End::Goal, goal, floor);
        }

        loop {
            let unseen = both.unseen();
            let bridge = both.bridges.peek().map_or(u32::MAX, |head| head.priority.0);
            let cost_at_least = unseen.min(bridge).min(both.undecided);
            if unseen == u32::MAX && bridge == u32::MAX {
                let limit = (both.undecided < u32::MAX).then_some(crate::Limit::Precision);
                return (None, limit, both.undecided);
            }
            self.monitor.progress.cost_at_least = self.monitor.progress.cost_at_least.max(cost_at_least);
            if let Some(limit) = self.tick(both.bytes()) {
                return (None, Some(limit), cost_at_least);
            }
            if bridge <= unseen {
                let head = both.bridges.pop().expect("it was seen");
                let Bridge { from, to, action, cost } = head.item;
                let width = self.certify_between(from, &action, to, floor);
                if is_wide_enough(width.lower, floor) {
                    let path = self.joined(&both, from, (action, cost, width), to);
                    let limit = (cost_at_least < path.cost).then_some(crate::Limit::Precision);
                    return (Some(path), limit, cost_at_least);
                }
                both.note_undecided(width, floor, bridge);
            } else {
                self.settle_next(&mut both, floor);
            }
        }
    }

    /// Settles the nearest open state of the side with fewer open ones.
    fn settle_next(&mut self, both: &mut Both<S::Action>, floor: f64) {
        let [starts, goals] = [End::Start, End::Goal].map(|end| both.side(end).open.bytes());
        let end = if starts <= goals { End::Start } else { End::Goal };
        let head = both.side(end).open.pop().expect("both sides have open states");
        let (Additive(total), Way { near, far, action, cost }) = (head.priority, head.item);
        if both.side(end).label(far).is_some() {
            return;
        }
        let width = match end {
            End::Start => self.certify_between(near, &action, far, floor),
            End::Goal => self.certify_between(far, &action, near, floor),
        };
        if is_wide_enough(width.lower, floor) {
            both.side(end).settle(far, Label { cost: total, via: Some((near, action, cost, width)) });
            self.open(both, end, far, floor);
        } else {
            let rest = both.at_least_to(end.other(), far);
            both.note_undecided(width, floor, total.saturating_add(rest));
        }
    }

    /// Opens all ways on from a state that a side has settled.
    fn open(&mut self, both: &mut Both<S::Action>, end: End, near: StateId, floor: f64) {
        self.monitor.progress.statistics.expanded += 1;
        let state = self.graph.state(near).clone();
        let space = self.graph.space();
        let transitions = match end {
            End::Start => space.transitions(&state),
            End::Goal => space.transitions_into(&state),
        };
        self.graph.generated += transitions.len() as u64;
        let so_far = both.side(end).label(near).expect("it is settled").cost;
        for transition in transitions {
            let far = self.graph.intern(transition.to);
            if !is_wide_enough(transition.width_at_most, floor) || both.side(end).label(far).is_some() {
                continue;
            }
            let (action, cost) = (transition.action, transition.cost);
            let total = so_far.saturating_add(cost);
            if let Some(rest) = both.side(end.other()).label(far).map(|label| label.cost) {
                let (from, to) = if end == End::Start { (near, far) } else { (far, near) };
                both.bridges.push(Additive(total.saturating_add(rest)), Bridge { from, to, action, cost });
            } else {
                both.side(end).open.push(Additive(total), Way { near, far, action, cost });
            }
        }
    }

    fn certify_between(&mut self, from: StateId, action: &S::Action, to: StateId, floor: f64) -> Width {
        self.graph.certified += 1;
        let width = self.graph.space().certify(self.graph.state(from), action, self.graph.state(to), floor);
        crate::graph::trusted(width, f64::INFINITY)
    }

    /// The path over a bridge.
    fn joined(
        &self,
        both: &Both<S::Action>,
        from: StateId,
        (action, cost, width): (S::Action, u32, Width),
        to: StateId,
    ) -> PathOf<S> {
        let step = |action: S::Action, to: StateId, cost: u32, width: Width| Step {
            action,
            to: self.graph.state(to).clone(),
            cost,
            width,
        };
        let mut steps = Vec::new();
        let mut at = from;
        while let Some((before, action, cost, width)) = both.via(End::Start, at) {
            steps.push(step(action.clone(), at, *cost, *width));
            at = *before;
        }
        steps.reverse();
        steps.push(step(action, to, cost, width));
        at = to;
        while let Some((next, action, cost, width)) = both.via(End::Goal, at) {
            steps.push(step(action.clone(), *next, *cost, *width));
            at = *next;
        }
        Path::new(steps)
    }
}

impl End {
    fn other(self) -> Self {
        match self {
            End::Start => End::Goal,
            End::Goal => End::Start,
        }
    }
}

impl<A> Side<A> {
    fn new() -> Self {
        Side { labels: Vec::new(), open: Queue::new() }
    }

    fn label(&self, id: StateId) -> Option<&Label<A>> {
        self.labels.get(id as usize).and_then(Option::as_ref)
    }

    fn settle(&mut self, id: StateId, label: Label<A>) {
        let index = id as usize;
        if self.labels.len() <= index {
            self.labels.resize_with(index + 1, || None);
        }
        self.labels[index] = Some(label);
    }

    fn top(&self) -> Option<u32> {
        self.open.peek().map(|head| head.priority.0)
    }
}

impl<A> Both<A> {
    fn side(&mut self, end: End) -> &mut Side<A> {
        &mut self.sides[end as usize]
    }

    fn via(&self, end: End, id: StateId) -> Option<&(StateId, A, u32, Width)> {
        self.sides[end as usize].label(id).and_then(|label| label.via.as_ref())
    }

    /// Least cost of a path that no bridge is part of yet: it leaves what either side has settled by a way that is
    /// open there. `u32::MAX` when there is none.
    fn unseen(&self) -> u32 {
        match [self.sides[0].top(), self.sides[1].top()] {
            [Some(from_start), Some(from_goal)] => from_start.saturating_add(from_goal),
            _ => u32::MAX,
        }
    }

    /// Lower bound on the cost between a state and the end of a side.
    fn at_least_to(&self, end: End, id: StateId) -> u32 {
        let side = &self.sides[end as usize];
        side.label(id).map_or_else(|| side.top().unwrap_or(0), |label| label.cost)
    }

    /// Books a transition that is not proved wide enough: paths over it cost at least `cost`.
    fn note_undecided(&mut self, width: Width, floor: f64, cost: u32) {
        if is_wide_enough(width.upper, floor) {
            self.undecided = self.undecided.min(cost);
        }
    }

    fn bytes(&self) -> usize {
        let side = |side: &Side<A>| side.labels.len() * size_of::<Option<Label<A>>>() + side.open.bytes();
        self.sides.iter().map(side).sum::<usize>() + self.bridges.bytes()
    }
}
