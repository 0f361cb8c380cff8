//! A thousand tampered certificates, none of which verifies.
//!
//! Each is written and read like any other, with the checksum of its own text, so that
//! nothing but the proof stands against it.

use std::collections::BTreeMap;

use steadfast::certificate::{Certificate, check};
use steadfast::io::{CertificateDocument, SourceFile, read_certificate, write_certificate};

use crate::random::{Kind, Random, Recipe, structure};
use crate::{certify, library, named, tampers};

/// How many are tampered with.
const TAMPERED: usize = 1000;

/// Certificates of all verdicts, with brackets that are tight.
pub fn certificates() -> Vec<Certificate> {
    let names = ["cantilever_box_10", "hang_nine_parallel", "incline_mu0.5_26.0", "ladder_44.0", "ladder_46.0"];
    let more = ["overhang_in", "overhang_out", "two_chains_10", "suspension_76", "frictionless_level"];
    let known = names.iter().chain(&more).map(|name| library(name).structure);
    let recipes = Kind::ALL
        .into_iter()
        .flat_map(|kind| (0..6).map(move |seed| Recipe { kind, bodies: 2 + seed as usize, seed: 1000 + seed }));
    let all = known.chain(recipes.map(|recipe| structure(&recipe)));
    let certified = all.filter_map(|structure| certify(&structure).ok());
    let tight = |c: &Certificate| {
        let bracket = c.utilisation;
        bracket.lower == bracket.upper || bracket.width() <= 1e-5 * bracket.upper.max(1.0)
    };
    certified.filter(tight).collect()
}

#[test]
fn a_thousand_tampered_certificates_are_rejected() {
    let certificates = certificates();
    assert!(certificates.len() >= 50, "{} certificates", certificates.len());
    let mut random = Random::new(7);
    let mut count = BTreeMap::<&str, usize>::new();
    for (what, tamper) in tampers::ALL.into_iter().cycle().take(TAMPERED) {
        let (original, changed) = (0..10_000)
            .find_map(|_| {
                let original = &certificates[random.below(certificates.len())];
                Some((original, tamper(original.clone(), &mut random)?))
            })
            .unwrap_or_else(|| panic!("{what}: no certificate has anything of the kind"));
        let document = CertificateDocument::new(&named(&changed.structure), changed);
        let text = write_certificate(&document).unwrap();
        let read = read_certificate(&SourceFile::new("tampered.json", text)).unwrap();
        if let Ok(proof) = check(&read.certificate) {
            panic!("{what}: {proof:?} is accepted of {:#?}\nmade from {original:#?}", read.certificate);
        }
        *count.entry(what).or_default() += 1;
    }
    assert_eq!((count.len(), count.values().sum::<usize>()), (tampers::ALL.len(), TAMPERED), "{count:?}");
}
