//! Fronts, rankings, what plans are worth, and what is in the way of one.

use crate::reconfigure::plan::{Limit, Objective, Outcome, Plan, Report};
use crate::reconfigure::replay::{appraise, replay};
use crate::reconfigure::stronger::stronger;
use crate::reconfigure::{Action, InTheWay, MARGIN_TOLERANCE, Options, Reduction};
use crate::robot::{Configuration, Goal};

use super::agreement::SMALL;
use super::{cubes, goal, plan, solved, tower_to_row};

/// The plans of a report, best first.
fn plans(report: &Report) -> Vec<&Plan> {
    report.plan.iter().chain(&report.alternatives).collect()
}

fn margin(plan: &Plan) -> f64 {
    plan.margin.unwrap().lower
}

/// Twice the tolerance: what two searches may differ by.
fn same(a: f64, b: f64) -> bool {
    (a - b).abs() <= 2.0 * MARGIN_TOLERANCE
}

#[test]
fn the_front_is_that_of_the_primitive_search_and_ends_at_the_two_other_objectives() {
    for &(from, to, fixed) in SMALL {
        let (start, target) = (cubes(from, fixed), goal(cubes(to, fixed)));
        let of = |objective, reduction| plan(&start, &target, &Options { objective, reduction, ..Options::default() });
        let front = of(Objective::Pareto, Reduction::Saturated);
        solved(&front);
        assert!(front.proof.optimal);
        let found = plans(&front);
        for pair in found.windows(2) {
            assert!(pair[0].moves > pair[1].moves && margin(pair[0]) > margin(pair[1]), "one beats the other");
        }
        let primitive = of(Objective::Pareto, Reduction::Primitive);
        let reference = plans(&primitive);
        assert_eq!(found.len(), reference.len());
        for (a, b) in found.iter().zip(&reference) {
            assert!(a.moves == b.moves && same(margin(a), margin(b)), "{from:?} to {to:?}");
        }
        let widest = of(Objective::Margin, Reduction::Saturated);
        assert!(found[0].moves == solved(&widest).moves && same(margin(found[0]), margin(solved(&widest))));
        let shortest = of(Objective::Moves, Reduction::Saturated);
        assert_eq!(found[found.len() - 1].moves, solved(&shortest).moves);
    }
}

/// Every point of a front, asked for by itself: nothing with as few moves has a larger margin.
#[test]
fn no_plan_of_fewer_moves_has_the_margin_of_the_next_one_on_the_front() {
    let (start, target) = tower_to_row();
    let front = plan(&start, &target, &Options { objective: Objective::Pareto, ..Options::default() });
    let found = plans(&front);
    for (index, point) in found.iter().enumerate() {
        let least = Some(margin(point) - 2.0 * MARGIN_TOLERANCE);
        let fewest = Options { objective: Objective::Moves, min_margin: least, ..Options::default() };
        assert_eq!(solved(&plan(&start, &target, &fewest)).moves, point.moves, "point {index}");
    }
}

#[test]
fn rankings_go_by_margin_and_then_by_moves_and_the_first_stay_the_first() {
    let (start, target) = tower_to_row();
    let of = |plans| plan(&start, &target, &Options { plans, ..Options::default() });
    let (few, many) = (of(3), of(6));
    assert_eq!((few.alternatives_cut_by, many.alternatives_cut_by), (None, None));
    let (few, many) = (plans(&few), plans(&many));
    assert_eq!((few.len(), many.len()), (3, 6));
    let worth = |plan: &&Plan| (margin(plan), plan.moves);
    assert_eq!(few.iter().map(worth).collect::<Vec<_>>(), many[..3].iter().map(worth).collect::<Vec<_>>());
    for pair in many.windows(2) {
        let (a, b) = (worth(&pair[0]), worth(&pair[1]));
        assert!(a.0 > b.0 - 2.0 * MARGIN_TOLERANCE, "{a:?} before {b:?}");
        assert!(!same(a.0, b.0) || a.1 <= b.1, "{a:?} before {b:?}");
    }
    let mut moves: Vec<Vec<Action>> = Vec::new();
    for plan in &many {
        let own: Vec<Action> = plan.actions.iter().map(|p| p.action).filter(Action::is_move).collect();
        assert!(!moves.contains(&own), "twice the same plan");
        moves.push(own);
    }
}

/// Every connector of a robot so many times as strong.
fn all_stronger(robot: &Configuration, factor: f64) -> Configuration {
    let mut robot = robot.clone();
    let catalogue = std::sync::Arc::make_mut(&mut robot.catalogue);
    catalogue.connectors = catalogue.connectors.iter().map(|connector| stronger(connector, factor)).collect();
    robot
}

#[test]
fn utilisations_go_with_one_over_strength() {
    let (start, target) = tower_to_row();
    let report = plan(&start, &target, &Options::default());
    let best = solved(&report);
    let plain = replay(&start, &target, best, 0.0).unwrap();
    let factor = 1.7;
    let strong = Goal { configuration: all_stronger(&target.configuration, factor), ..target.clone() };
    let scaled = replay(&all_stronger(&start, factor), &strong, best, 0.0).unwrap();
    for (a, b) in plain.states.iter().zip(&scaled.states) {
        let expected = 1.0 - (1.0 - a.moment.margin.lower) / factor;
        assert!((b.moment.margin.lower - expected).abs() < 1e-5, "{a:?} against {b:?}");
    }
}

#[test]
fn a_plan_says_what_a_stronger_bottleneck_would_gain() {
    let (start, target) = tower_to_row();
    let report = plan(&start, &target, &Options::default());
    let best = solved(&report);
    let found = replay(&start, &target, best, 0.0).unwrap();
    let appraised = appraise(&start, &target, best, &found).unwrap();
    let smallest = appraised.profile.iter().map(|moment| moment.margin.lower).fold(f64::INFINITY, f64::min);
    assert_eq!(smallest, found.margin.lower);
    for action in 0..best.actions.len() {
        assert!(appraised.profile.iter().any(|moment| moment.action == Some(action) && moment.phase == 1.0));
    }
    let gain = appraised.if_stronger.unwrap();
    let connection = best.bottleneck.as_ref().unwrap().connection.unwrap();
    // Never a loss; and no more than all connections together, or the next one in line, would allow.
    assert!(gain.margin.lower >= found.margin.lower - MARGIN_TOLERANCE);
    let all = 1.0 - (1.0 - found.margin.upper) / gain.factor;
    assert!(gain.margin.lower <= all + 1e-5);
    let others = found.states.iter().filter(|state| state.weakest != Some(connection));
    assert!(
        others.map(|state| state.moment.margin.upper).all(|other| gain.margin.lower <= other + (1.0 - other) / 2.0)
    );
}

/// What is in the way where more margin is required than any plan has.
fn in_the_way(start: &Configuration, target: &Goal, required: f64) -> InTheWay {
    let options = Options { min_margin: Some(required), explain: true, ..Options::default() };
    let report = plan(start, target, &options);
    assert!(matches!(report.outcome, Outcome::Impossible(_)));
    report.in_the_way.unwrap()
}

#[test]
fn the_margin_and_the_strength_that_would_do_are_told() {
    let (start, target) = tower_to_row();
    let best = margin(solved(&plan(&start, &target, &Options::default())));
    let required = best + 0.5 * (1.0 - best);
    let mut found = in_the_way(&start, &target, required);
    assert_eq!(found.cut_by, None);
    assert!(found.margin.lower <= best + MARGIN_TOLERANCE && best - MARGIN_TOLERANCE <= found.margin.upper);
    assert!(found.margin.upper - found.margin.lower < 1e-5);
    let with = |factor: f64| {
        let strong = Goal { configuration: all_stronger(&target.configuration, factor), ..target.clone() };
        let options = Options { min_margin: Some(required), ..Options::default() };
        plan(&all_stronger(&start, factor), &strong, &options).plan.is_some()
    };
    assert!(with(found.strength_factor.upper * 1.0001), "so much stronger there is a plan");
    assert!(!with(found.strength_factor.lower * 0.9999), "less strong there is none");
    // The connections at which the plan lacks margin, the weakest first.
    let closest = found.plan.clone().unwrap();
    let check = replay(&start, &target, &closest, f64::NEG_INFINITY).unwrap();
    assert_eq!(check.failures, []);
    found.weigh(&check, required);
    let weakest = closest.bottleneck.unwrap().connection.unwrap();
    assert!(found.too_weak.iter().any(|(connection, _)| *connection == weakest));
    assert!(found.too_weak.iter().all(|(_, margin)| margin.lower < required));
    assert!(found.too_weak.windows(2).all(|pair| pair[0].1.lower <= pair[1].1.lower));
}

#[test]
fn what_cannot_move_is_told() {
    // Nothing that turns about its hinge is almost unloaded, so neither free cube can do anything.
    let (start, target) = (cubes(&[[0, 0, 0], [0, 0, 1]], 1), goal(cubes(&[[0, 0, 0], [1, 0, 0]], 1)));
    assert_eq!(in_the_way(&start, &target, 0.9).never_move, Some(vec![1]));
    // Where others can move and the goal is out of reach all the same, it names who cannot.
    let free = plan(&start, &target, &Options::default());
    assert_eq!(free.in_the_way, None, "nothing is in the way of a plan");
}

#[test]
fn an_explanation_is_given_on_request_and_after_limits_too() {
    let (start, target) = tower_to_row();
    let cut = |explain| {
        let options = Options { max_expansions: Some(1), explain, ..Options::default() };
        plan(&start, &target, &options)
    };
    assert_eq!(cut(false).in_the_way, None);
    let report = cut(true);
    assert_eq!((&report.outcome, &report.plan), (&Outcome::OutOfBudget(Limit::Expansions), &None));
    let found = report.in_the_way.unwrap();
    assert!(found.plan.is_some() && found.strength_factor.upper == 1.0, "there is a plan, with more patience");
}
