//! Modules that overlap their environment.

use crate::robot::{Configuration, Fault, Part, Problem};

use super::broad_phase::BroadPhase;
use super::separation::overlap;
use super::solid::Solid;
use super::tolerances::SKIN;

/// Modules below the ground or inside obstacles, by module. Completes
/// [`Configuration::problems`], of which there must be none.
pub fn environment_problems(configuration: &Configuration) -> Vec<Problem> {
    let environment = &configuration.environment;
    let obstacles = BroadPhase::new(environment.obstacles.iter().map(Solid::from).collect());
    let mut problems = Vec::new();
    for module in 0..configuration.modules.len() {
        let shape = configuration.module_type(module).body.shape.clone();
        let solid = Solid::new(shape, configuration.pose(module));
        let skin = SKIN * solid.size();
        let mut add = |fault| problems.push(Problem::new(Part::Module(module), "placement", fault));
        if let Some(ground) = &environment.ground
            && !solid.vertices().iter().all(|p| p.z >= ground.height - skin)
        {
            add(Fault::BelowGround);
        }
        for (obstacle, other) in obstacles.near(&solid, 0.0) {
            if overlap(&solid, other, skin) {
                add(Fault::InsideObstacle { obstacle });
            }
        }
    }
    problems
}
