//! How the order grows: group by group in the plan's order, each let go as early as all that this allows is checked.

use std::collections::{HashMap, HashSet, VecDeque};

use crate::reconfigure::engines::MARGIN_TOLERANCE;
use crate::reconfigure::plan::Plan;
use crate::statics::Bracket;

use super::asked::{Asked, Attempt};
use super::family::{BecauseOf, Family};
use super::groups::Group;
use super::precedence::{Precedence, Set};
use super::{Because, Checked, OrderError, OrderOptions, PartialOrder};

/// What speaks against letting a group go.
enum Objection<F: Family> {
    /// It must wait for this earlier one.
    Waits(usize, BecauseOf<F>),
    /// There is no time to look.
    Over,
}

/// An order in the making.
pub struct Growth<'a, F: Family> {
    pub(super) family: F,
    pub(super) options: &'a OrderOptions,
    pub(super) groups: Vec<Group<F::Action>>,
    pub(super) order: Precedence<BecauseOf<F>>,
    /// Where sets of done groups lead.
    pub(super) states: HashMap<Set, F::State>,
    pub(super) asked: Asked<F>,
    actions: usize,
    margin: Bracket,
    checked: Checked,
    is_complete: bool,
}

/// The margin of the states of an order that asks for one: the same state assessed twice may differ by the
/// width of a bracket; below 0 nothing stands.
pub(super) fn least(required: f64) -> f64 {
    if required > 0.0 { (required - MARGIN_TOLERANCE).max(0.0) } else { required }
}

impl<'a, F: Family> Growth<'a, F> {
    /// Nothing is let go yet.
    pub fn new(family: F, plan: &Plan<F::Action, F::Held>, options: &'a OrderOptions) -> Self {
        let groups = Group::of::<F>(plan);
        Self {
            family,
            options,
            order: Precedence::one_by_one(groups.len()),
            groups,
            states: HashMap::new(),
            asked: Asked::nothing(),
            actions: plan.actions.len(),
            margin: Bracket::new(f64::INFINITY, f64::INFINITY),
            checked: Checked { states: 1, ..Checked::default() },
            is_complete: true,
        }
    }

    /// The order once all groups are in it.
    pub fn grown(mut self) -> Result<PartialOrder<F::Touched>, OrderError<F::Touched>> {
        self.check_plan()?;
        self.order = Precedence::none(self.groups.len());
        for group in 0..self.groups.len() {
            for other in 0..group {
                if let Some(because) = self.groups[other].bound::<F>(&self.groups[group]) {
                    self.order.wait(group, other, because);
                }
            }
            loop {
                match self.let_go(group)? {
                    None => break,
                    Some(Objection::Waits(other, because)) => self.order.wait(group, other, because),
                    Some(Objection::Over) => {
                        self.is_complete = false;
                        (0..group).rev().for_each(|other| self.order.wait(group, other, Because::NotChecked));
                    }
                }
            }
        }
        let graph = self.order.graph(self.actions, |group| self.groups[group].indices.clone());
        let checked = Checked { oracle_solves: self.family.solves(), ..self.checked };
        Ok(PartialOrder { graph, margin: self.margin, checked, is_complete: self.is_complete })
    }

    /// Goes through the plan in its own order.
    fn check_plan(&mut self) -> Result<(), OrderError<F::Touched>> {
        let state = self.family.start();
        let mut attempt = Attempt::new();
        let at_start = self.asked.ask(&self.family, &self.groups, &state, &[], &mut attempt)?;
        at_start.map_err(|because| OrderError::Broken { action: None, because })?;
        self.states.insert(self.order.prefix(0), state);
        for group in 0..self.groups.len() {
            self.let_go(group)?;
        }
        self.margin = attempt.margin;
        self.checked = Checked { states: 1, ..Checked::default() };
        Ok(())
    }

    /// Looks at everything that a group may meet by what it waits for now, states with little missing first, and
    /// counts it if nothing speaks against it.
    fn let_go(&mut self, group: usize) -> Result<Option<Objection<F>>, OrderError<F::Touched>> {
        let mut attempt = Attempt::new();
        let all = self.order.prefix(group);
        let mut seen = HashSet::from([all.clone()]);
        let mut queue = VecDeque::from([all]);
        while let Some(done) = queue.pop_front() {
            let open = self.order.open(group, &done);
            if !open.is_empty() && self.options.is_over() {
                return Ok(Some(Objection::Over));
            }
            if let Err((other, because)) = self.meet(group, &done, &open, &mut attempt)? {
                return match other {
                    Some(other) => Ok(Some(Objection::Waits(other, because))),
                    None => Err(OrderError::Broken { action: Some(self.groups[group].indices.start), because }),
                };
            }
            for last in (0..group).filter(|&last| !self.order.waits(group, last) && self.order.is_last(last, &done)) {
                let mut fewer = done.clone();
                fewer[last] = false;
                if seen.insert(fewer.clone()) {
                    queue.push_back(fewer);
                }
            }
            if seen.len() > 1 && self.checked.states + seen.len() as u64 > self.options.max_states as u64 {
                let latest = (0..group).rev().find(|&other| !self.order.waits(group, other));
                return Ok(latest.map(|other| Objection::Waits(other, Because::NotChecked)));
            }
        }
        self.checked.states += seen.len() as u64;
        self.checked.overlaps += attempt.overlaps;
        self.checked.by_monotony += attempt.by_monotony;
        self.margin = self.margin.min(attempt.margin);
        Ok(None)
    }
}
