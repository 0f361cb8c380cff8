//! The plans that attempts have led to, best first: as many as are wanted, or all that no other beats.
//!
//! Knows which of two plans is better; does not know how they come about.

use std::cmp::Ordering;

use crate::reconfigure::moves::Move;
use crate::reconfigure::options::Options;
use crate::reconfigure::plan::{Objective, Plan};
use crate::reconfigure::trace::Trace;
use crate::robot::Cell;

/// The plans found so far, by one objective.
pub struct Found<'n> {
    objective: Objective,
    /// Most plans that are kept, but for a front.
    wanted: usize,
    /// The cells that a move's motion may need filled or empty.
    needs: &'n dyn Fn(Move) -> Vec<Cell>,
    /// Best first, each with its moves.
    plans: Vec<(Plan, Vec<Move>)>,
}

impl<'n> Found<'n> {
    /// None yet.
    pub fn new(options: &Options, needs: &'n dyn Fn(Move) -> Vec<Cell>) -> Self {
        Self { objective: options.objective, wanted: options.plans.max(1), needs, plans: Vec::new() }
    }

    /// The best one.
    pub fn best(&self) -> Option<&Plan> {
        self.plans.first().map(|(plan, _)| plan)
    }

    /// Takes a plan of these moves in, unless it is one of those known but for the order of independent moves, or not wanted.
    /// Says whether it is the best one now, or part of the front.
    pub fn add(&mut self, plan: Plan, moves: Vec<Move>) -> bool {
        let is_front = self.objective == Objective::Pareto;
        let covers = |one: &Plan, other: &Plan| one.moves <= other.moves && by_margin(one, other).is_ge();
        // Of a front, and where one plan is kept, nothing is there twice anyway; to compare thousands of moves takes long.
        let is_known = |(known, by): &(Plan, Vec<Move>)| match is_front {
            true => covers(known, &plan),
            false => self.wanted > 1 && self.is_same(by, &moves),
        };
        if self.plans.iter().any(is_known) {
            return false;
        }
        if is_front {
            self.plans.retain(|(known, _)| !covers(&plan, known));
        }
        let at = self.plans.partition_point(|(known, _)| self.compared(known, &plan).is_ge());
        self.plans.insert(at, (plan, moves));
        if !is_front {
            self.plans.truncate(self.wanted);
        }
        is_front || at == 0
    }

    /// Whether there are as many as are wanted; of a front that is never known.
    pub fn is_enough(&self) -> bool {
        self.objective != Objective::Pareto && self.plans.len() >= self.wanted
    }

    /// The best one, and the others.
    pub fn into_plans(self) -> (Option<Plan>, Vec<Plan>) {
        let mut plans = self.plans.into_iter().map(|(plan, _)| plan);
        (plans.next(), plans.collect())
    }

    fn compared(&self, one: &Plan, other: &Plan) -> Ordering {
        let by_moves = other.moves.cmp(&one.moves);
        match self.objective {
            Objective::Moves => by_moves.then(by_margin(one, other)),
            Objective::Margin | Objective::Pareto => by_margin(one, other).then(by_moves),
        }
    }

    fn is_same(&self, one: &[Move], other: &[Move]) -> bool {
        let trace = |moves: &[Move]| Trace::new(moves.iter().copied(), self.needs);
        one.len() == other.len() && (one == other || trace(one) == trace(other))
    }
}

fn by_margin(one: &Plan, other: &Plan) -> Ordering {
    let margin = |plan: &Plan| plan.margin.map_or(f64::INFINITY, |margin| margin.lower);
    margin(one).total_cmp(&margin(other))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::robot::Motion;
    use crate::statics::Bracket;

    /// Slides along x from cells that are far from each other, where independent moves may change places.
    fn slides(at: &[i32]) -> Vec<Move> {
        at.iter()
            .map(|&y| Move { from: [0, 9 * y, 0], motion: Motion::Translation { by: [1, 0, 0] }, kind: 0 })
            .collect()
    }

    fn found(objective: Objective, plans: usize, all: &[(f64, &[i32])]) -> (Vec<(f64, u32)>, Vec<bool>) {
        let options = Options { objective, plans, ..Options::default() };
        let mut found = Found::new(&options, &|_| Vec::new());
        let add = |&(margin, at): &(f64, &[i32])| {
            let plan = Plan { margin: Some(Bracket::new(margin, 1.0)), moves: at.len() as u32, ..Plan::EMPTY };
            found.add(plan, slides(at))
        };
        let told = all.iter().map(add).collect();
        let (best, others) = found.into_plans();
        (best.iter().chain(&others).map(|plan| (plan.margin.unwrap().lower, plan.moves)).collect(), told)
    }

    #[test]
    fn the_best_are_kept_in_order() {
        let all: [(f64, &[i32]); 4] = [(0.2, &[1, 2]), (0.5, &[1, 2, 3]), (0.1, &[1]), (0.5, &[4, 5])];
        let (plans, told) = found(Objective::Margin, 3, &all);
        assert_eq!((plans, told), (vec![(0.5, 2), (0.5, 3), (0.2, 2)], vec![true, true, false, true]));
        let (plans, told) = found(Objective::Moves, 2, &all);
        assert_eq!((plans, told), (vec![(0.1, 1), (0.5, 2)], vec![true, false, true, false]));
        assert_eq!(found(Objective::Margin, 0, &all).0, [(0.5, 2)], "none asked for counts as one");
    }

    #[test]
    fn the_order_of_independent_moves_makes_no_other_plan() {
        let all: [(f64, &[i32]); 3] = [(0.2, &[1, 2]), (0.2, &[2, 1]), (0.2, &[2, 3])];
        assert_eq!(found(Objective::Margin, 3, &all).0.len(), 2);
    }

    #[test]
    fn a_front_has_no_plan_that_another_beats() {
        let all: [(f64, &[i32]); 4] = [(0.2, &[1, 2]), (0.5, &[1, 2, 3]), (0.4, &[1, 2, 3, 4]), (0.3, &[4, 5])];
        let (plans, told) = found(Objective::Pareto, 1, &all);
        assert_eq!((plans, told), (vec![(0.5, 3), (0.3, 2)], vec![true, true, false, true]));
    }
}
