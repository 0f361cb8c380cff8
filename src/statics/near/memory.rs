//! What is kept of an answer, and found again in a neighbouring structure.

use std::collections::HashMap;

use crate::spatial::{Twist, Vec3, Wrench};

use super::super::assessment::Bracket;
use super::super::structure::{Anchor, Structure};
use super::super::validate::InvalidStructure;

/// How far a link or a body's centre of mass may have moved and still be the same
/// one, as a share of the distance between them: data that were computed anew.
const MOVED: f64 = 1e-6;

/// What a state near an assessed one can use of its answer.
///
/// A few vectors per body, connection and contact; it can be cloned, sent to other threads and
/// used for any number of neighbours.
#[derive(Clone, Debug)]
pub struct Memory {
    pub(super) utilisation: Bracket,
    pub(super) bodies: Vec<Known>,
    pub(super) links: Vec<Held>,
}

/// A body and its motion.
#[derive(Clone, Copy, Debug)]
pub(super) struct Known {
    pub com: Vec3,
    /// Twist of its centre of mass in W in the mechanism of its block, carried
    /// along by that of the block it hangs from.
    pub twist: Twist,
}

/// A connection or contact and what it carried.
#[derive(Clone, Copy, Debug)]
pub(super) struct Held {
    pub ends: [Anchor; 2],
    /// The connector's index; `None` for a contact.
    pub connector: Option<usize>,
    pub at: Vec3,
    /// On the child or the contact's body, about `at`, in W.
    pub wrench: Wrench,
}

/// Why a structure could not be assessed as a neighbour.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum NotNear {
    /// The structure is not sound.
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
                write!(f, "matching[{body}] is {entry}, the remembered structure has {remembered} bodies")
            }
        }
    }
}

impl std::error::Error for NotNear {}

/// Every connection, then every contact, carrying nothing.
pub(super) fn links(structure: &Structure) -> Vec<Held> {
    let connections = structure.connections.iter().map(|connection| Held {
        ends: [connection.parent, connection.child],
        connector: Some(connection.connector),
        at: connection.frame.translation.vector,
        wrench: Wrench::ZERO,
    });
    let contacts = structure.contacts.iter().map(|contact| Held {
        ends: [contact.against, Anchor::Body(contact.body)],
        connector: None,
        at: contact.position,
        wrench: Wrench::ZERO,
    });
    connections.chain(contacts).collect()
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

    /// The twist of every body that is still where it was.
    pub(super) fn twists(&self, structure: &Structure, matching: &[Option<usize>]) -> Vec<Option<Twist>> {
        let bodies = structure.bodies.iter().zip(matching);
        bodies
            .map(|(body, known)| {
                let known = &self.bodies[(*known)?];
                (body.com == known.com).then_some(known.twist)
            })
            .collect()
    }

    /// Gives every link of `links` the wrench that it carried, if it was there.
    pub(super) fn recall(&self, links: &mut [Held], matching: &[Option<usize>]) {
        let known = |anchor: Anchor| match anchor {
            Anchor::World => Some(Anchor::World),
            Anchor::Body(body) => matching[body].map(Anchor::Body),
        };
        // Mostly the next link is the next one there too.
        let mut next = 0;
        let mut index: Option<HashMap<([Anchor; 2], Option<usize>), Vec<usize>>> = None;
        for link in links {
            let [Some(a), Some(b)] = link.ends.map(known) else { continue };
            let same = |old: &Held| {
                old.ends == [a, b]
                    && old.connector == link.connector
                    && (old.at - link.at).norm() <= MOVED * (1e-3 + link.at.norm())
            };
            let close = (next..self.links.len().min(next + 3)).find(|&i| same(&self.links[i]));
            let found = close.or_else(|| {
                let index = index.get_or_insert_with(|| {
                    let mut index: HashMap<_, Vec<usize>> = HashMap::new();
                    for (i, old) in self.links.iter().enumerate() {
                        index.entry((old.ends, old.connector)).or_default().push(i);
                    }
                    index
                });
                index.get(&([a, b], link.connector))?.iter().copied().find(|&i| same(&self.links[i]))
            });
            if let Some(i) = found {
                link.wrench = self.links[i].wrench;
                next = i + 1;
            }
        }
    }
}
