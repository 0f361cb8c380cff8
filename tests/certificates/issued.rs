//! What the oracle answers is certified, and the certified bracket holds the truth.

use std::time::{Duration, Instant};

use steadfast::certificate::check;
use steadfast::statics::{Bracket, Question, Structure, Verdict, assess};

use crate::random::{Kind, Recipe, structure};
use crate::{certify, families, library};

#[test]
fn every_structure_of_the_library_is_certified() {
    for (name, case) in problems::manifest().unwrap().structures {
        let named = library(&name);
        let certificate = certify(&named.structure).unwrap_or_else(|refused| panic!("{name}: {refused}"));
        let proof = check(&certificate).unwrap_or_else(|faults| panic!("{name}: {faults:?}"));
        let Bracket { lower, upper } = certificate.utilisation;
        assert!(lower <= proof.utilisation.lower && proof.utilisation.upper <= upper, "{name}");
        match case.utilisation {
            Some(expected) => {
                let room = case.rtol * expected.max(1.0);
                assert!(lower - room <= expected && expected <= upper + room, "{name}: {expected}, [{lower}, {upper}]");
                assert!(upper - lower <= 1e-6 * expected.max(1.0), "{name}: [{lower}, {upper}]");
            }
            None => assert_eq!(certificate.verdict, Verdict::WholeBodyUnstable, "{name}"),
        }
    }
}

fn holds((structure, expected): (Structure, f64), what: &str) {
    let certificate = certify(&structure).unwrap_or_else(|refused| panic!("{what}: {refused}"));
    let Bracket { lower, upper } = certificate.utilisation;
    let room = 1e-12 * expected;
    assert!(
        lower == expected || lower <= expected + room && expected - room <= upper,
        "{what}: {expected} [{lower}, {upper}]"
    );
    assert!(lower == upper || upper - lower <= 1e-6 * expected.max(1.0), "{what}: [{lower}, {upper}]");
}

#[test]
fn certified_brackets_hold_what_follows_by_hand() {
    for count in [1, 10, 1000] {
        holds(families::cantilever(count), &format!("cantilever of {count}"));
        holds(families::hang(1.0, 100.0, count.min(20)), &format!("{count} magnets"));
    }
    for ratio in [1.0, 1e6, 1e12] {
        holds(families::series([1e3, 1e3 / ratio], [1e9, 1e9 / ratio]), &format!("series {ratio}"));
    }
    for (masses, strength) in [([0.4, 0.4], 1e3), ([1e-3, 1e3], 1e6)] {
        holds(families::two_chains(50, masses, 1.0, strength), &format!("two chains of {masses:?}"));
    }
    for off in [1e-2, 1e-6] {
        for side in [1.0 - off, 1.0 + off] {
            holds(families::incline(0.5, f64::atan(0.5).to_degrees() * side), &format!("incline, {side}"));
            holds(families::ladder(0.5, 45.0 * side), &format!("ladder, {side}"));
            holds(families::overhang(20, side), &format!("stack, {side}"));
            holds(families::hang(1.0, families::G * side, 1), &format!("knife's edge, {side}"));
        }
    }
}

/// Brackets of random structures verify, and are hardly wider than the oracle's.
#[test]
fn random_structures_are_certified() {
    let (mut certified, mut refusals) = (0, Vec::new());
    for kind in Kind::ALL {
        for seed in 0..30 {
            let recipe = Recipe { kind, bodies: 1 + (seed as usize * 7) % 13, seed };
            match certify(&structure(&recipe)) {
                Ok(certificate) => {
                    check(&certificate).unwrap_or_else(|faults| panic!("{recipe:?}: {faults:?}"));
                    certified += 1;
                }
                Err(refused) => refusals.push((recipe, refused.to_string())),
            }
        }
    }
    assert!(refusals.len() * 50 <= certified, "{refusals:#?}");
}

#[test]
fn long_trees_verify_in_well_under_a_second() {
    let (structure, expected) = families::cantilever(10_000);
    let certificate = certify(&structure).unwrap();
    let clock = Instant::now();
    let proof = check(&certificate).unwrap();
    let elapsed = clock.elapsed();
    assert!(proof.utilisation.contains(expected) && proof.utilisation.width() <= 1e-9 * expected);
    assert_eq!(proof.forgiven, 0.0);
    assert!(elapsed < Duration::from_secs(2), "{elapsed:?}");
}

/// An answer to a mere decision is certified as far as it goes.
#[test]
fn decisions_are_certified_as_well() {
    for recipe in (0..20).map(|seed| Recipe { kind: Kind::Ordinary, bodies: 7, seed }) {
        let structure = structure(&recipe);
        let answer = assess(&structure, Question::Decide(1.0)).unwrap();
        if answer.verdict != Verdict::Undecided {
            let certificate = steadfast::certificate::issue(&structure, &answer).unwrap();
            assert_eq!(certificate.verdict, answer.verdict, "{recipe:?}");
        }
    }
}
