//! Nothing that the oracle leaves out changes its answer: on random structures of
//! every kind, with some connections made unlimited, every reduction alone and all
//! together against none. Every answer is also judged from its fields alone.

#[path = "support/flat.rs"]
mod flat;
#[path = "support/random.rs"]
mod random;
#[path = "support/recheck.rs"]
mod recheck;

use flat::flat;
use random::{Kind, Random, Recipe, structure};
use recheck::recheck;
use steadfast::spatial::Vec3;
use steadfast::statics::{
    Anchor, Assessment, Bracket, Connector, Model, Question, Reductions, Rung, Structure, Verdict, assess,
    assess_reduced, explain,
};

/// Relative room for rounding in what is left of the data.
const ROOM: f64 = 1e-8;

/// Each reduction alone switched off, and all of them.
fn variants() -> [(&'static str, Reductions); 7] {
    let all = Reductions::ALL;
    [
        ("rigid links", Reductions { rigid_links: false, ..all }),
        ("blocks", Reductions { blocks: false, ..all }),
        ("closed form", Reductions { closed_form: false, ..all }),
        ("chains", Reductions { chains: false, ..all }),
        ("planar", Reductions { planar: false, ..all }),
        ("parallel", Reductions { parallel: false, ..all }),
        ("everything", Reductions::NONE),
    ]
}

fn unlimited() -> Connector {
    const NONE: f64 = f64::INFINITY;
    let model = Model::Box { shear: [NONE; 2], tension: NONE, compression: NONE, bending: [NONE; 2], torsion: NONE };
    Connector { name: "weld".to_owned(), strength: 1.0, model }
}

/// The structure with a share of its connections without limit.
fn welded(recipe: &Recipe, share: f64) -> Structure {
    let mut structure = structure(recipe);
    let mut random = Random::new(recipe.seed ^ 0xabcd);
    let weld = structure.connectors.len();
    structure.connectors.push(unlimited());
    for connection in &mut structure.connections {
        if random.chance(share) {
            connection.connector = weld;
        }
    }
    structure
}

fn may_be_equal(a: Bracket, b: Bracket) -> bool {
    let at_most = |a: Bracket, b: Bracket| a.lower <= b.upper * (1.0 + ROOM) + ROOM;
    at_most(a, b) && at_most(b, a)
}

fn ask(structure: &Structure, question: Question, reductions: Reductions) -> Assessment {
    assess_reduced(structure, question, reductions).expect("the generator makes valid structures")
}

/// Most of `count` random structures of every kind must be answered with either, and
/// no two answers may exclude each other.
fn agree(share: f64, seeds: std::ops::Range<u64>) {
    let (mut compared, mut wide) = (0, Vec::new());
    for kind in Kind::ALL {
        for seed in seeds.clone() {
            let recipe = Recipe { kind, bodies: 2 + seed as usize % 11, seed };
            let structure = welded(&recipe, share);
            let reduced = ask(&structure, Question::VALUE, Reductions::ALL);
            if let Err(fault) = recheck(&structure, &reduced) {
                panic!("{recipe:?}: {fault}");
            }
            for (name, reductions) in variants() {
                let full = ask(&structure, Question::VALUE, reductions);
                if let Err(fault) = recheck(&structure, &full) {
                    panic!("{recipe:?} without {name}: {fault}");
                }
                let (a, b) = (reduced.utilisation, full.utilisation);
                assert!(may_be_equal(a, b), "{recipe:?} without {name}: {a:?} and {b:?}");
                compared += 1;
                let open = |bracket: Bracket| bracket.upper.is_infinite() != bracket.lower.is_infinite();
                if open(b) && !open(a) {
                    wide.push((recipe, name, b));
                }
            }
        }
    }
    // Where a solver has to do what balance does exactly it may leave more open.
    assert!(wide.len() * 50 <= compared, "{} of {compared} left open: {wide:?}", wide.len());
}

#[test]
fn no_reduction_changes_the_answer() {
    agree(0.0, 0..6);
}

#[test]
fn no_reduction_changes_the_answer_where_links_are_unlimited() {
    agree(0.3, 10..16);
    agree(0.8, 20..22);
}

#[test]
fn verdicts_agree_however_they_are_found() {
    for kind in Kind::ALL {
        for seed in 40..44 {
            let recipe = Recipe { kind, bodies: 2 + seed as usize % 13, seed };
            let structure = welded(&recipe, 0.2);
            let reduced = ask(&structure, Question::Decide(1.0), Reductions::ALL);
            for (name, reductions) in variants() {
                let full = ask(&structure, Question::Decide(1.0), reductions);
                let (a, b) = (reduced.utilisation, full.utilisation);
                assert!(may_be_equal(a, b), "{recipe:?} without {name}: {a:?} and {b:?}");
            }
        }
    }
}

fn judged(structure: &Structure, reductions: Reductions, name: &str) -> Assessment {
    let answer = ask(structure, Question::VALUE, reductions);
    if let Err(fault) = recheck(structure, &answer) {
        panic!("{name}: {fault}");
    }
    answer
}

/// Structures in a plane of their own: no reduction changes what they need, and three balances
/// a body say as much of it as six.
#[test]
fn planar_structures_need_the_same_in_space() {
    const SEEDS: u64 = 150;
    let (mut planar, mut open, mut held) = (0, Vec::new(), 0);
    for seed in 0..SEEDS {
        let structure = flat(2 + seed as usize % 15, seed);
        let remaining = explain(&structure, Reductions::ALL).expect("valid").remaining;
        planar += usize::from(!remaining.is_empty() && remaining.iter().all(|block| block.is_planar()));
        let reduced = judged(&structure, Reductions::ALL, "reduced").utilisation;
        for (name, reductions) in variants() {
            let full = judged(&structure, reductions, name).utilisation;
            assert!(may_be_equal(reduced, full), "{seed} without {name}: {reduced:?} and {full:?}");
            let largest = reduced.upper.max(full.upper);
            let apart = largest - reduced.lower.min(full.lower);
            if largest.is_finite() && apart <= 1e-6 * largest.max(1.0) {
                held += 1;
            } else if !(reduced.lower.is_infinite() && full.lower.is_infinite()) {
                open.push((seed, name, reduced, full));
            }
        }
    }
    assert!(planar * 2 > SEEDS as usize, "{planar} planar structures");
    assert!(held > 300, "{held} compared");
    assert!(open.len() * 50 <= held, "{} of {held} left open: {open:?}", open.len());
}

/// Where a plane is hardly left, within what counts as planar or beyond it, what is proved is
/// proved for the structure as it is.
#[test]
fn nearly_planar_structures_have_sound_brackets() {
    let mut nearly = 0;
    for seed in 0..40 {
        let exact = flat(3 + seed as usize % 9, seed);
        let from_exact = judged(&exact, Reductions::ALL, "exact").utilisation;
        for off in [1e-11, 1e-10, 1e-9, 1e-8] {
            let mut structure = exact.clone();
            for (index, body) in structure.bodies.iter_mut().enumerate() {
                body.com += Vec3::new(0.6, 0.64, -0.48) * (off * [1.0, -0.5, 0.3][index % 3]);
            }
            for contact in structure.contacts.iter_mut().step_by(2) {
                contact.position += Vec3::new(-0.48, 0.6, 0.64) * off;
            }
            let remaining = explain(&structure, Reductions::ALL).expect("valid").remaining;
            nearly += usize::from(remaining.iter().any(|block| block.is_planar()));
            let reduced = judged(&structure, Reductions::ALL, "reduced").utilisation;
            let space = Reductions { planar: false, ..Reductions::ALL };
            let full = judged(&structure, space, "in space").utilisation;
            assert!(may_be_equal(reduced, full), "{seed}, {off}: {reduced:?} and {full:?}");
            if from_exact.upper.is_finite() && reduced.upper.is_finite() {
                let room = 1e-5 * from_exact.upper.max(1.0);
                assert!(reduced.lower <= from_exact.upper + room, "{seed}, {off}: {reduced:?} and {from_exact:?}");
                assert!(from_exact.lower <= reduced.upper + room, "{seed}, {off}: {reduced:?} and {from_exact:?}");
            }
        }
    }
    assert!(nearly > 10, "{nearly} of these count as planar");
}

/// Rings that hang from the ground one beside the other, each of which some strength holds: as many blocks.
fn rings(count: usize) -> Structure {
    let mut all = Structure::default();
    let candidates = (0..).map(|seed| structure(&Recipe { kind: Kind::Redundant, bodies: 6, seed }));
    let holds = |one: &Structure| assess(one, Question::VALUE).expect("valid").utilisation.upper.is_finite();
    for one in candidates.filter(holds).take(count) {
        let (bodies, connectors) = (all.bodies.len(), all.connectors.len());
        let anchor = |anchor: Anchor| match anchor {
            Anchor::World => Anchor::World,
            Anchor::Body(i) => Anchor::Body(i + bodies),
        };
        all.gravity = one.gravity;
        all.bodies.extend(one.bodies);
        all.connectors.extend(one.connectors);
        all.connections.extend(one.connections.into_iter().map(|mut connection| {
            (connection.parent, connection.child) = (anchor(connection.parent), anchor(connection.child));
            connection.connector += connectors;
            connection
        }));
        all.contacts.extend(one.contacts.into_iter().map(|mut contact| {
            (contact.body, contact.against) = (contact.body + bodies, anchor(contact.against));
            contact
        }));
        all.loads.extend(one.loads.into_iter().map(|mut load| {
            load.body += bodies;
            load
        }));
    }
    all
}

#[test]
fn the_number_of_threads_changes_nothing_to_the_last_bit() {
    let structure = rings(80);
    let remaining = explain(&structure, Reductions::ALL).expect("valid").remaining;
    let bodies: usize = remaining[1..].iter().map(|block| block.bodies).sum();
    assert!(bodies > 256, "{bodies} bodies are not worth threads");
    let thresholds = [0.0, 0.3, 1.0, 10.0, 1e6].map(Question::Decide);
    for question in thresholds.into_iter().chain([Question::VALUE]) {
        let alone = ask(&structure, question, Reductions { parallel: false, ..Reductions::ALL });
        for threads in [1, 2, 7] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads can be started");
            let together = pool.install(|| assess(&structure, question).expect("valid"));
            assert_eq!(together, alone, "{threads} threads, {question:?}");
        }
    }
}

#[test]
fn every_block_of_several_is_solved_on_its_own() {
    let structure = rings(9);
    let answer = assess(&structure, Question::VALUE).expect("valid");
    assert!(answer.left_out.solved_blocks > 1, "{:?}", answer.left_out);
    let whole = ask(&structure, Question::VALUE, Reductions::NONE);
    assert!(whole.left_out.solved_blocks <= 1 && whole.left_out.closed_form_connections == 0, "{:?}", whole.left_out);
}

/// The value of the whole is that of the block that needs most; how well the others are known
/// does not widen it, and what is shown of them holds.
#[test]
fn blocks_that_do_not_matter_do_not_widen_the_answer() {
    let mut structure = rings(9);
    let all = assess(&structure, Question::VALUE).expect("valid");
    let largest = all.connections.iter().map(|state| state.utilisation).fold(0.0, f64::max);
    assert!(largest <= all.utilisation.upper);
    assert!(Question::VALUE.is_answered_by(&all.utilisation), "{:?}", all.utilisation);
    recheck(&structure, &all).expect("its own fields prove the bracket");
    // With that one made strong, another one matters.
    let critical = all.connections.iter().position(|state| state.critical).expect("one breaks");
    let strong = structure.connections[critical].connector;
    structure.connectors[strong].strength *= 1e3;
    if let Model::Box { shear, tension, compression, bending, torsion } = &mut structure.connectors[strong].model {
        for limit in shear.iter_mut().chain([tension, compression]).chain(bending).chain([torsion]) {
            *limit *= 1e3;
        }
    }
    let other = assess(&structure, Question::VALUE).expect("valid");
    assert!(other.utilisation.upper <= all.utilisation.upper, "more strength never harms");
    assert!(Question::VALUE.is_answered_by(&other.utilisation), "{:?}", other.utilisation);
    let whole = ask(&structure, Question::VALUE, Reductions::NONE);
    assert!(may_be_equal(other.utilisation, whole.utilisation), "{:?} {:?}", other.utilisation, whole.utilisation);
}

#[test]
fn what_only_unlimited_links_hold_needs_no_solver_and_no_strength() {
    let recipe = Recipe { kind: Kind::Redundant, bodies: 9, seed: 2 };
    let structure = welded(&recipe, 1.1);
    let answer = assess(&structure, Question::VALUE).expect("valid");
    assert_eq!(answer.decided_by, Rung::ClosedForm);
    let free = structure.bodies.iter().filter(|body| !body.fixed).count();
    assert!(answer.left_out.merged_bodies + 1 >= free, "{:?}", answer.left_out);
    if answer.verdict == Verdict::Stable {
        assert_eq!(answer.utilisation, Bracket::exact(0.0));
    }
    recheck(&structure, &answer).expect("the welds carry all that there is");
}
