//! A certificate with names to `certificate/1`.

use sha2::{Digest, Sha256};

use super::super::certificate_document::CertificateDocument;
use super::super::wire::{self, NonNegative};
use super::{Unwritable, bracket, check, structure, vector};
use crate::certificate::{Carried, Mechanism, Stress};
use crate::statics::Verdict;

pub(super) fn wire(document: &CertificateDocument) -> Result<wire::Certificate, Unwritable> {
    let certificate = &document.certificate;
    let mut wire = wire::Certificate {
        format: wire::CertificateFormat::V1,
        checksum_sha256: String::new(),
        verdict: check::verdict(certificate.verdict),
        utilisation: (certificate.verdict != Verdict::WholeBodyUnstable).then(|| bracket(certificate.utilisation)),
        structure: structure::wire(&document.named()),
        stress: certificate.stress.as_ref().map(stress),
        mechanism: certificate.mechanism.as_ref().map(mechanism),
    };
    wire.checksum_sha256 = checksum(&wire)?;
    Ok(wire)
}

/// Checksum of all that a certificate says, whatever checksum it has.
pub(in super::super) fn checksum(wire: &wire::Certificate) -> Result<String, Unwritable> {
    let blank = wire::Certificate { checksum_sha256: String::new(), ..wire.clone() };
    let text = serde_json::to_string(&blank).map_err(Unwritable::new)?;
    Ok(Sha256::digest(text).iter().map(|byte| format!("{byte:02x}")).collect())
}

fn stress(stress: &Stress) -> wire::Stress {
    let carried = |carried: &Carried| match carried {
        Carried::Wrench(wrench) => wire::Carried::Wrench(wire::CarriedWrench {
            force_n: vector(wrench.force),
            torque_nm: vector(wrench.torque),
        }),
        Carried::Points { preload, forces } => wire::Carried::Points(wire::CarriedPoints {
            preload_n: NonNegative(*preload),
            forces_n: forces.iter().copied().map(vector).collect(),
        }),
    };
    wire::Stress {
        connections: stress.connections.iter().map(carried).collect(),
        contact_forces_n: stress.contacts.iter().copied().map(vector).collect(),
    }
}

fn mechanism(mechanism: &Mechanism) -> wire::Mechanism {
    let twists = mechanism.twists.iter();
    wire::Mechanism {
        about_m: vector(mechanism.about),
        twists: twists
            .map(|twist| wire::Twist { linear_m_s: vector(twist.linear), angular_rad_s: vector(twist.angular) })
            .collect(),
    }
}
