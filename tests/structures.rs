//! The oracle on every structure of the library, one test each.

use libtest_mimic::{Arguments, Failed, Trial};
use problems::StructureCase;
use steadfast::io::{SourceFile, read_structure};
use steadfast::statics::{Question, Verdict, assess, contact_self_stress};

fn main() {
    let manifest = problems::manifest().expect("the manifest is sound");
    let trials =
        manifest.structures.into_iter().map(|(name, case)| Trial::test(name.clone(), move || check(&name, &case)));
    libtest_mimic::run(&Arguments::from_args(), trials.collect()).exit();
}

fn check(name: &str, case: &StructureCase) -> Result<(), Failed> {
    let path = problems::root().join("structures").join(format!("{name}.json"));
    let named = read_structure(&SourceFile::new(name, std::fs::read(path)?))?;
    let answer = assess(&named.structure, Question::VALUE).map_err(|problems| format!("{problems:?}"))?;
    let verdict = match answer.verdict {
        Verdict::Stable => "stable",
        Verdict::InternallyUnstable => "internally-unstable",
        Verdict::WholeBodyUnstable => "whole-body-unstable",
        Verdict::Undecided => "undecided",
    };
    if verdict != case.verdict {
        let (found, why) = (answer.utilisation, answer.undecided_because);
        return Err(format!("expected {}, found {verdict}: {found:?} {why:?}", case.verdict).into());
    }
    if let Some(relies) = case.relies_on_contact_self_stress {
        let found = contact_self_stress(&named.structure).map_err(|problems| format!("{problems:?}"))?;
        if found.is_relied_on() != Some(relies) {
            return Err(format!("whether it relies on self-stress of contacts: expected {relies}, {found:?}").into());
        }
    }
    let Some(expected) = case.utilisation else { return Ok(()) };
    let (lower, upper) = (answer.utilisation.lower, answer.utilisation.upper);
    let tolerance = case.rtol * expected.abs().max(1.0);
    if !(lower - tolerance <= expected && expected <= upper + tolerance) {
        return Err(format!("{expected} is not in [{lower}, {upper}]").into());
    }
    let widest = 1e-6 * expected.max(1.0);
    if !(answer.utilisation.width() <= widest) {
        return Err(format!("the bracket [{lower}, {upper}] is wider than {widest}").into());
    }
    Ok(())
}
