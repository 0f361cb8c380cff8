//! What is kept of an answer, and found again in a neighbouring structure.

use std::collections::HashMap;
use std::sync::Arc;

use crate::spatial::{Twist, Vec3, Wrench};

use super::super::assessment::Bracket;
use super::super::structure::{Anchor, Structure};
use super::super::validate::InvalidStructure;
use super::give::Give;

/// How far a body or link may be from where it was and still count as there,
/// relative to its distance from the origin: positions that were computed anew.
const MOVED: f64 = 1e-9;

/// What a state near an assessed one can use of its answer.
///
/// A few vectors per body, connection and contact, and a factored matrix per block with
/// cycles, which clones and neighbours share. Immutable data: it can be cloned, sent to other
/// threads, and used for any number of neighbours.
#[derive(Clone, Debug)]
pub struct Memory {
    pub(super) utilisation: Bracket,
    pub(super) bodies: Vec<Known>,
    pub(super) links: Vec<Held>,
    /// In the order of their first bodies.
    pub(super) springs: Vec<Springs>,
}

/// How a block gave way when it was last balanced.
#[derive(Clone, Debug)]
pub(super) struct Springs {
    pub bodies: Vec<usize>,
    /// Per spring its link, of all connections, then contacts, in ascending order, and its
    /// number in `give`.
    pub links: Vec<(usize, usize)>,
    pub give: Arc<Give>,
}

/// A body and its motion.
#[derive(Clone, Copy, Debug)]
pub(super) struct Known {
    pub com: Vec3,
    /// Twist of its centre of mass in W: in the mechanism of its block, carried
    /// along by the mechanism of the block that this one hangs from.
    pub twist: Twist,
}

/// A connection or contact and what it carried.
#[derive(Clone, Debug)]
pub(super) struct Held {
    pub ends: [Anchor; 2],
    /// The connector's index; `None` for a contact.
    pub connector: Option<usize>,
    pub at: Vec3,
    /// On the child or the contact's body, about `at`, in W.
    pub wrench: Wrench,
    /// Of a face, what its points carried, in W; empty where that is not known.
    pub points: Vec<Vec3>,
}

/// Why a structure could not be assessed as a neighbour.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum NotNear {
    /// The structure cannot be assessed at all.
    Structure(Vec<InvalidStructure>),
    /// The matching has not one entry per body of the structure.
    Length {
        /// Entries of the matching.
        entries: usize,
        /// Bodies of the structure.
        bodies: usize,
    },
    /// The matching names a body that the remembered structure does not have.
    NoSuchBody {
        /// The body of the structure whose entry it is.
        body: usize,
        /// The entry.
        entry: usize,
        /// Bodies of the remembered structure.
        remembered: usize,
    },
}

impl std::fmt::Display for NotNear {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Structure(faults) => {
                let texts: Vec<String> = faults.iter().map(ToString::to_string).collect();
                f.write_str(&texts.join("; "))
            }
            Self::Length { entries, bodies } => {
                write!(f, "the matching has {entries} entries for {bodies} bodies")
            }
            Self::NoSuchBody { body, entry, remembered } => {
                write!(f, "matching[{body}] is {entry}, but the remembered structure has {remembered} bodies")
            }
        }
    }
}

impl std::error::Error for NotNear {}

/// Every connection, then every contact, carrying nothing.
pub(super) fn idle_links(structure: &Structure) -> Vec<Held> {
    let connections = structure.connections.iter().map(|connection| Held {
        ends: [connection.parent, connection.child],
        connector: Some(connection.connector),
        at: connection.frame.translation.vector,
        wrench: Wrench::ZERO,
        points: Vec::new(),
    });
    let contacts = structure.contacts.iter().map(|contact| Held {
        ends: [contact.against, Anchor::Body(contact.body)],
        connector: None,
        at: contact.position,
        wrench: Wrench::ZERO,
        points: Vec::new(),
    });
    connections.chain(contacts).collect()
}

fn still_there(before: &Vec3, now: &Vec3) -> bool {
    (before - now).norm_squared() <= MOVED * MOVED * now.norm_squared()
}

impl Memory {
    /// Refuses a matching that does not fit.
    pub(super) fn check(&self, structure: &Structure, matching: &[Option<usize>]) -> Result<(), NotNear> {
        let bodies = structure.bodies.len();
        if matching.len() != bodies {
            return Err(NotNear::Length { entries: matching.len(), bodies });
        }
        let remembered = self.bodies.len();
        let wrong = matching.iter().enumerate().find_map(|(body, entry)| {
            entry.filter(|&entry| entry >= remembered).map(|entry| NotNear::NoSuchBody { body, entry, remembered })
        });
        wrong.map_or(Ok(()), Err)
    }

    /// The twist of every body that is where it was.
    pub(super) fn twists(&self, structure: &Structure, matching: &[Option<usize>]) -> Vec<Option<Twist>> {
        let bodies = structure.bodies.iter().zip(matching);
        bodies
            .map(|(body, entry)| {
                let known = &self.bodies[(*entry)?];
                still_there(&known.com, &body.com).then_some(known.twist)
            })
            .collect()
    }

    /// The springs between bodies, which come in their order.
    pub(super) fn springs(&self, bodies: &[usize]) -> Option<&Springs> {
        let first = bodies.first()?;
        let found = self.springs.binary_search_by_key(first, |springs| springs.bodies[0]).ok()?;
        Some(&self.springs[found]).filter(|springs| springs.bodies == bodies)
    }

    /// The links of `structure`, each with what it carried if it was there, and which
    /// one that was.
    pub(super) fn links(&self, structure: &Structure, matching: &[Option<usize>]) -> (Vec<Held>, Vec<Option<usize>>) {
        let mut links = idle_links(structure);
        let mut before = vec![None; links.len()];
        let known = |anchor: Anchor| match anchor {
            Anchor::World => Some(Anchor::World),
            Anchor::Body(body) => matching[body].map(Anchor::Body),
        };
        // Mostly the next one here is the next, or the next but one, there.
        let mut next = 0;
        let mut by_ends = None;
        for (link, known_as) in links.iter_mut().zip(&mut before) {
            let [Some(a), Some(b)] = link.ends.map(known) else { continue };
            let same = |i: &usize| {
                let before = &self.links[*i];
                before.ends == [a, b] && before.connector == link.connector && still_there(&before.at, &link.at)
            };
            let in_turn = (next..self.links.len().min(next + 2)).find(same);
            let found = in_turn.or_else(|| {
                let by_ends = by_ends.get_or_insert_with(|| self.by_ends());
                by_ends.get(&[a, b])?.iter().copied().find(same)
            });
            if let Some(i) = found {
                link.wrench = self.links[i].wrench;
                link.points.clone_from(&self.links[i].points);
                *known_as = found;
                next = i + 1;
            }
        }
        (links, before)
    }

    fn by_ends(&self) -> HashMap<[Anchor; 2], Vec<usize>> {
        let mut index: HashMap<_, Vec<usize>> = HashMap::with_capacity(self.links.len());
        for (i, link) in self.links.iter().enumerate() {
            index.entry(link.ends).or_default().push(i);
        }
        index
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spatial::Pose;
    use crate::statics::structure::{Body, Connection, Contact};

    /// Three bodies in a row, joined by two connections at each of two places, and
    /// two contacts.
    fn row() -> Structure {
        let mut row = Structure::default();
        for x in 0..3 {
            row.bodies.push(Body { mass: 1.0, com: Vec3::new(f64::from(x), 0.0, 1.0), fixed: false });
        }
        for (parent, child) in [(0, 1), (1, 2)] {
            for y in [-0.1, 0.1] {
                let frame = Pose::translation(parent as f64 + 0.5, y, 1.0);
                let (parent, child) = (Anchor::Body(parent), Anchor::Body(child));
                row.connections.push(Connection { parent, child, connector: 0, frame });
            }
        }
        for x in [-0.1, 0.1] {
            let position = Vec3::new(x, 0.0, 0.5);
            let (against, normal) = (Anchor::World, Vec3::z());
            row.contacts.push(Contact { body: 0, against, position, normal, friction: 0.5 });
        }
        row
    }

    /// A memory in which link `i` carries `i + 1` newtons and body `i` moves at `i + 1` m/s.
    fn memory(structure: &Structure) -> Memory {
        let mut links = idle_links(structure);
        for (i, link) in links.iter_mut().enumerate() {
            link.wrench.force.x = (i + 1) as f64;
        }
        let bodies = structure.bodies.iter().enumerate();
        let known = |(i, body): (usize, &Body)| Known {
            com: body.com,
            twist: Twist::new(Vec3::x() * (i + 1) as f64, Vec3::zeros()),
        };
        let bodies = bodies.map(known).collect();
        Memory { utilisation: Bracket::exact(0.5), bodies, links, springs: Vec::new() }
    }

    fn carried(memory: &Memory, structure: &Structure, matching: &[Option<usize>]) -> Vec<f64> {
        memory.links(structure, matching).0.iter().map(|link| link.wrench.force.x).collect()
    }

    #[test]
    fn links_are_found_wherever_they_went_in_the_list() {
        let before = row();
        let memory = memory(&before);
        let same = [Some(0), Some(1), Some(2)];
        assert_eq!(carried(&memory, &before, &same), [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
        let mut now = before.clone();
        now.connections.remove(1);
        now.connections.reverse();
        now.contacts.swap(0, 1);
        assert_eq!(carried(&memory, &now, &same), [4.0, 3.0, 1.0, 6.0, 5.0]);
    }

    #[test]
    fn links_of_other_bodies_places_or_connectors_carry_nothing() {
        let before = row();
        let memory = memory(&before);
        assert_eq!(carried(&memory, &before, &[Some(0), None, Some(2)]), [0.0, 0.0, 0.0, 0.0, 5.0, 6.0]);
        assert_eq!(carried(&memory, &before, &[Some(2), Some(1), Some(0)]), [0.0; 6]);
        let mut now = before.clone();
        now.connections[0].frame.translation.vector.y += 1e-6;
        now.connections[1].connector = 1;
        now.contacts[1].position.x *= 1.0 + 1e-15;
        let same = [Some(0), Some(1), Some(2)];
        assert_eq!(carried(&memory, &now, &same), [0.0, 0.0, 3.0, 4.0, 5.0, 6.0]);
    }

    #[test]
    fn bodies_that_moved_have_no_twist() {
        let before = row();
        let mut now = before.clone();
        now.bodies[1].com.z += 0.1;
        let twists = memory(&before).twists(&now, &[Some(2), Some(1), None]);
        assert!(twists.iter().all(Option::is_none));
        let twists = memory(&before).twists(&now, &[Some(0), Some(1), Some(2)]);
        let speeds: Vec<_> = twists.iter().map(|twist| twist.map(|t| t.linear.x)).collect();
        assert_eq!(speeds, [Some(1.0), None, Some(3.0)]);
    }
}
