//! Plans that were tampered with are rejected by the replay.

use std::sync::Arc;

use crate::reconfigure::Action;
use crate::reconfigure::Options;
use crate::reconfigure::plan::Plan;
use crate::reconfigure::replay::{Failure, Fault, replay};
use crate::robot::{Cell, Configuration, Goal};

use super::{cubes, goal, plan, solved, tower_to_row};

/// A verified plan of [`tower_to_row`].
fn sample_plan() -> (Configuration, Goal, Plan) {
    let (start, target) = tower_to_row();
    let report = plan(&start, &target, &Options::default());
    let best = solved(&report).clone();
    assert!(best.moves >= 3 && best.actions.len() > 4, "{best:#?}");
    (start, target, best)
}

#[test]
fn a_plan_without_one_of_its_actions_is_rejected() {
    let (start, target, best) = sample_plan();
    for removed in 0..best.actions.len() {
        let mut tampered = best.clone();
        tampered.actions.remove(removed);
        let replayed = replay(&start, &target, &tampered, 0.0).unwrap();
        assert!(!replayed.is_verified(), "without action {removed}");
    }
}

#[test]
fn swapped_actions_that_lose_support_are_rejected() {
    let (start, target, best) = sample_plan();
    let mut losses = 0;
    for at in 1..best.actions.len() {
        let mut tampered = best.clone();
        tampered.actions.swap(at - 1, at);
        let replayed = replay(&start, &target, &tampered, 0.0).unwrap();
        let both_moves = [at - 1, at].iter().all(|&i| best.actions[i].action.is_move());
        let lost = replayed
            .failures
            .iter()
            .any(|f| matches!(f.fault, Fault::NotHeld | Fault::NotReleased | Fault::NoSupport | Fault::Disconnected));
        losses += usize::from(lost);
        assert!(!replayed.is_verified() || !both_moves, "swapped {at}");
    }
    assert!(losses > 0, "some swap loses a support");
}

#[test]
fn a_plan_for_stronger_connectors_is_rejected() {
    // Faces limit what hangs on a wall, hinges what comes down from a tower.
    let wall = [[0, 0, 3], [0, 0, 4], [0, 0, 5]];
    let hanging = |cell: Cell| cubes(&[&wall[..], &[cell]].concat(), 3);
    let (start, target) = (hanging([1, 0, 5]), goal(hanging([1, 0, 3])));
    let slides = solved(&plan(&start, &target, &Options::default())).clone();
    let tower = tower_to_row();
    let pivots = solved(&plan(&tower.0, &tower.1, &Options::default())).clone();
    for (start, target, best, connector) in [(start, target, slides, 0), (tower.0, tower.1, pivots, 1)] {
        let mut catalogue = (*start.catalogue).clone();
        halve(&mut catalogue.connectors[connector]);
        let catalogue = Arc::new(catalogue);
        let (mut start, mut target) = (start.clone(), target.clone());
        start.catalogue = Arc::clone(&catalogue);
        target.configuration.catalogue = catalogue;
        let replayed = replay(&start, &target, &best, 0.0).unwrap();
        let differs = |f: &Failure| matches!(f.fault, Fault::MarginDiffers { .. });
        assert!(replayed.failures.iter().any(differs), "connector {connector}: {:?}", replayed.failures);
    }
}

/// Half the strength, and half of all limits that go with it.
fn halve(connector: &mut crate::statics::Connector) {
    connector.strength /= 2.0;
    if let crate::statics::Model::Box { shear, tension, compression, bending, torsion } = &mut connector.model {
        for limit in shear.iter_mut().chain(bending).chain([tension, compression, torsion]) {
            *limit /= 2.0;
        }
    }
}

#[test]
fn altered_poses_and_claims_are_rejected() {
    let (start, target, best) = sample_plan();
    let rejected = |tampered: &Plan, what: &str| {
        assert!(!replay(&start, &target, tampered, 0.0).unwrap().is_verified(), "{what}");
    };
    for at in 0..best.actions.len() {
        let mut tampered = best.clone();
        match &mut tampered.actions[at].action {
            Action::Move { to, .. } => to[0] += 1,
            Action::Attach(_) | Action::Detach(_) => continue,
        }
        rejected(&tampered, "another cell");
    }
    let mut tampered = best.clone();
    tampered.moves += 1;
    rejected(&tampered, "another number of moves");
    let mut tampered = best.clone();
    tampered.margin.as_mut().unwrap().lower += 0.01;
    rejected(&tampered, "a larger margin");
    let mut tampered = best.clone();
    tampered.bottleneck.as_mut().unwrap().phase = 0.123;
    rejected(&tampered, "another bottleneck");
    let mut tampered = best.clone();
    let claim = tampered.actions[1].margin.as_mut().unwrap();
    (claim.lower, claim.upper) = (claim.lower + 0.01, claim.upper + 0.01);
    rejected(&tampered, "a larger margin of one action");
    // A bracket that only leaves more open is a weaker claim, and true; one that begins above the margin is not.
    let mut tampered = best.clone();
    let claim = tampered.actions[1].margin.as_mut().unwrap();
    (claim.lower, claim.upper) = (claim.lower + 0.01, claim.upper + 0.02);
    rejected(&tampered, "a bound above the margin");
    let mut elsewhere = start.clone();
    elsewhere.modules[3].placement.cell = [2, 0, 0];
    assert!(replay(&elsewhere, &target, &best, 0.0).is_err(), "a start that is not what was connected");
    let other_goal = goal(cubes(&[[0, 0, 0], [1, 0, 0], [2, 0, 0], [2, 1, 0]], 1));
    let replayed = replay(&start, &other_goal, &best, 0.0).unwrap();
    assert_eq!(replayed.failures.last().unwrap().fault, Fault::PlacementsDiffer);
}
