//! What was asked about states and moves under way, so that nothing is asked twice.
//!
//! Of states that differ in their connections only, one that stands says that those with more of them do, and one
//! that does not that those with fewer do not (statics: monotony).

use std::collections::HashMap;

use crate::reconfigure::refusal::Refusal;
use crate::statics::Bracket;

use super::family::{BecauseOf, Family};
use super::groups::Group;

/// What looking at one group has come to.
pub struct Attempt {
    /// Sets of actions under way of which at least two are moves.
    pub overlaps: u64,
    /// What monotony leaves no need to ask about.
    pub by_monotony: u64,
    /// Smallest margin found.
    pub margin: Bracket,
}

impl Attempt {
    pub fn new() -> Self {
        Self { overlaps: 0, by_monotony: 0, margin: Bracket::new(f64::INFINITY, f64::INFINITY) }
    }
}

/// Where the modules are and which groups are under way.
type Key<F> = (<F as Family>::Place, Vec<usize>);

/// Answers about states that differ in their connections only.
struct Known<F: Family> {
    stood: Vec<(Vec<F::Connection>, Bracket)>,
    failed: Vec<(Vec<F::Connection>, BecauseOf<F>)>,
}

impl<F: Family> Default for Known<F> {
    fn default() -> Self {
        Self { stood: Vec::new(), failed: Vec::new() }
    }
}

/// All answers so far.
pub struct Asked<F: Family> {
    known: HashMap<Key<F>, Known<F>>,
}

impl<F: Family> Asked<F> {
    /// None.
    pub fn nothing() -> Self {
        Self { known: HashMap::new() }
    }

    /// Whether the robot stands while these groups, all of them moves, are under way, or at rest without any.
    ///
    /// # Errors
    /// What the oracle refuses.
    pub fn ask(
        &mut self,
        family: &F,
        groups: &[Group<F::Action>],
        state: &F::State,
        under_way: &[usize],
        attempt: &mut Attempt,
    ) -> Result<Result<(), BecauseOf<F>>, Refusal> {
        attempt.overlaps += u64::from(under_way.len() > 1);
        let connections = F::connections(state);
        let known = self.known.entry((family.place(state), under_way.to_vec())).or_default();
        if let Some((_, because)) = known.failed.iter().find(|(failed, _)| holds_more(failed, connections)) {
            return Ok(Err(because.clone()));
        }
        if let Some((stood, margin)) = known.stood.iter().find(|(stood, _)| holds_more(connections, stood)) {
            let is_exact = stood == connections;
            let upper = if is_exact { margin.upper } else { f64::INFINITY };
            attempt.margin = attempt.margin.min(Bracket::new(margin.lower, upper));
            attempt.by_monotony += u64::from(!is_exact);
            return Ok(Ok(()));
        }
        let moves: Vec<F::Action> = under_way.iter().map(|&group| groups[group].actions[0]).collect();
        Ok(match family.worst(state, &moves)? {
            Ok(margin) => {
                known.stood.push((connections.to_vec(), margin));
                attempt.margin = attempt.margin.min(margin);
                Ok(())
            }
            Err(because) => {
                known.failed.push((connections.to_vec(), because.clone()));
                Err(because)
            }
        })
    }
}

/// Whether one sorted list holds all that another does.
fn holds_more<C: Ord>(more: &[C], less: &[C]) -> bool {
    less.iter().all(|connection| more.binary_search(connection).is_ok())
}
