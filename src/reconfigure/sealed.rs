//! Levels that no module reaches while none is there: a proof of impossibility that takes no search.
//!
//! A module is held by others on its way. Where the ground leaves no room to come down to some height but along modules
//! that stand there, the first one never comes, and, since that is true of the way up as well, the last one never
//! leaves. So a robot that has modules there and one that has none are not each other's goals, however many
//! modules they have.
//!
//! Knows motions and the ground; knows neither obstacles, which only take room away, nor forces.

use crate::geometry::{Solid, Surroundings};
use crate::robot::{Cell, Environment, Placement};

use super::course::motion;
use super::layout::{Layout, displaced};
use super::moves::Move;
use super::problem::Problem;
use super::refusal::{Impossible, Which};
use super::ways::{Ability, Way};

/// A level that only one of start and goal reaches down to, if no module ever crosses it then.
pub fn sealed(problem: &Problem) -> Option<Impossible> {
    // In a free frame the goal moves along the ground only.
    let [start, goal] = [problem.start_layout(), problem.goal().layout()].map(lowest);
    let (start, goal) = (start?, goal?);
    let which = if start < goal { Which::Goal } else { Which::Start };
    let levels = start.min(goal)..start.max(goal);
    let environment = &problem.start().environment;
    let ground = Environment { obstacles: Vec::new(), ..environment.clone() };
    let ground = Surroundings::new(&ground);
    levels
        .into_iter()
        .find(|&level| is_sealed(problem, &ground, level))
        .map(|level| Impossible::Sealed { level, which })
}

fn lowest(layout: &Layout) -> Option<i32> {
    layout.placed().iter().map(|placed| placed.cell[2]).min()
}

/// Whether no module gets from above a level to it or below it, nor back, while no other one is there.
fn is_sealed(problem: &Problem, ground: &Surroundings, level: i32) -> bool {
    let classes = problem.start_layout().placed().iter().map(|placed| placed.class);
    let mut abilities: Vec<(&Ability, usize)> =
        classes.map(|class| (problem.ability(class), problem.class(class).module_type)).collect();
    abilities.dedup();
    let start = problem.start();
    let has_room = |module_type: usize, way: &Way, from: Cell| {
        let shape = start.catalogue.module_types[module_type].body().shape.clone();
        let solid = Solid::new(shape, Placement::new(from).pose(start.pitch()));
        let step = Move { from, motion: way.motion, kind: way.kind };
        ground.first_collision(&solid, &motion(step, start.pitch())).is_none()
    };
    let is_above = |cell: Cell| cell[2] > level;
    abilities.into_iter().all(|(ability, module_type)| {
        ability.ways().iter().all(|way| {
            let up = way.motion.by()[2];
            // The ground is the same everywhere.
            let mut from = (level - up.abs()..=level + up.abs()).map(|z| [0, 0, z]);
            let crosses = |from: Cell| is_above(from) != is_above(displaced(from, way.motion.by()));
            !from.any(|from| crosses(from) && way.can_be_met(from, is_above) && has_room(module_type, way, from))
        })
    })
}
