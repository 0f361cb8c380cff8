//! Modules that overlap their environment.

use crate::robot::{Configuration, Fault, Part, Problem};

use super::solid::Solid;
use super::surroundings::{Surrounding, Surroundings};
use super::tolerances::SKIN;

/// Most problems that are looked for: modules and obstacles that all overlap each
/// other must not take a time that grows with the number of their pairs.
const MOST: usize = 100;

/// Modules below the ground or inside obstacles, by module: of each module the first obstacle,
/// and not many more than a hundred problems in all. Completes [`Configuration::problems`],
/// of which there must be none.
pub fn environment_problems(configuration: &Configuration) -> Vec<Problem> {
    let surroundings = Surroundings::new(&configuration.environment);
    let mut problems = Vec::new();
    for module in 0..configuration.modules.len() {
        if problems.len() >= MOST {
            break;
        }
        let shape = configuration.module_type(module).body().shape.clone();
        let solid = Solid::new(shape, configuration.pose(module));
        let mut add = |fault| problems.push(Problem::new(Part::Module(module), "placement", fault));
        for what in surroundings.overlaps(&solid, SKIN * solid.size()) {
            match what {
                Surrounding::Ground => add(Fault::BelowGround),
                Surrounding::Obstacle(obstacle) => add(Fault::InsideObstacle { obstacle }),
            }
        }
    }
    problems
}
