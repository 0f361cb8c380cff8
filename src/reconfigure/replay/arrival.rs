//! Whether a state is the goal, compared module by module.

use crate::robot::{Cell, Configuration, Face, Goal, Orientation};

use super::failure::Fault;

/// A module for comparison: its type, its id where it is not interchangeable, its cell.
type Kind<'a> = (usize, Option<&'a str>, Cell);

/// What a state lacks to be the goal; `None` if it is.
pub(super) fn missing(start: &Configuration, end: &Configuration, goal: &Goal) -> Option<Fault> {
    let labelled = goal.matching.labelled;
    let here = kinds(start, end, labelled);
    let connections_here = pairs(end);
    let turns: &[usize] = if goal.matching.free_frame { &[0, 1, 2, 3] } else { &[0] };
    let mut placed = false;
    for &turn in turns {
        let mut wanted = goal.configuration.clone();
        if goal.matching.free_frame {
            carry(&mut wanted, end, turn);
        }
        if kinds(start, &wanted, labelled) != here {
            continue;
        }
        placed = true;
        if pairs(&wanted) == connections_here {
            return None;
        }
    }
    Some(if placed { Fault::ConnectionsDiffer } else { Fault::PlacementsDiffer })
}

/// The modules of `state`, sorted. A module keeps its id if modules are
/// labelled or if it is free and carries a load in the start.
fn kinds<'a>(start: &Configuration, state: &'a Configuration, labelled: bool) -> Vec<Kind<'a>> {
    let is_loaded = |id: &str| {
        let loaded = start.loads.iter().map(|load| &start.modules[load.module]);
        loaded.into_iter().any(|module| module.id == id && !module.fixed)
    };
    let mut kinds: Vec<_> = state
        .modules
        .iter()
        .map(|module| {
            let label = (labelled || is_loaded(&module.id)).then_some(module.id.as_str());
            (module.module_type, label, module.placement.cell)
        })
        .collect();
    kinds.sort_unstable();
    kinds
}

/// The engaged connections as sorted pairs of cells.
fn pairs(state: &Configuration) -> Vec<[Cell; 2]> {
    let mut pairs: Vec<[Cell; 2]> = state
        .connections
        .iter()
        .map(|connection| {
            let mut cells = connection.modules().map(|module| state.modules[module].placement.cell);
            cells.sort_unstable();
            cells
        })
        .collect();
    pairs.sort_unstable();
    pairs
}

/// Turns a goal by so many quarters about z and moves it over the ground to
/// the corner of the state's bounding box.
fn carry(goal: &mut Configuration, state: &Configuration, quarters: usize) {
    for module in &mut goal.modules {
        for _ in 0..quarters {
            let [x, y, z] = module.placement.cell;
            module.placement.cell = [-y, x, z];
            let turned = module.placement.orientation.turned(Orientation::quarter_turn(Face::PosZ));
            module.placement.orientation = turned;
        }
    }
    let corner = |configuration: &Configuration, axis: usize| {
        configuration.modules.iter().map(|module| module.placement.cell[axis]).min().unwrap_or(0)
    };
    let by = [0, 1].map(|axis| corner(state, axis) - corner(goal, axis));
    for module in &mut goal.modules {
        module.placement.cell[0] += by[0];
        module.placement.cell[1] += by[1];
    }
}
