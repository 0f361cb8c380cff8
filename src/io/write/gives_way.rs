//! What gives way in a mechanism, by name.

use super::super::document::NamedStructure;
use super::super::wire;
use crate::statics::{Assessment, ContactMotion, contact_motions};

/// What gives way in the mechanism of an assessment of the structure, or of the same with more
/// connections and loads, which have no names.
pub(super) fn wire(named: &NamedStructure, assessment: &Assessment) -> wire::GivesWay {
    let connections = named.connections.iter().zip(&assessment.connections);
    let motions = contact_motions(&named.structure, assessment);
    let contacts = named.contacts.iter().zip(motions).filter_map(|(id, motion)| {
        let motion = match motion {
            ContactMotion::Rests => return None,
            ContactMotion::Slides => wire::ContactMotion::Slides,
            ContactMotion::Opens => wire::ContactMotion::Opens,
        };
        Some(wire::MovingContact { id: id.clone(), motion })
    });
    wire::GivesWay {
        contacts: contacts.collect(),
        connections: connections.filter(|(_, state)| state.critical).map(|(id, _)| id.clone()).collect(),
    }
}
