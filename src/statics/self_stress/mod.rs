//! Whether a structure stands only by squeeze between contacts that nothing produces.
//!
//! Equilibrium of forces lets rigid contacts clamp: a block between two walls "stands" when the
//! walls press on it hard enough for friction to carry it, although nothing makes them press. The
//! walls need not be immovable: heavy pillars can be "pressed apart" by as much as friction holds
//! their feet. Two questions are asked, the cheap one first:
//!
//! 1. *Can anything but the loads press?* If lifting every body by its height, with all that is connected to it,
//!    opens every contact faster than friction widens its cone, no: in any balance the pressures, each times the
//!    speed of that opening, add up to at most what the loads do in that motion (`lift`). That settles
//!    robots on the ground and stacks, and costs nothing.
//! 2. *Do finite stiffnesses produce what is needed?* From a state without any stress, every
//!    contact and connection is as stiff as every other, presses only by as much as its bodies
//!    approach, carries shear by as much as they slide against each other, up to friction, and a
//!    connection up to its strength. If that has a state of balance, nothing else is relied on (`elastic`).
//!
//! The law of the second question is Coulomb's, in which sliding does not open a contact. The
//! cone program of least elastic energy has another law, in which sliding at friction mu lifts the bodies off each
//! other by mu times the way: in it a block that slides between walls wedges itself. So a gap is
//! given back to each contact, and solved again,
//!
//! ```text
//! minimise  sum |f|^2 / 2k + sum gap_c f_n,c   subject to  balance, cones;   gap_c <- mu |slip_c|
//! ```
//!
//! until gaps stay (De Saxce and Feng 1998; the iteration is that of Cadoux 2009 and of
//! Acary, Cadoux, Lemarechal and Malick 2011). Where a wedge of taper `theta` holds, gaps converge like powers of
//! `mu / (mu + tan theta)`; where nothing produces the squeeze they grow for ever. A contact that slides by more than a
//! hundred times its own approach, and goes on as steadily as it began, counts as that: a wedge of a third of a degree.
//!
//! This is a statement on equilibrium of forces, not a proof of instability: walls that are really
//! pressed together do hold a block. Nor does "not relied on" prove that the real contacts, of
//! unlike stiffness and history, find such a state. All loads are applied at once, and slip is
//! measured from the start to the end of that.

mod elastic;
mod lift;

use super::blocks::{Block, Link, cut};
use super::loads::{BodyLoad, lump, own_loads};
use super::rigid_links::Merged;
use super::structure::Structure;
use super::validate::{InvalidStructure, validate};

/// Whether a structure that stands relies on contacts that press on each other though nothing makes them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SelfStress {
    /// Nothing but the loads could press on any contact.
    Impossible,
    /// Contacts might press on each other otherwise, but those forces that finite stiffnesses produce hold the structure.
    NotNeeded,
    /// The structure stands, if at all, by squeeze that nothing produces.
    ReliedOn,
    /// Neither was found.
    Undecided,
}

impl SelfStress {
    /// Whether it is relied on; `None` when that is not known.
    pub fn is_relied_on(self) -> Option<bool> {
        match self {
            Self::Impossible | Self::NotNeeded => Some(false),
            Self::ReliedOn => Some(true),
            Self::Undecided => None,
        }
    }

    /// The answer for a whole of which one part gives this and another `other`.
    fn with(self, other: Self) -> Self {
        let weight = |stress: Self| match stress {
            Self::Impossible => 0,
            Self::NotNeeded => 1,
            Self::Undecided => 2,
            Self::ReliedOn => 3,
        };
        if weight(other) > weight(self) { other } else { self }
    }
}

/// Whether `structure`, which is assumed to stand at its rated strengths, does so only by squeeze
/// between contacts that nothing produces: see the module's header for what that means and what
/// it does not.
///
/// # Errors
/// As for [`assess`](super::assess()).
pub fn contact_self_stress(structure: &Structure) -> Result<SelfStress, Vec<InvalidStructure>> {
    validate(structure)?;
    if structure.contacts.is_empty() {
        return Ok(SelfStress::Impossible);
    }
    let merged = Merged::new(structure);
    let structure = merged.as_ref().map_or(structure, |merged| &merged.structure);
    let pieces = cut(structure);
    let loads = lump(structure, &pieces.blocks, own_loads(structure));
    let blocks = pieces.blocks.iter().map(|block| of_block(structure, block, &loads));
    Ok(blocks.fold(SelfStress::Impossible, SelfStress::with))
}

fn of_block(structure: &Structure, block: &Block, loads: &[BodyLoad]) -> SelfStress {
    let touches = block.links.iter().any(|link| matches!(link, Link::Contact(_)));
    let loaded = block.bodies.iter().any(|&body| !loads[body].is_zero());
    if block.links.len() < 2 || !touches || !loaded || lift::opens(structure, block) {
        return SelfStress::Impossible;
    }
    elastic::settle(structure, block, loads)
}
