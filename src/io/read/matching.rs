//! Which module of a goal is which module of the start.

use std::collections::HashMap;

use super::super::codes;
use super::super::findings::{Findings, Place};
use super::super::json::clipped;
use super::super::suggest;
use crate::robot::{Configuration, FaceConnection, Matching, Module, Port};

/// The goal with its modules in the start's order: the module with the same id
/// and type where there is one, otherwise the next one of the same type.
/// Finds goals that no rearrangement of the start's modules can reach.
pub(super) fn in_order_of(
    start: &Configuration,
    goal: Configuration,
    matching: Matching,
    place: &Place<'_>,
    findings: &mut Findings,
) -> Option<Configuration> {
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
    Some(reordered(&comparison.order(), goal))
}

struct Comparison<'a> {
    start: &'a Configuration,
    goal: &'a Configuration,
    place: &'a Place<'a>,
}

impl Comparison<'_> {
    fn counts(&self, findings: &mut Findings) {
        let place = self.place.key("modules");
        let (have, want) = (self.start.modules.len(), self.goal.modules.len());
        if have != want {
            let message = format!("the goal has {want} modules, the start {have}");
            let hint = "no action adds or removes a module: list every module in both files";
            return findings.add(&place, codes::MODULE_COUNT, message, hint.to_string());
        }
        for (index, module_type) in self.start.catalogue.module_types.iter().enumerate() {
            let count = |of: &Configuration| of.modules.iter().filter(|module| module.module_type == index).count();
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
        let ids: HashMap<_, _> = self.goal.modules.iter().map(|module| (module.id.as_str(), module)).collect();
        for (index, module) in self.start.modules.iter().enumerate() {
            let loaded = self.start.loads.iter().any(|load| load.module == index);
            if !(matching.labelled || loaded) {
                continue;
            }
            let why = if matching.labelled { "the modules are labelled" } else { "it carries a load" };
            let id = clipped(&module.id);
            let place = self.place.key("modules");
            match ids.get(module.id.as_str()) {
                None => {
                    let message = format!("the start's module `{id}` is not in the goal; {why}");
                    let hint = match suggest::closest(&module.id, ids_of(self.goal)) {
                        Some(near) => format!("is `{near}` the same module?"),
                        None => "list it under the id that it has in the start".to_string(),
                    };
                    findings.add(&place, codes::UNKNOWN_NAME, message, hint);
                }
                Some(other) if other.module_type != module.module_type => {
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
        let cells: HashMap<_, _> = self.goal.modules.iter().map(|module| (module.placement.cell, module)).collect();
        let stays = |module: &Module, other: &Module| {
            other.fixed && other.module_type == module.module_type && (!matching.labelled || other.id == module.id)
        };
        for module in self.start.modules.iter().filter(|module| module.fixed) {
            let cell = module.placement.cell;
            if !cells.get(&cell).is_some_and(|other| stays(module, other)) {
                let message =
                    format!("the start's fixed module `{}` in cell {cell:?} is not in the goal", clipped(&module.id));
                let hint = "a fixed module never moves: list it with the same cell and \"fixed\": true";
                findings.add(&self.place.key("modules"), codes::FIXED_MODULES, message, hint.to_string());
            }
        }
        let held: HashMap<_, _> = self.start.modules.iter().map(|module| (module.placement.cell, module)).collect();
        for (index, module) in self.goal.modules.iter().enumerate().filter(|(_, module)| module.fixed) {
            if !held.get(&module.placement.cell).is_some_and(|other| other.fixed) {
                let message = format!(
                    "module `{}` is fixed here, but no module is fixed there in the start",
                    clipped(&module.id)
                );
                let place = self.place.key("modules").index(index).key("fixed");
                findings.add(&place, codes::FIXED_MODULES, message, "a module cannot become fixed".to_string());
            }
        }
    }

    /// For each module of the start, the goal's module that takes its place in the list.
    fn order(&self) -> Vec<usize> {
        let mut taken = vec![false; self.goal.modules.len()];
        let ids: HashMap<_, _> =
            self.goal.modules.iter().enumerate().map(|(i, module)| (module.id.as_str(), i)).collect();
        let mut order: Vec<Option<usize>> = Vec::new();
        for module in &self.start.modules {
            let same = ids.get(module.id.as_str()).copied();
            let same = same.filter(|&i| self.goal.modules[i].module_type == module.module_type);
            if let Some(index) = same {
                taken[index] = true;
            }
            order.push(same);
        }
        let mut free: HashMap<usize, Vec<usize>> = HashMap::new();
        for index in (0..taken.len()).rev().filter(|&index| !taken[index]) {
            free.entry(self.goal.modules[index].module_type).or_default().push(index);
        }
        let mut next = |module: &Module| free.get_mut(&module.module_type).and_then(Vec::pop);
        // Equal numbers of every type: there is always a next one.
        order.iter().zip(&self.start.modules).filter_map(|(found, module)| found.or_else(|| next(module))).collect()
    }
}

fn ids_of(configuration: &Configuration) -> impl Iterator<Item = &str> {
    configuration.modules.iter().map(|module| module.id.as_str())
}

fn reordered(order: &[usize], mut goal: Configuration) -> Configuration {
    let mut new_index = vec![0; order.len()];
    for (new, &old) in order.iter().enumerate() {
        new_index[old] = new;
    }
    let moved = |port: Port| Port { module: new_index[port.module], ..port };
    goal.modules = order.iter().map(|&old| goal.modules[old].clone()).collect();
    goal.connections =
        goal.connections.iter().map(|c| FaceConnection::new(moved(c.ports[0]), moved(c.ports[1]))).collect();
    goal.connections.sort_unstable();
    goal
}
