//! Widest path: lazy best-first search with the max-min algebra.

use crate::algebra::{Additive, Bottleneck, PathValue};
use crate::brackets::Brackets;
use crate::budget::Limit;
use crate::graph::{Arrow, DEAD_END, START};
use crate::outcome::Outcome;
use crate::progress::Pass;
use crate::queue::Queue;
use crate::registry::StateId;
use crate::search::{Bounds, PathOf, Search, is_wide_enough};
use crate::space::Space;
use crate::tree::Tree;

/// Wider first, then nearer to a goal.
type Priority = (Bottleneck, Additive);

/// A way to a state that ends with a transition.
#[derive(Clone, Copy)]
struct Way {
    arrow: Arrow,
    to: StateId,
    /// Whether the width in the priority is that of certified transitions only.
    certified: bool,
}

/// How the search for the widest path ended.
pub(crate) struct WidestRun {
    /// The widest certified path found.
    pub best: Option<Vec<Arrow>>,
    /// What ended the search before a proof.
    pub limit: Option<Limit>,
    /// No path is wider.
    pub width_at_most: f64,
}

impl<S: Space> Search<'_, S> {
    /// The widest path from the start to a goal, among those whose width is at
    /// least `floor` (`NEG_INFINITY` for any).
    ///
    /// # Guarantees
    ///
    /// - `Solved`: the path's certified width is at least `floor`, and no path
    ///   is wider than `width_at_most`, which exceeds it by no more than the
    ///   [tolerance](crate::Options::tolerance). Among paths of one width the
    ///   choice is deterministic, but not the cheapest: see [`Search::margin`].
    /// - `Impossible`: every path from the start to a goal has a transition
    ///   whose width is proved to be less than `floor`, or `NEG_INFINITY`.
    /// - `OutOfBudget`: `best` is the widest path certified so far, and no path is
    ///   wider than `width_at_most`.
    /// - A transition is certified only when no other way that is still open
    ///   could be wider than its bound makes it, at most once.
    pub fn widest(&mut self, floor: f64) -> Outcome<PathOf<S>> {
        self.begin();
        let run = self.run_widest(floor);
        let best = run.best.map(|arrows| self.path(&arrows));
        let bounds = Bounds { width_at_most: run.width_at_most, cost_at_least: self.graph.remaining(START) };
        self.conclude(best, run.limit, floor, bounds)
    }

    /// The search; finding nothing without a limit is a proof of impossibility.
    pub(crate) fn run_widest(&mut self, floor: f64) -> WidestRun {
        self.monitor.progress.pass = Pass::Widest;
        let cap = self.graph.cap();
        let mut engine =
            Widest { floor, tree: Tree::new(), open: Queue::new(), brackets: Brackets::new(cap), best: None, cap };
        let run = engine.run(self);
        self.book(engine.bytes());
        self.monitor.report();
        run
    }
}

/// State of one search.
struct Widest {
    floor: f64,
    /// Closed states with their widths.
    tree: Tree<Bottleneck>,
    open: Queue<Priority, Way>,
    brackets: Brackets,
    /// Widest certified way to a goal.
    best: Option<(Bottleneck, Arrow)>,
    /// No path is wider.
    cap: f64,
}

impl Widest {
    fn run<S: Space>(&mut self, search: &mut Search<'_, S>) -> WidestRun {
        self.tree.settle(START, Bottleneck::IDENTITY, None);
        if search.graph.is_goal(START) {
            let best = Some(Vec::new());
            return WidestRun { best, limit: None, width_at_most: f64::INFINITY };
        }
        if search.graph.remaining(START) != DEAD_END {
            self.expand(search, START);
        }

        while let Some(mut head) = self.open.pop() {
            let Way { arrow, to, certified } = head.item;
            if self.tree.value(to).is_some() {
                continue;
            }
            let (mut value, near) = head.priority;
            search.monitor.progress.width_at_most = self.brackets.width_at_most(value.width());
            if let Some(limit) = search.tick(self.bytes()) {
                return self.end(search, value.width(), Some(limit));
            }
            let is_goal = search.graph.is_goal(to);
            if !certified {
                value = self.certify(search, arrow);
                if !self.is_wide_enough(value) {
                    continue;
                }
                if is_goal && self.best.is_none_or(|(best, _)| value > best) {
                    self.best = Some((value, arrow));
                    search.monitor.progress.best_width = Some(value.width());
                }
                head.priority = (value, near);
                head.item.certified = true;
                if self.open.peek().is_some_and(|next| *next > head) {
                    self.open.reinsert(head);
                    continue;
                }
            }
            if is_goal {
                return self.end(search, value.width(), None);
            }
            self.tree.settle(to, value, Some(arrow));
            self.expand(search, to);
        }
        self.end(search, self.floor.next_down(), None)
    }

    /// Value of a way with its last transition certified.
    fn certify<S: Space>(&mut self, search: &mut Search<'_, S>, arrow: Arrow) -> Bottleneck {
        // What is narrower than the best way so far need not be known exactly.
        let floor = self.best.map_or(self.floor, |(best, _)| search.tie(best.width()).max(self.floor));
        let width = search.graph.certify(arrow, floor);
        self.brackets.insert(width);
        self.value(arrow.from).then(Bottleneck::new(width.lower))
    }

    /// Opens all ways on from a closed state.
    fn expand<S: Space>(&mut self, search: &mut Search<'_, S>, from: StateId) {
        search.monitor.progress.statistics.expanded += 1;
        let value = self.value(from).min(Bottleneck::new(self.cap));
        search.graph.expand(from);
        for (index, edge) in search.graph.successors(from).iter().enumerate() {
            let (to, value) = (edge.to, value.then(Bottleneck::new(edge.width.upper)));
            let remaining = search.graph.remaining(to);
            if remaining != DEAD_END && self.tree.value(to).is_none() && self.is_wide_enough(value) {
                let arrow = Arrow { from, index: index as u32 };
                self.open.push((value, Additive(remaining)), Way { arrow, to, certified: false });
            }
        }
    }

    /// What is proved when the best value still open is `k`.
    fn end<S: Space>(&mut self, search: &mut Search<'_, S>, k: f64, limit: Option<Limit>) -> WidestRun {
        let width_at_most = self.brackets.width_at_most(k);
        search.monitor.progress.width_at_most = width_at_most;
        let proved = match self.best {
            Some((best, _)) => best.width() >= search.tie(width_at_most),
            None => !self.is_wide_enough(Bottleneck::new(width_at_most)),
        };
        let best = self.best.map(|(_, last)| {
            let mut arrows = self.tree.way_to(last.from);
            arrows.push(last);
            arrows
        });
        let limit = if proved { None } else { limit.or(Some(Limit::Precision)) };
        WidestRun { best, limit, width_at_most }
    }

    fn value(&self, closed: StateId) -> Bottleneck {
        self.tree.value(closed).expect("open ways leave closed states")
    }

    fn is_wide_enough(&self, value: Bottleneck) -> bool {
        is_wide_enough(value.width(), self.floor)
    }

    fn bytes(&self) -> usize {
        self.open.bytes() + self.tree.bytes() + self.brackets.bytes()
    }
}
