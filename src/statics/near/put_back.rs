//! Puts wrenches that left their cones back into them.
//!
//! By about the shortest way, and a little inside, so that the next metric still
//! has room there. Nothing is proved with it.

use crate::spatial::{Vec3, Wrench};

use super::super::blocks::Link;
use super::super::bracket::Problem;
use super::super::connector::{Connector, Model};
use super::super::second_order::norm;
use super::field::{Field, face};

/// How far out towards its limit a wrench is put, at most.
const INSIDE: f64 = 0.98;

/// Puts all wrenches of `field` into their cones at strengths `level` times the rated ones.
pub(super) fn put_back(problem: &Problem<'_>, field: &mut Field, level: f64) {
    let Problem { structure, block, .. } = *problem;
    let mut points = &mut field.points[..];
    for (&link, wrench) in block.links.iter().zip(&mut field.wrenches) {
        match link {
            Link::Contact(i) => {
                *wrench = Wrench::new(pressed(&wrench.force, structure.contacts[i].friction), Vec3::zeros())
            }
            Link::Connection(i) => {
                let connector = &structure.connectors[structure.connections[i].connector];
                if let (Model::Patch { friction, .. }, Some(face)) = (&connector.model, face(structure, link)) {
                    let (own, others) = points.split_at_mut(face.points.len());
                    points = others;
                    for force in own.iter_mut() {
                        *force = met(force, *friction);
                    }
                    *wrench = face.wrench(own, face.preload(level));
                } else {
                    limit(connector, wrench, level);
                }
            }
        }
    }
}

/// A contact's force with so much pressure that friction holds it.
fn pressed(force: &Vec3, friction: f64) -> Vec3 {
    if friction > 0.0 {
        Vec3::new(force.x, force.y, force.z.max(force.xy().norm() / (friction * INSIDE)))
    } else {
        Vec3::z() * force.z.max(0.0)
    }
}

/// The force at a face's point, less shear and more pressure where friction would not hold it.
fn met(force: &Vec3, friction: f64) -> Vec3 {
    if !(friction > 0.0) {
        return Vec3::z() * force.z.max(0.0);
    }
    let mut wrench = Wrench::new(*force, Vec3::zeros());
    shorten(&mut wrench, 0.0, force.xy().norm() / friction);
    wrench.force
}

/// Puts the wrench of a connection that is not a face into its cone.
fn limit(connector: &Connector, wrench: &mut Wrench, level: f64) {
    let Wrench { force: f, torque: m } = *wrench;
    match &connector.model {
        Model::Cone { friction: [a, b], radius: [c, d, e] } => {
            let tail = norm(&[f.x / a, f.y / b, m.x / c, m.y / d, m.z / e]);
            shorten(wrench, level * connector.strength, tail);
        }
        Model::Box { shear: [a, b], tension, compression, bending: [c, d], torsion } => {
            let to = |x: f64, low: f64, high: f64| x.clamp(-low * level * INSIDE, high * level * INSIDE);
            let force = Vec3::new(to(f.x, *a, *a), to(f.y, *b, *b), to(f.z, *tension, *compression));
            let torque = Vec3::new(to(m.x, *c, *c), to(m.y, *d, *d), to(m.z, *torsion, *torsion));
            *wrench = Wrench::new(force, torque);
        }
        Model::Patch { .. } => {}
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
    use crate::statics::structure::{Anchor, Connection, Structure};

    const SQUARE: [[f64; 2]; 4] = [[0.05, 0.05], [-0.05, 0.05], [-0.05, -0.05], [0.05, -0.05]];

    /// Wrenches of every kind, most of them beyond what a connector of 20 N can carry.
    fn wrenches() -> impl Iterator<Item = Wrench> {
        (0..40).map(|k| {
            let angle = |n: f64| (f64::from(k) * n).sin();
            let force = Vec3::new(angle(1.0), angle(1.3), angle(1.7)) * 60.0;
            Wrench::new(force, Vec3::new(angle(2.1), angle(2.3), angle(2.9)) * 3.0)
        })
    }

    fn connector(model: Model) -> Connector {
        Connector { name: "c".to_owned(), strength: 20.0, model }
    }

    fn utilisation(connector: &Connector, wrench: &Wrench) -> f64 {
        demand(connector, wrench, &WrenchError { force: Vec3::zeros(), torque: Vec3::zeros() }).utilisation.upper
    }

    #[test]
    fn what_was_put_back_demands_no_more_than_the_level() {
        let compression = f64::INFINITY;
        let models = [
            Model::Cone { friction: [0.5, 0.4], radius: [0.03, 0.03, 0.04] },
            Model::Box { shear: [20.0, 10.0], tension: 20.0, compression, bending: [1.0, 2.0], torsion: 1.0 },
        ];
        for connector in models.map(connector) {
            for mut wrench in wrenches() {
                limit(&connector, &mut wrench, 0.8);
                let found = utilisation(&connector, &wrench);
                assert!(found <= 0.8 * (1.0 + 1e-9), "{found:?} {wrench:?}");
                // A second time changes nothing but rounding.
                let kept = wrench;
                limit(&connector, &mut wrench, 0.8);
                assert!((wrench.force - kept.force).norm() <= 1e-9 * 20.0, "{kept:?} {wrench:?}");
            }
        }
    }

    #[test]
    fn points_that_were_put_back_show_that_the_preload_is_enough() {
        let mut structure = Structure::default();
        structure.connectors.push(connector(Model::Patch { friction: 0.4, points: SQUARE.to_vec() }));
        let (parent, child, frame) = (Anchor::World, Anchor::Body(0), Pose::identity());
        structure.connections.push(Connection { parent, child, connector: 0, frame });
        let face = face(&structure, Link::Connection(0)).expect("it is one");
        for wrench in wrenches() {
            let preload = face.preload(0.8);
            let forces: Vec<Vec3> = face.share(&wrench, preload).iter().map(|force| met(force, 0.4)).collect();
            let carried = face.wrench(&forces, preload);
            let bound = face.at_most(&carried, &forces, 0.0).expect("there is friction");
            let needed = utilisation(&structure.connectors[0], &carried);
            assert!(bound <= 0.8, "{bound} {wrench:?}");
            assert!(needed <= bound * (1.0 + 1e-9), "{needed} {bound}");
        }
    }
}
