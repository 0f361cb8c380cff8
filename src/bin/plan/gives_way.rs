//! What gives way in a mechanism, in words.

use steadfast::io::NamedStructure;
use steadfast::statics::{Assessment, ContactMotion, contact_motions};

use crate::explain::wrapped;

/// Most names that are listed.
const LISTED: usize = 8;

/// What breaks, slides and opens in the mechanism of an assessment, a line for each kind; empty
/// where nothing does.
pub fn gives_way(named: &NamedStructure, assessment: &Assessment) -> String {
    let critical = assessment.connections.iter().zip(&named.connections);
    let critical: Vec<&str> = critical.filter(|(state, _)| state.critical).map(|(_, id)| id.as_str()).collect();
    let motions = contact_motions(&named.structure, assessment);
    let moving = |wanted: ContactMotion| -> Vec<&str> {
        let contacts = named.contacts.iter().zip(&motions).filter(|(_, motion)| **motion == wanted);
        contacts.map(|(id, _)| id.as_str()).collect()
    };
    [
        ("connections that break", critical),
        ("contacts that slide", moving(ContactMotion::Slides)),
        ("contacts that open", moving(ContactMotion::Opens)),
    ]
    .into_iter()
    .filter(|(_, ids)| !ids.is_empty())
    .map(|(what, ids)| wrapped(&format!("{what}: {}", listed(&ids))))
    .collect()
}

/// The first names, and how many more there are.
pub fn listed(ids: &[&str]) -> String {
    let shown = ids.iter().take(LISTED).copied().collect::<Vec<_>>().join(", ");
    match ids.len().checked_sub(LISTED) {
        None | Some(0) => shown,
        Some(more) => format!("{shown} and {more} more"),
    }
}
