//! Walks through neighbouring states: what is carried over against cold answers.

#[path = "support/random.rs"]
#[expect(dead_code, reason = "what other tests build on is not walked on here")]
mod random;
#[path = "support/recheck.rs"]
mod recheck;
#[path = "support/scenes.rs"]
#[expect(dead_code, reason = "what other tests build on is not walked on here")]
mod scenes;
#[path = "support/walks.rs"]
mod walks;

use recheck::recheck;
use steadfast::spatial::Vec3;
use steadfast::statics::{
    Assessment, Memory, NotNear, Question, Rung, Structure, Tally, Verdict, assess, assess_keeping, assess_near,
};
use walks::{Walk, cubes, trusses};

const QUESTION: Question = Question::Decide(1.0);

/// Accuracy to which balance and data are meant.
const SLACK: f64 = 1e-9;

fn same(structure: &Structure) -> Vec<Option<usize>> {
    (0..structure.bodies.len()).map(Some).collect()
}

/// The walk with strengths such that it starts at a utilisation of 0.9.
fn ready(mut walk: Walk) -> Walk {
    let t = assess(&walk.structure, Question::VALUE).expect("sound").utilisation.upper;
    walk.strengthen(t / 0.9);
    walk
}

/// Neither bracket excludes the other, and what is said of standing is the same.
/// A question for a threshold stops at the first proof that it is exceeded: it need not find
/// out that no strength helps at all.
fn agree(name: &str, near: &Assessment, cold: &Assessment) {
    let (a, b) = (near.utilisation, cold.utilisation);
    assert!(a.lower <= b.upper + SLACK * b.upper.max(1.0), "{name}: {a:?} is above {b:?}");
    assert!(b.lower <= a.upper + SLACK * a.upper.max(1.0), "{name}: {a:?} is below {b:?}");
    let known = near.verdict != Verdict::Undecided && cold.verdict != Verdict::Undecided;
    let stands = |answer: &Assessment| answer.verdict == Verdict::Stable;
    assert!(!known || stands(near) == stands(cold), "{name}: {:?} against {:?}", near.verdict, cold.verdict);
}

/// Walks `states` steps and has `check` look at each: the structure, the answer
/// from memory, and the cold one.
fn walk_on(mut walk: Walk, states: usize, mut check: impl FnMut(&Structure, &Assessment, &Assessment)) -> Tally {
    let mut memory = assess_keeping(&walk.structure, QUESTION).expect("sound").1;
    let mut tally = Tally::default();
    for _ in 0..states {
        let (_, next) = walk.neighbour();
        let cold = assess(&next.structure, Question::VALUE).expect("sound");
        let (near, kept) =
            assess_near(&next.structure, QUESTION, &memory, &same(&next.structure)).expect("a sound neighbour");
        agree(walk.name, &near, &cold);
        check(&next.structure, &near, &cold);
        // What memory holds of a state far from the threshold stays useful.
        if cold.utilisation.lower > 0.5 && cold.utilisation.upper < 1.5 {
            tally.count(&near);
            memory = kept;
            walk.go(next);
        }
    }
    tally
}

#[test]
fn carried_bounds_never_contradict_a_cold_solve() {
    let mut tally = Tally::default();
    for walk in trusses().into_iter().chain(cubes()) {
        tally.merge(&walk_on(ready(walk), 25, |structure, near, _| {
            // Both fields, evaluated by code that shares none with the oracle.
            recheck(structure, near).expect("its own fields prove the bracket");
        }));
    }
    assert!(tally.of(Rung::CarriedOver) > 80, "{tally:?}");
    assert!(tally.share_without_solve() > 0.7, "{tally:?}");
}

#[test]
fn the_same_arguments_give_the_same_answer_to_the_last_bit() {
    let mut walk = ready(cubes().swap_remove(1));
    let (_, memory) = assess_keeping(&walk.structure, QUESTION).expect("sound");
    for _ in 0..12 {
        let next = walk.neighbour().1.structure;
        let ask = |memory: &Memory| assess_near(&next, QUESTION, memory, &same(&next)).expect("a sound neighbour");
        let (one, other) = (ask(&memory), ask(&memory.clone()));
        assert_eq!(one.0, other.0);
        assert_eq!(format!("{:?}", one.1), format!("{:?}", other.1));
    }
}

#[test]
fn an_unchanged_structure_is_answered_from_memory_however_tight_the_question() {
    for walk in [trusses().swap_remove(3), cubes().swap_remove(0)] {
        let structure = ready(walk).structure;
        let question = Question::ToGap(1e-6);
        let (cold, memory) = assess_keeping(&structure, question).expect("sound");
        let (near, _) = assess_near(&structure, question, &memory, &same(&structure)).expect("the same");
        assert_eq!(near.decided_by, Rung::CarriedOver);
        assert!((near.utilisation.upper - cold.utilisation.upper).abs() <= SLACK);
        assert!((near.utilisation.lower - cold.utilisation.lower).abs() <= SLACK);
    }
}

#[test]
fn bodies_may_be_renumbered_and_come_anew() {
    let structure = ready(trusses().swap_remove(4)).structure;
    let (_, memory) = assess_keeping(&structure, QUESTION).expect("sound");
    // Numbered backwards, with one more body in front.
    let count = structure.bodies.len();
    let renumber = |i: usize| count - i;
    let mut other = structure.clone();
    other.bodies.reverse();
    let mut extra = structure.bodies[0].clone();
    (extra.mass, extra.com) = (0.01, structure.bodies[5].com + Vec3::y() * 0.1);
    other.bodies.insert(0, extra);
    for connection in &mut other.connections {
        for end in [&mut connection.parent, &mut connection.child] {
            if let steadfast::statics::Anchor::Body(i) = end {
                *i = renumber(*i);
            }
        }
    }
    let mut hung = other.connections[0].clone();
    hung.parent = steadfast::statics::Anchor::Body(renumber(5));
    hung.child = steadfast::statics::Anchor::Body(0);
    hung.frame.translation.vector = structure.bodies[5].com + Vec3::y() * 0.06;
    other.connections.push(hung);
    let matching: Vec<Option<usize>> = (0..=count).map(|i| (i > 0).then(|| count - i)).collect();
    let (near, _) = assess_near(&other, QUESTION, &memory, &matching).expect("a sound neighbour");
    agree("renumbered", &near, &assess(&other, Question::VALUE).expect("sound"));
    assert_eq!(near.decided_by, Rung::CarriedOver, "{:?}", near.utilisation);
}

#[test]
fn a_matching_that_does_not_fit_is_refused() {
    let structure = cubes().swap_remove(0).structure;
    let bodies = structure.bodies.len();
    let (_, memory) = assess_keeping(&structure, QUESTION).expect("sound");
    let mut matching = same(&structure);
    matching.pop();
    let short = assess_near(&structure, QUESTION, &memory, &matching).expect_err("one entry is missing");
    assert_eq!(short, NotNear::Length { entries: bodies - 1, bodies });
    matching.push(Some(bodies));
    let beyond = assess_near(&structure, QUESTION, &memory, &matching).expect_err("there is no such body");
    assert_eq!(beyond, NotNear::NoSuchBody { body: bodies - 1, entry: bodies, remembered: bodies });
    assert!(beyond.to_string().contains(&format!("has {bodies} bodies")));
    let mut unsound = structure.clone();
    unsound.bodies[0].mass = f64::NAN;
    let refused = assess_near(&unsound, QUESTION, &memory, &same(&structure)).expect_err("not a mass");
    assert!(matches!(refused, NotNear::Structure(faults) if faults.len() == 1));
}

/// Memories of other structures and matchings at random: useless, not harmful.
#[test]
fn nonsense_only_costs_tightness() {
    let mut random = random::Random::new(5);
    let strange = ready(trusses().swap_remove(0)).structure;
    for walk in cubes() {
        let name = walk.name;
        let structure = ready(walk).structure;
        let cold = assess(&structure, Question::VALUE).expect("sound");
        for remembered in [&strange, &structure] {
            let memory = assess_keeping(remembered, Question::VALUE).expect("sound").1;
            let remembered = remembered.bodies.len();
            let matching: Vec<Option<usize>> =
                structure.bodies.iter().map(|_| random.chance(0.8).then(|| random.below(remembered))).collect();
            for question in [QUESTION, Question::Decide(0.3), Question::Decide(0.0), Question::VALUE] {
                let (near, _) = assess_near(&structure, question, &memory, &matching).expect("it fits");
                agree(name, &near, &cold);
            }
        }
    }
}

/// A state that falls whatever the strengths never counts as standing, and what is remembered of
/// it does no harm.
#[test]
fn collapse_is_recognised_and_survived() {
    let structure = ready(cubes().swap_remove(2)).structure;
    let (_, memory) = assess_keeping(&structure, QUESTION).expect("sound");
    let mut fallen = structure.clone();
    fallen.contacts.retain(|contact| contact.position.x < 0.2);
    assert_eq!(assess(&fallen, Question::VALUE).expect("sound").verdict, Verdict::WholeBodyUnstable);
    for question in [QUESTION, Question::VALUE] {
        let (near, memory) = assess_near(&fallen, question, &memory, &same(&fallen)).expect("a neighbour");
        assert!(near.utilisation.upper.is_infinite());
        assert!(matches!(near.verdict, Verdict::WholeBodyUnstable | Verdict::InternallyUnstable));
        let (back, _) = assess_near(&structure, question, &memory, &same(&structure)).expect("a neighbour");
        agree("back again", &back, &assess(&structure, Question::VALUE).expect("sound"));
    }
}
