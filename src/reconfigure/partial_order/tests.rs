//! Whatever the order allows holds: orders by the replay, overlaps by moments of random runs.

use crate::geometry::{Solid, overlap};
use crate::reconfigure::assembly::{Assembler, Engagement, Moment, Moving};
use crate::reconfigure::replay::legality::transition;
use crate::reconfigure::replay::replay;
use crate::reconfigure::tests::{cubes, goal, plan, solved, tower_to_row};
use crate::reconfigure::{Action, Objective, Options, Plan};
use crate::robot::{Configuration, Goal, Placement};
use crate::statics::{Question, assess};

use super::random_runs::{Draw, Run, waits};
use super::{Because, OrderError, OrderOptions, PartialOrder, partial_order};

/// A row on the ground, the first cube held, with a cube on either end that moves one cell inwards.
fn two_apart() -> (Configuration, Goal) {
    let row: Vec<[i32; 3]> = (0..7).map(|x| [x, 0, 0]).collect();
    let with = |tops: [i32; 2]| cubes(&[row.clone(), tops.map(|x| [x, 0, 1]).to_vec()].concat(), 1);
    (with([0, 6]), goal(with([1, 5])))
}

/// Likewise, but one cube follows the other.
fn in_file() -> (Configuration, Goal) {
    let row: Vec<[i32; 3]> = (0..4).map(|x| [x, 0, 0]).collect();
    let with = |tops: [i32; 2]| cubes(&[row.clone(), tops.map(|x| [x, 0, 1]).to_vec()].concat(), 1);
    (with([0, 1]), goal(with([1, 2])))
}

fn planned(problem: &(Configuration, Goal)) -> Plan {
    let options = Options { objective: Objective::Moves, ..Options::default() };
    solved(&plan(&problem.0, &problem.1, &options)).clone()
}

fn ordered(start: &Configuration, plan: &Plan) -> PartialOrder {
    partial_order(start, plan, &OrderOptions::default()).unwrap()
}

fn moves(plan: &Plan) -> Vec<usize> {
    (0..plan.actions.len()).filter(|&i| plan.actions[i].action.is_move()).collect()
}

#[test]
fn moves_far_apart_may_overlap_and_save_time() {
    let problem = two_apart();
    let plan = planned(&problem);
    let order = ordered(&problem.0, &plan);
    let [first, second] = moves(&plan)[..] else { panic!("two moves") };
    assert!(!waits(&order, second, first));
    assert!(order.checked.overlaps > 0 && order.is_complete);
    let times = order.timetable(|action| f64::from(u8::from(plan.actions[action].action.is_move())));
    assert_eq!((times.makespan, times.one_by_one, times.saved()), (1.0, 2.0, 0.5));
    assert!(order.margin.lower >= 0.0);
}

#[test]
fn moves_that_need_each_other_wait() {
    let problem = in_file();
    let plan = planned(&problem);
    let order = ordered(&problem.0, &plan);
    let moves = moves(&plan);
    for (i, &late) in moves.iter().enumerate() {
        assert!(moves[..i].iter().all(|&early| waits(&order, late, early)), "{:?}", order.graph);
    }
    // One module that moves twice waits for itself.
    let (start, goal) = tower_to_row();
    let plan = planned(&(start.clone(), goal));
    let order = ordered(&start, &plan);
    let module = |action: usize| match plan.actions[action].action {
        Action::Move { module, .. } => Some(module),
        Action::Attach(_) | Action::Detach(_) => None,
    };
    for late in 0..plan.actions.len() {
        for early in (0..late).filter(|&early| module(early).is_some() && module(early) == module(late)) {
            assert!(waits(&order, late, early));
        }
    }
}

#[test]
fn one_at_a_time_is_one_at_a_time() {
    let problem = two_apart();
    let plan = planned(&problem);
    let options = OrderOptions { most_at_once: 1, ..OrderOptions::default() };
    let order = partial_order(&problem.0, &plan, &options).unwrap();
    let [first, second] = moves(&plan)[..] else { panic!("two moves") };
    assert!(waits(&order, second, first));
}

#[test]
fn without_time_the_plan_keeps_its_order() {
    let problem = two_apart();
    let plan = planned(&problem);
    let options = OrderOptions { deadline: Some(std::time::Instant::now()), ..OrderOptions::default() };
    let order = partial_order(&problem.0, &plan, &options).unwrap();
    let [first, second] = moves(&plan)[..] else { panic!("two moves") };
    assert!(!order.is_complete && waits(&order, second, first));
}

#[test]
fn a_margin_that_only_one_at_a_time_leaves_is_kept() {
    // The required margin is what the plan has: whatever overlaps does not lower it.
    let problem = two_apart();
    let plan = planned(&problem);
    let required = plan.margin.unwrap().lower;
    let order = partial_order(&problem.0, &plan, &OrderOptions { required, ..OrderOptions::default() }).unwrap();
    assert!(order.margin.lower >= required - 1e-6);
    let asked = OrderOptions { required: required + 0.01, ..OrderOptions::default() };
    assert!(matches!(partial_order(&problem.0, &plan, &asked), Err(OrderError::Broken { .. })));
}

#[test]
fn a_move_waits_where_only_the_margin_asks_for_it() {
    // On a cantilever one cube moves in from the tip and one moves out from the wall: in the other order, or at
    // once, the bending at the wall would be more than at any time of the plan.
    let arm: Vec<[i32; 3]> = (0..4).map(|x| [x, 0, 5]).collect();
    let with = |tops: [i32; 2]| {
        let mut robot = cubes(&[arm.clone(), tops.map(|x| [x, 0, 6]).to_vec()].concat(), 1);
        robot.gravity.z = -2.0;
        robot
    };
    let (start, goal) = (with([3, 0]), goal(with([2, 1])));
    let plan = solved(&plan(&start, &goal, &Options::default())).clone();
    let [inwards, outwards] = moves(&plan)[..] else { panic!("two moves") };
    let required = plan.margin.unwrap().lower;
    assert!(required > 0.05);
    let strict = partial_order(&start, &plan, &OrderOptions { required, ..OrderOptions::default() }).unwrap();
    assert!(waits(&strict, outwards, inwards));
    assert!(strict.graph.edge_weights().any(|because| *because == Because::Unstable));
    let lenient = ordered(&start, &plan);
    assert!(!waits(&lenient, outwards, inwards) && lenient.margin.lower < required);
}

#[test]
fn a_plan_that_does_not_hold_has_no_order() {
    let problem = two_apart();
    let mut plan = planned(&problem);
    let again = plan.actions[moves(&plan)[0]].clone();
    plan.actions.push(again);
    let broken = partial_order(&problem.0, &plan, &OrderOptions::default()).map(|order| order.checked);
    assert!(matches!(broken, Err(OrderError::Broken { action: Some(_), .. })), "{broken:?}");
}

#[test]
fn every_order_that_the_graph_allows_replays() {
    for problem in [two_apart(), in_file(), tower_to_row()] {
        let plan = planned(&problem);
        let order = ordered(&problem.0, &plan);
        for seed in 0..6 {
            let mut draw = Draw(seed);
            let mut shuffled = Plan { margin: None, bottleneck: None, ..plan.clone() };
            shuffled.actions.clear();
            let mut left: Vec<usize> = (0..plan.actions.len()).collect();
            while !left.is_empty() {
                let free = |action: usize| order.waits_for(action).iter().all(|before| !left.contains(before));
                let free: Vec<usize> = left.iter().copied().filter(|&action| free(action)).collect();
                let next = free[draw.below(free.len())];
                left.retain(|&action| action != next);
                let action = plan.actions[next].action;
                shuffled.actions.push(crate::reconfigure::PlannedAction { action, margin: None, phase: None });
            }
            assert_eq!(replay(&problem.0, &problem.1, &shuffled, 0.0).unwrap().failures, []);
        }
    }
}

#[test]
fn every_moment_of_every_overlap_is_stable() {
    for problem in [two_apart(), in_file(), tower_to_row()] {
        let plan = planned(&problem);
        let order = ordered(&problem.0, &plan);
        for seed in 0..4 {
            let mut draw = Draw(seed);
            let run = Run::random(&order, plan.actions.len(), &mut draw);
            for now in run.moments(&mut draw) {
                holds_at(&problem.0, &plan, &run, now);
            }
        }
    }
}

/// Checks a run at one moment.
fn holds_at(start: &Configuration, plan: &Plan, run: &Run, now: f64) {
    let action = |i: usize| &plan.actions[i].action;
    let mut state = start.clone();
    for done in run.done(now, |i| matches!(action(i), Action::Detach(_))) {
        state = transition(&state, action(done)).unwrap().after;
    }
    let under_way = run.under_way(now).filter(|&(i, _)| action(i).is_move());
    let paths: Vec<_> = under_way
        .map(|(i, phase)| {
            let path = transition(&state, action(i)).unwrap().path.unwrap();
            let pose = path.motion.pose(&state.pose(path.module), phase);
            (path, pose)
        })
        .collect();
    let moving: Vec<Moving> = paths.iter().map(|(path, pose)| Moving { module: path.module, pose: *pose }).collect();
    let is_moving = |module: usize| moving.iter().any(|moving| moving.module == module);
    let mut engaged: Vec<Engagement> = Vec::new();
    for connection in state.connections.iter().filter(|c| !c.modules().into_iter().any(is_moving)) {
        engaged.push(Engagement::face(&state, connection));
    }
    for (path, _) in &paths {
        let own = path.engaged.iter().filter(|held| held.modules().contains(&path.module));
        engaged.extend(own.inspect(|held| assert!(held.modules().iter().filter(|&&m| is_moving(m)).count() == 1)));
    }
    let pose = |m: usize| moving.iter().find(|moving| moving.module == m).map_or(state.pose(m), |moving| moving.pose);
    let solid = |m: usize| Solid::new(state.module_type(m).body().shape.clone(), pose(m));
    for a in 0..state.modules.len() {
        assert!((0..a).all(|b| !overlap(&solid(a), &solid(b), 1e-6 * state.pitch())));
    }
    let placements: Vec<Placement> = state.modules.iter().map(|module| module.placement).collect();
    let moment = Moment { placements: &placements, moving: &moving, engaged: &engaged };
    let assembly = Assembler::new(start).assemble_moment(&moment);
    let mut held = petgraph::unionfind::UnionFind::<usize>::new(state.modules.len());
    let joined = assembly.connections.iter().filter(|&&i| {
        let [a, b] = engaged[i].modules();
        held.union(a, b)
    });
    assert_eq!(joined.count() + 1, state.modules.len());
    assert!(assess(&assembly.structure, Question::VALUE).unwrap().margin().lower >= 0.0);
}
