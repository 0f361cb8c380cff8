//! Certificates of the oracle's answers: they verify, and they hold the truth.

#[path = "support/families.rs"]
mod families;
#[path = "support/random.rs"]
mod random;

use random::{Kind, Recipe, structure};
use steadfast::certificate::{check, issue};
use steadfast::io::{SourceFile, read_structure};
use steadfast::statics::{Question, Structure, assess};

fn try_one(name: &str, structure: &Structure) -> Option<bool> {
    let answer = assess(structure, Question::VALUE).unwrap();
    let clock = std::time::Instant::now();
    match issue(structure, &answer) {
        Ok(certificate) => {
            let issued = clock.elapsed();
            let clock = std::time::Instant::now();
            let proof = check(&certificate).unwrap();
            let (w, g) = (certificate.utilisation, answer.utilisation);
            let room = |a: f64, b: f64| if a == b { 0.0 } else { a - b };
            println!("ok {name} {:?} forgiven {:e} lower {:e} upper {:e} {issued:?} {:?}", answer.verdict, proof.forgiven,
                room(g.lower, w.lower), room(w.upper, g.upper), clock.elapsed());
            Some(true)
        }
        Err(refused) => {
            println!("NO {name} {:?} {:?}: {refused}", answer.verdict, answer.utilisation);
            Some(false)
        }
    }
}

#[test]
fn explore() {
    let manifest = problems::manifest().unwrap();
    for (name, _) in &manifest.structures {
        let path = problems::root().join("structures").join(format!("{name}.json"));
        let named = read_structure(&SourceFile::new(name.clone(), std::fs::read(path).unwrap())).unwrap();
        try_one(name, &named.structure);
    }
    for kind in Kind::ALL {
        let (mut ok, mut total) = (0, 0);
        for seed in 0..30 {
            let recipe = Recipe { kind, bodies: 1 + (seed as usize * 7) % 13, seed };
            total += 1;
            ok += usize::from(try_one(&format!("{recipe:?}"), &structure(&recipe)) == Some(true));
        }
        println!("== {kind:?} {ok} of {total}");
    }
    for n in [1000, 10_000] {
        try_one(&format!("cantilever {n}"), &families::cantilever(n).0);
        try_one(&format!("chains {n}"), &families::two_chains(n / 10, [0.4, 0.4], 1.0, 1000.0).0);
    }
}
