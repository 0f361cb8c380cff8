//! Modules that overlap their environment.

use crate::robot::{Configuration, Fault, Part, Problem};

use super::broad_phase::BroadPhase;
use super::separation::overlap;
use super::solid::Solid;
use super::tolerances::SKIN;

/// Most problems that are looked for: modules and obstacles that all overlap each
/// other must not take a time that grows with the number of their pairs.
const MOST: usize = 100;

/// Modules below the ground or inside obstacles, by module: of each module the first obstacle,
/// and not many more than a hundred problems in all. Completes [`Configuration::problems`],
/// of which there must be none.
pub fn environment_problems(configuration: &Configuration) -> Vec<Problem> {
    let environment = &configuration.environment;
    let obstacles = BroadPhase::new(environment.obstacles.iter().map(Solid::from).collect());
    let mut problems = Vec::new();
    for module in 0..configuration.modules.len() {
        if problems.len() >= MOST {
            break;
        }
        let shape = configuration.module_type(module).body().shape.clone();
        let solid = Solid::new(shape, configuration.pose(module));
        let skin = SKIN * solid.size();
        let mut add = |fault| problems.push(Problem::new(Part::Module(module), "placement", fault));
        if let Some(ground) = &environment.ground
            && !solid.vertices().iter().all(|p| p.z >= ground.height - skin)
        {
            add(Fault::BelowGround);
        }
        let mut near = obstacles.near(&solid, 0.0).into_iter();
        if let Some((obstacle, _)) = near.find(|(_, other)| overlap(&solid, other, skin)) {
            add(Fault::InsideObstacle { obstacle });
        }
    }
    problems
}
