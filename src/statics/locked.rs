//! Locks what does not move, where only resting is admissible.
//!
//! Parts that press against each other whatever the loads, floor and ceiling or a latch
//! that takes any pull and the contact beside it, have no motion that opens all of
//! them: their opening velocities are zero, exactly, and a solver's are noise of
//! either sign. Where whole bodies are at rest against each other they are fused (see
//! `clusters`); where they still hinge or slide, the components at rest are held here,
//! by connections that take any force along them. A mechanism so restricted proves what
//! it proves for the block as well.

use crate::spatial::{Pose, Rotation, Vec3};

use super::blocks::Link;
use super::clusters::Reduced;
use super::connector::{Connector, Model};
use super::structure::{Anchor, Connection, Contact};

/// Which components of every link's relative twist, in its frame, are at rest.
pub(super) type AtRest = Vec<[bool; 6]>;

/// Holds those components of the links of `reduced` that are at rest and that one
/// direction of a force could hold without limit; `at_rest` is by link of the original.
pub(super) fn lock(reduced: &mut Reduced, at_rest: &[[bool; 6]]) {
    let Reduced { structure, block, origins, .. } = reduced;
    let contacts = origins.split_off(structure.connections.len());
    for (connection, origin) in structure.connections.iter_mut().zip(&*origins) {
        let mut connector = structure.connectors[connection.connector].clone();
        if hold(&mut connector.model, &at_rest[*origin]) {
            connection.connector = structure.connectors.len();
            structure.connectors.push(connector);
        }
    }
    let mut left = (Vec::new(), Vec::new());
    for (contact, origin) in std::mem::take(&mut structure.contacts).into_iter().zip(contacts) {
        let resting = at_rest[origin];
        let along = if contact.friction > 0.0 { resting[..3] == [true; 3] } else { resting[2] };
        if along {
            structure.connections.push(pin(&contact, structure.connectors.len()));
            structure.connectors.push(holder(contact.friction > 0.0));
            origins.push(origin);
        } else {
            left.0.push(contact);
            left.1.push(origin);
        }
    }
    (structure.contacts, _) = (left.0, origins.extend(left.1));
    let connections = (0..structure.connections.len()).map(Link::Connection);
    block.links = connections.chain((0..structure.contacts.len()).map(Link::Contact)).collect();
}

/// Takes the other limit away from components at rest that have but one; whether there
/// were any.
fn hold(model: &mut Model, at_rest: &[bool; 6]) -> bool {
    let Model::Box { tension, compression, .. } = model else { return false };
    let one_sided = tension.is_infinite() != compression.is_infinite();
    if one_sided && at_rest[2] {
        (*tension, *compression) = (f64::INFINITY, f64::INFINITY);
    }
    one_sided && at_rest[2]
}

/// A connection where a contact is.
fn pin(contact: &Contact, connector: usize) -> Connection {
    let turn = Rotation::rotation_between(&Vec3::z(), &contact.normal)
        .unwrap_or_else(|| Rotation::from_axis_angle(&Vec3::x_axis(), std::f64::consts::PI));
    let frame = Pose::from_parts(contact.position.into(), turn);
    Connection { parent: contact.against, child: Anchor::Body(contact.body), connector, frame }
}

/// Takes any force at a point, along the normal only where it is `smooth`, and no torque.
fn holder(rough: bool) -> Connector {
    let shear = if rough { f64::INFINITY } else { 0.0 };
    let model = Model::Box {
        shear: [shear; 2],
        tension: f64::INFINITY,
        compression: f64::INFINITY,
        bending: [0.0; 2],
        torsion: 0.0,
    };
    // No strength limits it, so that it says nothing of the utilisation to expect.
    Connector { name: String::new(), strength: f64::MAX, model }
}

#[cfg(test)]
mod tests {
    use super::super::assess::assess;
    use super::super::assessment::Question;
    use super::super::blocks::cut;
    use super::super::clusters::Clusters;
    use super::super::loads::own_loads;
    use super::super::structure::{Body, Load, Structure};
    use super::*;

    const NONE: f64 = f64::INFINITY;

    fn latch(tension: f64, compression: f64) -> Model {
        Model::Box { shear: [8.0; 2], tension, compression, bending: [1.0; 2], torsion: 1.0 }
    }

    /// A body on a floor and against a smooth wall, with a latch to each side and a cone behind.
    fn held() -> Structure {
        let mut structure = Structure { gravity: Vec3::new(12.0, 1.0, -10.0), ..Structure::default() };
        structure.bodies.push(Body { mass: 1.0, com: Vec3::zeros(), fixed: false });
        let cone = Model::Cone { friction: [0.5; 2], radius: [0.1; 3] };
        let models = [latch(5.0, NONE), latch(5.0, 7.0), cone];
        let sides = [-Vec3::x(), Vec3::x(), Vec3::y()];
        for (connector, (model, side)) in models.into_iter().zip(sides).enumerate() {
            structure.connectors.push(Connector { name: "c".to_owned(), strength: 5.0, model });
            let turn = Rotation::rotation_between(&Vec3::z(), &-side).expect("not opposite");
            let frame = Pose::from_parts((side * 0.1).into(), turn);
            structure.connections.push(Connection { parent: Anchor::World, child: Anchor::Body(0), connector, frame });
        }
        for (normal, friction) in [(Vec3::z(), 0.1), (-Vec3::y(), 0.0)] {
            structure.contacts.push(Contact {
                body: 0,
                against: Anchor::World,
                position: (Vec3::x() - normal) * 0.1,
                normal,
                friction,
            });
        }
        structure
    }

    fn locked(structure: &Structure, at_rest: &[[bool; 6]]) -> Reduced {
        let block = cut(structure).blocks.swap_remove(0);
        let clusters = Clusters::new(structure, &block, |_, _| false);
        let mut reduced = clusters.reduce(structure, &block, &own_loads(structure)).expect("it moves and is loaded");
        lock(&mut reduced, at_rest);
        reduced
    }

    fn limits(reduced: &Reduced, connection: usize) -> &Model {
        &reduced.structure.connectors[reduced.structure.connections[connection].connector].model
    }

    #[test]
    fn what_does_not_rest_stays_as_it_is() {
        let structure = held();
        let reduced = locked(&structure, &[[false; 6]; 5]);
        assert_eq!(reduced.structure.connectors, structure.connectors);
        assert_eq!(reduced.structure.contacts, structure.contacts);
        assert_eq!(reduced.origins, [0, 1, 2, 3, 4]);
    }

    #[test]
    fn only_what_is_one_sided_is_held() {
        let structure = held();
        let reduced = locked(&structure, &[[true; 6]; 5]);
        assert_eq!(limits(&reduced, 0), &latch(NONE, NONE));
        for connection in [1, 2] {
            assert_eq!(limits(&reduced, connection), &structure.connectors[connection].model);
        }
        // Its other components say nothing of the one that is held.
        let sideways = [true, true, false, true, true, true];
        assert_eq!(limits(&locked(&structure, &[sideways; 5]), 0), &structure.connectors[0].model);
    }

    #[test]
    fn contacts_at_rest_become_pins_of_the_force_they_have() {
        let structure = held();
        let along = [false, false, true, false, false, false];
        // The rough floor still slides, the smooth wall does not open.
        let reduced = locked(&structure, &[along; 5]);
        assert_eq!(reduced.origins, [0, 1, 2, 4, 3]);
        assert_eq!(reduced.structure.contacts, structure.contacts[..1]);
        let pin = |shear: f64| Model::Box {
            shear: [shear; 2],
            tension: NONE,
            compression: NONE,
            bending: [0.0; 2],
            torsion: 0.0,
        };
        assert_eq!(limits(&reduced, 3), &pin(0.0));
        let at_rest = [true, true, true, false, false, false];
        let reduced = locked(&structure, &[at_rest; 5]);
        assert_eq!((&reduced.origins[..], reduced.structure.contacts.len()), (&[0, 1, 2, 3, 4][..], 0));
        assert_eq!((limits(&reduced, 3), limits(&reduced, 4)), (&pin(NONE), &pin(0.0)));
        for (contact, pin) in structure.contacts.iter().zip(&reduced.structure.connections[3..]) {
            assert_eq!(pin.frame.translation.vector, contact.position);
            assert!((pin.frame.rotation * Vec3::z() - contact.normal).norm() < 1e-15);
            assert_eq!((pin.parent, pin.child), (contact.against, Anchor::Body(contact.body)));
        }
        assert_eq!(reduced.block.links.len(), 5);
    }

    /// Holding more only ever helps, so that what a locked block needs at least the block needs too.
    #[test]
    fn whatever_is_held_the_utilisation_does_not_grow() {
        let structure = held();
        let utilisation = |mask: usize| {
            let rests = |link: usize| [mask >> link & 1 == 1; 6];
            let reduced = locked(&structure, &std::array::from_fn::<_, 5, _>(rests));
            let loads = reduced.loads.iter().enumerate().map(|(body, load)| Load {
                body,
                force: load.wrench.force,
                torque: load.wrench.torque,
                at: None,
            });
            let loaded = Structure { loads: loads.collect(), ..reduced.structure.clone() };
            assess(&loaded, Question::VALUE).expect("sound").utilisation
        };
        let free = utilisation(0);
        let own = assess(&structure, Question::VALUE).expect("sound").utilisation;
        assert!((free.upper - own.upper).abs() <= 1e-6 && own.lower > 0.1, "{free:?} {own:?}");
        let mut helped = false;
        for mask in 0..32 {
            for more in (0..5).map(|link| mask | 1 << link) {
                let (less, more) = (utilisation(mask), utilisation(more));
                assert!(more.lower <= less.upper, "{mask:b}: {more:?} {less:?}");
                helped |= more.upper < 0.9 * less.lower;
            }
        }
        assert!(helped);
    }
}
