//! Which module of a goal is which module of the start.

use std::collections::HashMap;

use super::super::codes;
use super::super::findings::{Findings, Place};
use super::super::json::clipped;
use super::super::suggest;
use super::robots::Compared;
use crate::robot::Matching;

/// The goal with its modules in the start's order: the module with the same id
/// and type where there is one, otherwise the next one of the same type.
/// Finds goals that no rearrangement of the start's modules can reach.
pub(super) fn in_order_of<R: Compared>(
    start: &R,
    mut goal: R,
    matching: Matching,
    place: &Place<'_>,
    findings: &mut Findings,
) -> Option<R> {
    let before = findings.count();
    let comparison = Comparison { start, goal: &goal, place };
    comparison.counts(findings);
    if findings.count() == before {
        comparison.named(matching, findings);
        comparison.fixed(matching, findings);
    }
    if findings.count() > before {
        return None;
    }
    let order = comparison.order();
    goal.reordered(&order);
    Some(goal)
}

struct Comparison<'a, R> {
    start: &'a R,
    goal: &'a R,
    place: &'a Place<'a>,
}

impl<R: Compared> Comparison<'_, R> {
    fn counts(&self, findings: &mut Findings) {
        let place = self.place.key("modules");
        let (have, want) = (self.start.count(), self.goal.count());
        if have != want {
            let message = format!("the goal has {want} modules, the start {have}");
            let hint = "no action adds or removes a module: list every module in both files";
            return findings.add(&place, codes::MODULE_COUNT, message, hint.to_string());
        }
        for (index, module_type) in self.start.catalogue().module_types.iter().enumerate() {
            let count = |of: &R| (0..of.count()).filter(|&module| of.module_type(module) == index).count();
            let (have, want) = (count(self.start), count(self.goal));
            if have != want {
                let name = clipped(&module_type.name);
                let message = format!("the goal has {want} modules of type `{name}`, the start {have}");
                findings.add(&place, codes::MODULE_TYPES, message, "no action changes a module's type".to_string());
            }
        }
    }

    /// Modules that are known by their id: all where they are labelled, else those under load.
    fn named(&self, matching: Matching, findings: &mut Findings) {
        let (start, goal) = (self.start, self.goal);
        let ids: HashMap<_, _> = (0..goal.count()).map(|module| (goal.id(module), module)).collect();
        for index in 0..start.count() {
            let loaded = start.loads().iter().any(|load| load.module == index);
            if !(matching.labelled || loaded) {
                continue;
            }
            let why = if matching.labelled { "the modules are labelled" } else { "it carries a load" };
            let id = clipped(start.id(index));
            let place = self.place.key("modules");
            match ids.get(start.id(index)) {
                None => {
                    let message = format!("the start's module `{id}` is not in the goal; {why}");
                    let hint = match suggest::closest(start.id(index), (0..goal.count()).map(|m| goal.id(m))) {
                        Some(near) => format!("is `{near}` the same module?"),
                        None => "list it under the id that it has in the start".to_string(),
                    };
                    findings.add(&place, codes::UNKNOWN_NAME, message, hint);
                }
                Some(&other) if goal.module_type(other) != start.module_type(index) => {
                    let message = format!("module `{id}` has another type than in the start; {why}");
                    findings.add(&place, codes::MODULE_TYPES, message, "give it its type in the start".to_string());
                }
                Some(_) => {}
            }
        }
    }

    /// A fixed module stays where it is.
    fn fixed(&self, matching: Matching, findings: &mut Findings) {
        if matching.free_frame {
            return;
        }
        let (start, goal) = (self.start, self.goal);
        let stays = |module: usize, other: usize| {
            goal.is_fixed(other)
                && goal.module_type(other) == start.module_type(module)
                && (!matching.labelled || goal.id(other) == start.id(module))
        };
        for (module, other) in start.in_place_of_fixed(goal) {
            if !other.is_some_and(|other| stays(module, other)) {
                let (id, place) = (clipped(start.id(module)), start.whereabouts(module));
                let message = format!("the start's fixed module `{id}` {place} is not in the goal");
                let hint = format!("a fixed module never moves: list it with {} and \"fixed\": true", R::WHERE);
                findings.add(&self.place.key("modules"), codes::FIXED_MODULES, message, hint);
            }
        }
        for (module, other) in goal.in_place_of_fixed(start) {
            if !other.is_some_and(|other| start.is_fixed(other)) {
                let message = format!(
                    "module `{}` is fixed here, but no module is fixed there in the start",
                    clipped(goal.id(module))
                );
                let place = self.place.key("modules").index(module).key("fixed");
                findings.add(&place, codes::FIXED_MODULES, message, "a module cannot become fixed".to_string());
            }
        }
    }

    /// For each module of the start, the goal's module that takes its place in the list.
    fn order(&self) -> Vec<usize> {
        let (start, goal) = (self.start, self.goal);
        let mut taken = vec![false; goal.count()];
        let ids: HashMap<_, _> = (0..goal.count()).map(|module| (goal.id(module), module)).collect();
        let mut order: Vec<Option<usize>> = Vec::new();
        for module in 0..start.count() {
            let same = ids.get(start.id(module)).copied();
            let same = same.filter(|&other| goal.module_type(other) == start.module_type(module));
            if let Some(index) = same {
                taken[index] = true;
            }
            order.push(same);
        }
        let mut free: HashMap<usize, Vec<usize>> = HashMap::new();
        for index in (0..taken.len()).rev().filter(|&index| !taken[index]) {
            free.entry(goal.module_type(index)).or_default().push(index);
        }
        let mut next = |module: usize| free.get_mut(&start.module_type(module)).and_then(Vec::pop);
        // Equal numbers of every type: there is always a next one.
        order.iter().enumerate().filter_map(|(module, found)| found.or_else(|| next(module))).collect()
    }
}
