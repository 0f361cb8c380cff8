//! Tells the caller of a search what is new, as events whose bounds only get tighter.
//!
//! Knows what the engines report; does not know what they do.

use planners::{Pass, Progress};

use super::options::{Event, Known, News};
use super::plan::Plan;

/// Keeps what is known, and tells it.
pub struct Herald<'a, A, C> {
    on_event: &'a mut dyn FnMut(&Event<A, C>),
    known: Known,
}

impl<'a, A, C> Herald<'a, A, C> {
    /// Nothing is known yet.
    pub fn new(on_event: &'a mut dyn FnMut(&Event<A, C>)) -> Self {
        Self { on_event, known: Known::NOTHING }
    }

    /// What an engine reports. Each pass is about fewer paths than the one before it, so that what was proved stays.
    pub fn progress(&mut self, progress: &Progress, oracle_solves: u64) {
        let before = self.known;
        self.known = Known { pass: progress.pass, statistics: progress.statistics, oracle_solves, ..before };
        // Bounds of a ranking are about the plans that are still to be found.
        if progress.pass != Pass::KBest {
            self.known.margin_at_most = before.margin_at_most.min(progress.width_at_most);
            // A search for a wider path proves nothing about those as wide as the one in hand.
            let moves = progress.cost_at_least.min(before.moves.unwrap_or(u32::MAX));
            self.known.moves_at_least = before.moves_at_least.max(moves);
        }
        // When nothing is left to be found, "none has fewer than any number" is no news.
        if self.known.moves_at_least == u32::MAX {
            self.known.moves_at_least = before.moves_at_least;
        }
        let is_tighter =
            self.known.margin_at_most < before.margin_at_most || self.known.moves_at_least > before.moves_at_least;
        self.tell(if is_tighter { News::Bound } else { News::Progress });
    }

    /// A better plan.
    pub fn plan(&mut self, plan: Plan<A, C>, oracle_solves: u64) {
        self.known.margin = plan.margin.map(|margin| margin.lower);
        self.known.moves = Some(plan.moves);
        self.known.oracle_solves = oracle_solves;
        self.tell(News::Plan(plan));
    }

    fn tell(&mut self, news: News<A, C>) {
        (self.on_event)(&Event { news, known: self.known });
    }
}
