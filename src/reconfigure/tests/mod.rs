//! Laws of actions, and the planner against unlike methods.

mod agreement;
mod carrying;
mod heuristics;
mod motions;
mod open_ground;
mod outcomes;
mod ranking;
mod reports;
mod restrictions;
mod sealed;
mod stencils;
mod tampering;

use std::sync::Arc;

use proptest::prelude::*;

use crate::robot::{
    Catalogue, Cell, Configuration, Environment, Goal, Ground, Matching, Module, Placement, Requirement,
};
use crate::spatial::Vec3;

use super::layout::Layout;
use super::moves::Move;
use super::options::Options;
use super::plan::{Outcome, Plan, Report};
use super::problem::cells;
use super::replay::replay;
use super::solve::solve;
use super::ways::{Ability, fitting};

/// Everything that a free cube of the catalogue can do.
pub fn cube() -> Ability {
    Ability::new(&Catalogue::cube(), 0)
}

/// Cubes named `a`, `b`, ... in these cells on the ground, all touching faces
/// connected; the first `fixed` ones held.
pub fn cubes(filled: &[Cell], fixed: usize) -> Configuration {
    let module = |(index, &cell): (usize, &Cell)| Module {
        id: char::from(b'a' + index as u8).to_string(),
        module_type: 0,
        placement: Placement::new(cell),
        fixed: index < fixed,
    };
    let mut configuration = Configuration {
        catalogue: Arc::new(Catalogue::cube()),
        gravity: Vec3::new(0.0, 0.0, -9.81),
        environment: Environment {
            ground: Some(Ground { height: 0.0, friction: 0.8 }),
            obstacles: Vec::new(),
            module_friction: 0.4,
        },
        modules: filled.iter().enumerate().map(module).collect(),
        connections: Vec::new(),
        loads: Vec::new(),
        require: Requirement::default(),
    };
    configuration.connections = configuration.touching_connections();
    configuration
}

/// A goal of interchangeable modules in the world frame.
pub fn goal(configuration: Configuration) -> Goal {
    Goal { configuration, matching: Matching::default() }
}

/// Up to so many cubes that hang together face to face, on or above the ground.
pub fn polycube(most: usize) -> impl Strategy<Value = Vec<Cell>> {
    let growth = proptest::collection::vec((0..64_usize, 0..6_usize), 1..most);
    growth.prop_map(|growth| {
        let mut filled = vec![[0, 0, 0]];
        for (at, face) in growth {
            let from = filled[at % filled.len()];
            let cell = super::layout::neighbour(from, crate::robot::Face::ALL[face]);
            if cell[2] >= 0 && !filled.contains(&cell) {
                filled.push(cell);
            }
        }
        filled
    })
}

/// The moves of free cubes, by their layout alone.
pub fn moves_of(layout: &Layout) -> Vec<Move> {
    let cube = cube();
    fitting(layout, |_| &cube)
}

/// The layout of cubes in these cells.
pub fn layout_of(filled: &[Cell]) -> Layout {
    cells(&cubes(filled, 0))
}

/// Plans, and replays every plan that comes back.
pub fn plan(start: &Configuration, goal: &Goal, options: &Options) -> Report {
    let report = solve(start, goal, options, &mut |_| {}).unwrap();
    for plan in report.plan.iter().chain(&report.alternatives) {
        let required = report.required.unwrap_or(f64::NEG_INFINITY);
        let replayed = replay(start, goal, plan, required).unwrap();
        if !options.ignore_stability {
            assert_eq!(replayed.failures, [], "{plan:#?}");
        }
    }
    report
}

pub fn solved(report: &Report) -> &Plan {
    assert_eq!(report.outcome, Outcome::Solved, "{report:#?}");
    report.plan.as_ref().unwrap()
}

/// Four cubes, the first one held: a tower becomes a row.
pub fn tower_to_row() -> (Configuration, Goal) {
    let start = cubes(&[[0, 0, 0], [0, 0, 1], [0, 0, 2], [1, 0, 0]], 1);
    (start, goal(cubes(&[[0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0]], 1)))
}
