//! What a group may meet once others are done: which actions must lead to the same state in either order, and which
//! sets of moves under way must be asked about.

use crate::reconfigure::refusal::Refusal;

use super::Because;
use super::asked::Attempt;
use super::family::{BecauseOf, Family, Kind};
use super::growth::Growth;
use super::precedence::Set;

/// The group to wait for and why; no group where all earlier ones are done.
type Waits<F> = (Option<usize>, BecauseOf<F>);

impl<F: Family> Growth<'_, F> {
    /// Checks what a group may do once `done` are, while `open` are still to come.
    pub(super) fn meet(
        &mut self,
        group: usize,
        done: &Set,
        open: &[usize],
        attempt: &mut Attempt,
    ) -> Result<Result<(), Waits<F>>, Refusal> {
        let from = self.states[done].clone();
        let after = match self.take(group, &from) {
            Ok(after) => after,
            Err(because) => return Ok(Err((open.last().copied(), because))),
        };
        let mut with = done.clone();
        with[group] = true;
        for &other in open {
            let mut both = with.clone();
            both[other] = true;
            let in_other_order = self.take(other, &after);
            let wrong = match &in_other_order {
                Err(because) => Some(because.clone()),
                Ok(state) => self.family.difference(state, &self.states[&both]),
            };
            if let Some(because) = wrong {
                return Ok(Err((Some(other), because)));
            }
        }
        self.states.insert(with.clone(), after.clone());

        // What is being released is worst when all of it is open, what is being attached when nothing is.
        let kind = self.groups[group].kind;
        let releases = open.iter().any(|&other| self.groups[other].kind == Kind::Detach);
        let moves: Vec<usize> = open.iter().copied().filter(|&other| self.groups[other].is_move()).collect();
        for under_way in subsets(&moves, self.options.most_at_once) {
            let latest = under_way.last().copied();
            let ask = |growth: &mut Self, state: &F::State, moving: &[usize], attempt: &mut Attempt| {
                let answer = growth.asked.ask(&growth.family, &growth.groups, state, moving, attempt)?;
                Ok::<_, Refusal>(answer.map_err(|because| (latest.or(open.last().copied()), because)))
            };
            if kind == Kind::Attach || releases || self.has_attached(&with, &under_way) {
                attempt.by_monotony += 1;
            } else if let Err(waits) = ask(self, &after, &under_way, attempt)? {
                return Ok(Err(waits));
            }
            if kind != Kind::Move {
                continue;
            }
            if under_way.len() == self.options.most_at_once.max(1) {
                return Ok(Err((latest, Because::NotChecked)));
            }
            let together: Vec<usize> = under_way.iter().copied().chain([group]).collect();
            if releases || self.has_attached(done, &together) {
                attempt.by_monotony += 1;
            } else if let Err(waits) = ask(self, &from, &together, attempt)? {
                return Ok(Err(waits));
            }
        }
        Ok(Ok(()))
    }

    /// The state after a group.
    fn take(&self, group: usize, from: &F::State) -> Result<F::State, BecauseOf<F>> {
        let mut state = from.clone();
        for action in &self.groups[group].actions {
            state = self.family.take(&state, action)?;
        }
        Ok(state)
    }

    /// Whether something was attached that need not have been while `under_way` are.
    fn has_attached(&self, done: &Set, under_way: &[usize]) -> bool {
        (0..done.len()).any(|group| {
            self.groups[group].kind == Kind::Attach
                && self.order.is_last(group, done)
                && under_way.iter().all(|&moving| !self.order.waits(moving, group))
        })
    }
}

/// All subsets of at most so many of some numbers, each in their order, smaller ones first.
fn subsets(numbers: &[usize], most: usize) -> Vec<Vec<usize>> {
    let mut found = vec![Vec::new()];
    let mut from = 0;
    for _ in 0..most {
        let until = found.len();
        for at in from..until {
            let larger = numbers.iter().filter(|&&number| found[at].last().is_none_or(|&last| last < number));
            let larger: Vec<Vec<usize>> =
                larger.map(|&number| found[at].iter().copied().chain([number]).collect()).collect();
            found.extend(larger);
        }
        from = until;
    }
    found
}
