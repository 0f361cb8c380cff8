//! The same structure in other measures, and what that does to its utilisation.

use steadfast::spatial::{Pose, Vec3};
use steadfast::statics::{Model, Structure};

use crate::random::{Random, moved};

/// Factors on the numbers of a structure.
#[derive(Clone, Copy, Debug)]
pub struct Measures {
    /// On positions, radii and levers.
    pub length: f64,
    /// On masses and on forces of loads.
    pub mass: f64,
    /// On rated strengths and limits.
    pub strength: f64,
}

/// The structure with its numbers multiplied: as gravity stays, every force grows
/// with the masses and every torque with that and the lengths, so the
/// utilisation grows by `mass / strength`.
pub fn measured((mut structure, t): (Structure, f64), measures: &Measures) -> (Structure, f64) {
    let Measures { length, mass, strength } = *measures;
    for body in &mut structure.bodies {
        body.mass *= mass;
        body.com *= length;
    }
    for connection in &mut structure.connections {
        connection.frame.translation.vector *= length;
    }
    for contact in &mut structure.contacts {
        contact.position *= length;
    }
    for load in &mut structure.loads {
        load.force *= mass;
        load.torque *= mass * length;
        load.at = load.at.map(|at| at * length);
    }
    for connector in &mut structure.connectors {
        connector.strength *= strength;
        match &mut connector.model {
            Model::Cone { radius, .. } => radius.iter_mut().for_each(|r| *r *= length),
            Model::Box { shear, tension, compression, bending, torsion } => {
                shear.iter_mut().chain([tension, compression]).for_each(|limit| *limit *= strength);
                bending.iter_mut().chain([torsion]).for_each(|limit| *limit *= strength * length);
            }
            Model::Patch { points, .. } => points.iter_mut().flatten().for_each(|x| *x *= length),
        }
    }
    (structure, t * mass / strength)
}

/// The structure with all strengths changed so that its utilisation becomes `wanted`.
pub fn scaled_to((structure, t): (Structure, f64), wanted: f64) -> (Structure, f64) {
    let (structure, _) = measured((structure, t), &Measures { length: 1.0, mass: 1.0, strength: t / wanted });
    (structure, wanted)
}

/// The structure without gravity or loads: nothing to hold.
pub fn resting((mut structure, _): (Structure, f64)) -> (Structure, f64) {
    structure.gravity = Vec3::zeros();
    structure.loads.clear();
    (structure, 0.0)
}

/// The structure turned and shifted any way, gravity with it: the same utilisation.
pub fn turned((structure, t): (Structure, f64), seed: u64) -> (Structure, f64) {
    let mut random = Random::new(seed);
    let levers = structure.connections.iter().map(|connection| connection.frame.translation.vector.norm());
    let size = levers.chain(structure.contacts.iter().map(|contact| contact.position.norm())).fold(0.0, f64::max);
    let motion = Pose::from_parts((random.vector() * size).into(), random.rotation());
    (moved(&structure, &motion), t)
}
