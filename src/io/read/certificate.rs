//! `certificate/1` to a certificate with names.
//!
//! Whether it proves what it claims is for the checker to say.

use super::super::certificate_document::CertificateDocument;
use super::super::codes;
use super::super::findings::{Findings, Place};
use super::super::wire;
use super::super::write::certificate_checksum;
use super::decode::decode;
use super::rotation::vector;
use super::structure;
use crate::certificate::{Carried, Certificate, Mechanism, Stress};
use crate::spatial::{Twist, Wrench};
use crate::statics::{Bracket, Verdict};

pub(super) fn read(root: &Place<'_>, findings: &mut Findings) -> Option<CertificateDocument> {
    let wire: wire::Certificate = decode("certificate", root, findings)?;
    let named = structure::read(&root.key("structure"), findings)?;
    if certificate_checksum(&wire).is_ok_and(|made| made != wire.checksum_sha256.to_ascii_lowercase()) {
        let hint = "the file was damaged or altered after it was written: make the certificate anew";
        let message = "is not the checksum of what the certificate says";
        findings.add(&root.key("checksum_sha256"), codes::CHECKSUM, message, hint.to_string());
    }
    let certificate = Certificate {
        structure: named.structure.clone(),
        verdict: match wire.verdict {
            wire::Verdict::Stable => Verdict::Stable,
            wire::Verdict::InternallyUnstable => Verdict::InternallyUnstable,
            wire::Verdict::WholeBodyUnstable => Verdict::WholeBodyUnstable,
            wire::Verdict::Undecided => Verdict::Undecided,
        },
        // A lower end that says nothing is 0, since no utilisation is negative.
        utilisation: wire.utilisation.map_or(Bracket::exact(f64::INFINITY), |bracket| {
            Bracket::new(bracket.lower.0.unwrap_or(0.0), bracket.upper.0.unwrap_or(f64::INFINITY))
        }),
        stress: wire.stress.as_ref().map(stress),
        mechanism: wire.mechanism.as_ref().map(mechanism),
    };
    Some(CertificateDocument::new(&named, certificate))
}

fn stress(wire: &wire::Stress) -> Stress {
    let carried = |wire: &wire::Carried| match wire {
        wire::Carried::Wrench(wrench) => Carried::Wrench(Wrench::new(vector(wrench.force_n), vector(wrench.torque_nm))),
        wire::Carried::Points(points) => Carried::Points {
            preload: points.preload_n.0,
            forces: points.forces_n.iter().copied().map(vector).collect(),
        },
    };
    Stress {
        connections: wire.connections.iter().map(carried).collect(),
        contacts: wire.contact_forces_n.iter().copied().map(vector).collect(),
    }
}

fn mechanism(wire: &wire::Mechanism) -> Mechanism {
    let twist = |wire: &wire::Twist| Twist::new(vector(wire.linear_m_s), vector(wire.angular_rad_s));
    Mechanism { about: vector(wire.about_m), twists: wire.twists.iter().map(twist).collect() }
}
