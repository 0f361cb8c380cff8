//! What is kept of an answer, and found again in a neighbouring structure.

use std::collections::HashMap;

use crate::spatial::{Twist, Vec3, Wrench};

use super::super::assessment::Bracket;
use super::super::structure::{Anchor, Structure};
use super::super::validate::InvalidStructure;

/// How far a body or link may be from where it was and still count as there,
/// relative to its distance from the origin: positions that were computed anew.
const MOVED: f64 = 1e-9;

/// What a state near an assessed one can use of its answer.
///
/// A few vectors per body, connection and contact. Plain owned data: it can be cloned, sent to
/// other threads, and used for any number of neighbours.
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
    /// Twist of its centre of mass in W: in the mechanism of its block, carried
    /// along by the mechanism of the block that this one hangs from.
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
    });
    let contacts = structure.contacts.iter().map(|contact| Held {
        ends: [contact.against, Anchor::Body(contact.body)],
        connector: None,
        at: contact.position,
        wrench: Wrench::ZERO,
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

    /// The links of `structure`, each with what it carried if it was there.
    pub(super) fn links(&self, structure: &Structure, matching: &[Option<usize>]) -> Vec<Held> {
        let mut links = idle_links(structure);
        let known = |anchor: Anchor| match anchor {
            Anchor::World => Some(Anchor::World),
            Anchor::Body(body) => matching[body].map(Anchor::Body),
        };
        // Mostly the next one here is the next, or the next but one, there.
        let mut next = 0;
        let mut by_ends = None;
        for link in &mut links {
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
                next = i + 1;
            }
        }
        links
    }

    fn by_ends(&self) -> HashMap<[Anchor; 2], Vec<usize>> {
        let mut index: HashMap<_, Vec<usize>> = HashMap::with_capacity(self.links.len());
        for (i, link) in self.links.iter().enumerate() {
            index.entry(link.ends).or_default().push(i);
        }
        index
    }
}
