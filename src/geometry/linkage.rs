//! Modules of linkages that overlap each other or their environment.

use crate::robot::linkage::{Linkage, Port};
use crate::robot::{Fault, Part, Problem};
use crate::spatial::Pose;

use super::broad_phase::BroadPhase;
use super::separation::overlap;
use super::solid::Solid;
use super::surroundings::{Surrounding, Surroundings};
use super::tolerances::SKIN;

/// Most problems that are looked for, as in [`environment_problems`](super::environment_problems).
const MOST: usize = 100;

/// Modules that overlap others, the ground or obstacles, by module: of each module the first other module
/// and the first obstacle, and not many more than a hundred problems in all. The two bodies that
/// a connection engages may overlap, as hooks do, and so may the bodies of one module, whose joints'
/// ranges are to see to that. Completes [`Linkage::problems`], of which there must be none.
pub fn linkage_problems(linkage: &Linkage) -> Vec<Problem> {
    let poses: Vec<Vec<Pose>> = (0..linkage.modules.len()).map(|module| linkage.body_poses(module)).collect();
    let (mut owners, mut solids) = (Vec::new(), Vec::new());
    for (module, poses) in poses.iter().enumerate() {
        for (body, (kind, pose)) in linkage.module_type(module).bodies.iter().zip(poses).enumerate() {
            owners.push((module, body));
            solids.push(Solid::new(kind.shape.clone(), pose * kind.shape_pose));
        }
    }
    let held = held(linkage);
    let surroundings = Surroundings::new(&linkage.environment);
    let all = BroadPhase::new(solids.clone());
    let mut problems = Vec::new();
    let mut seen: Vec<(usize, &str)> = Vec::new();
    for (&(module, body), solid) in owners.iter().zip(&solids) {
        if problems.len() >= MOST {
            break;
        }
        let skin = SKIN * solid.size();
        let mut add = |kind: &'static str, fault: Fault| {
            if !seen.contains(&(module, kind)) {
                seen.push((module, kind));
                problems.push(Problem::new(Part::Module(module), "", fault));
            }
        };
        for what in surroundings.overlaps(solid, skin) {
            match what {
                Surrounding::Ground => add("ground", Fault::BelowGround),
                Surrounding::Obstacle(obstacle) => add("obstacle", Fault::InsideObstacle { obstacle }),
            }
        }
        let other = all.near(solid, 0.0).into_iter().find(|&(index, other)| {
            let (owner, other_body) = owners[index];
            owner < module
                && held.binary_search(&[(owner, other_body), (module, body)]).is_err()
                && overlap(solid, other, skin.min(SKIN * other.size()))
        });
        if let Some((index, _)) = other {
            add("module", Fault::OverlapsModule { other: owners[index].0 });
        }
    }
    problems
}

/// The pairs of bodies that connections engage, by module and body, the smaller first, sorted.
fn held(linkage: &Linkage) -> Vec<[(usize, usize); 2]> {
    let body = |port: Port| (port.module, linkage.module_type(port.module).ports[port.port].body);
    let mut held: Vec<_> = linkage
        .connections
        .iter()
        .map(|connection| {
            let [a, b] = connection.ports.map(body);
            [a.min(b), a.max(b)]
        })
        .collect();
    held.sort_unstable();
    held
}
