//! Puts wrenches that left their cones back into them.
//!
//! By about the shortest way, and a little inside, so that the next metric still
//! has room there. Nothing is proved with it.

use crate::spatial::{Vec3, Wrench};

use super::super::blocks::Link;
use super::super::connector::Model;
use super::super::patch::least_normal_force;
use super::super::second_order::norm;
use super::super::structure::Structure;

/// How far out towards its limit a wrench is put, at most.
const INSIDE: f64 = 0.98;

/// Puts the wrench of `link`, in its frame, into its cone at strengths `level`
/// times the rated ones.
pub(super) fn put_back(structure: &Structure, link: Link, wrench: &mut Wrench, level: f64) {
    let Wrench { force: f, torque: m } = *wrench;
    match link {
        Link::Contact(i) => {
            let friction = structure.contacts[i].friction;
            let force = if friction > 0.0 {
                Vec3::new(f.x, f.y, f.z.max(f.xy().norm() / (friction * INSIDE)))
            } else {
                Vec3::z() * f.z.max(0.0)
            };
            *wrench = Wrench::new(force, Vec3::zeros());
        }
        Link::Connection(i) => {
            let connector = &structure.connectors[structure.connections[i].connector];
            let held = level * connector.strength;
            match &connector.model {
                Model::Cone { friction: [a, b], radius: [c, d, e] } => {
                    shorten(wrench, held, norm(&[f.x / a, f.y / b, m.x / c, m.y / d, m.z / e]));
                }
                Model::Patch { friction, points } => {
                    let needed = least_normal_force(wrench, *friction, points).total.upper;
                    shorten(wrench, held, needed);
                }
                Model::Box { shear: [a, b], tension, compression, bending: [c, d], torsion } => {
                    let to = |x: f64, low: f64, high: f64| x.clamp(-low * level * INSIDE, high * level * INSIDE);
                    let force = Vec3::new(to(f.x, *a, *a), to(f.y, *b, *b), to(f.z, *tension, *compression));
                    let torque = Vec3::new(to(m.x, *c, *c), to(m.y, *d, *d), to(m.z, *torsion, *torsion));
                    *wrench = Wrench::new(force, torque);
                }
            }
        }
    }
}

/// Where the normal force and what holds, together the head of a second-order
/// cone, are less than the `tail` wants: meets in the middle. What is at the limit
/// already stays, so that a second time changes nothing.
fn shorten(wrench: &mut Wrench, held: f64, tail: f64) {
    let (head, wanted) = (held + wrench.force.z, tail / INSIDE);
    if !(tail < f64::INFINITY) || head >= wanted {
        return;
    }
    let middle = f64::midpoint(head, wanted).max(0.0);
    let factor = middle / wanted;
    wrench.force.x *= factor;
    wrench.force.y *= factor;
    wrench.torque *= factor;
    wrench.force.z = middle - held;
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spatial::Pose;
    use crate::statics::connector::Connector;
    use crate::statics::demand::{WrenchError, demand};
    use crate::statics::structure::{Anchor, Body, Connection};

    #[test]
    fn what_was_put_back_demands_no_more_than_the_level() {
        let points = vec![[0.05, 0.05], [-0.05, 0.05], [-0.05, -0.05], [0.05, -0.05]];
        let compression = f64::INFINITY;
        let models = [
            Model::Cone { friction: [0.5, 0.4], radius: [0.03, 0.03, 0.04] },
            Model::Patch { friction: 0.4, points },
            Model::Box { shear: [20.0, 10.0], tension: 20.0, compression, bending: [1.0, 2.0], torsion: 1.0 },
        ];
        for model in models {
            let mut structure = Structure::default();
            structure.bodies.push(Body { mass: 1.0, com: Vec3::zeros(), fixed: false });
            structure.connectors.push(Connector { name: "c".to_owned(), strength: 20.0, model });
            let (parent, child, frame) = (Anchor::World, Anchor::Body(0), Pose::identity());
            structure.connections.push(Connection { parent, child, connector: 0, frame });
            for k in 0..40 {
                let angle = |n: f64| (f64::from(k) * n).sin();
                let mut wrench = Wrench::new(
                    Vec3::new(angle(1.0), angle(1.3), angle(1.7)) * 60.0,
                    Vec3::new(angle(2.1), angle(2.3), angle(2.9)) * 3.0,
                );
                put_back(&structure, Link::Connection(0), &mut wrench, 0.8);
                let error = WrenchError { force: Vec3::zeros(), torque: Vec3::zeros() };
                let utilisation = demand(&structure.connectors[0], &wrench, &error).utilisation;
                assert!(utilisation.upper <= 0.8 * (1.0 + 1e-9), "{utilisation:?} {wrench:?}");
                // A second time changes nothing but rounding.
                let kept = wrench;
                put_back(&structure, Link::Connection(0), &mut wrench, 0.8);
                assert!((wrench.force - kept.force).norm() <= 1e-9 * 20.0, "{kept:?} {wrench:?}");
            }
        }
    }
}
