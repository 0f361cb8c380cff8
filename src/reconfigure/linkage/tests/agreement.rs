//! The planner against plain breadth-first search over the definitions.

use std::collections::{HashMap, VecDeque};

use crate::reconfigure::linkage::arrangement::Arrangement;
use crate::reconfigure::linkage::domain::Domain;
use crate::reconfigure::linkage::problem::Problem;
use crate::reconfigure::options::Options;
use crate::reconfigure::plan::{Objective, Outcome};
use crate::robot::Matching;
use crate::robot::linkage::{Goal, Linkage};

use super::{anywhere, chain, goal, plan, solved, standing, string};

/// Fewest moves to every arrangement up to a depth, by geometry alone.
fn distances(domain: &Domain, from: &Linkage, depth: u32) -> HashMap<Arrangement, u32> {
    let first = domain.arrangements.of(&domain.problem.described(from)).arrangement;
    let mut known = HashMap::from([(first.clone(), 0)]);
    let mut queue = VecDeque::from([first]);
    while let Some(at) = queue.pop_front() {
        let so_far = known[&at];
        if so_far == depth {
            continue;
        }
        let view = domain.saturated(&at);
        for step in view.steps(domain.rules()) {
            let next = domain.arrangements.of(&view.after(&step)).arrangement;
            if !known.contains_key(&next) && domain.is_free(&view, &step) {
                known.insert(next.clone(), so_far + 1);
                queue.push_back(next);
            }
        }
    }
    known
}

fn moves() -> Options {
    Options { objective: Objective::Moves, ignore_stability: true, ..Options::default() }
}

/// Plans from one robot to every arrangement that two moves lead to.
fn agree(start: &Linkage, every: usize) {
    let is_held = start.modules[0].fixed;
    let wanted = |end: Linkage| if is_held { goal(end) } else { anywhere(end) };
    let problem = Problem::new(start, &wanted(start.clone())).expect("sound");
    let domain = Domain::new(&problem, false);
    let mut reached: Vec<(Arrangement, u32)> = distances(&domain, start, 2).into_iter().collect();
    reached.sort();
    assert!(reached.len() > 3);
    for (arrangement, distance) in reached.into_iter().step_by(every) {
        let view = domain.saturated(&arrangement);
        let mut end = start.clone();
        for (module, place) in problem.slots.iter().zip(&view.modules) {
            end.modules[*module].pose = place.pose;
            end.modules[*module].joints = place.joints.to_vec();
        }
        end.connections = end.touching();
        let report = plan(start, &wanted(end), &moves());
        assert_eq!(solved(&report).moves, distance);
        assert!(report.proof.optimal);
        assert_eq!(report.proof.moves_at_least, distance);
    }
}

#[test]
fn chains_take_as_many_moves_as_breadth_first_search() {
    agree(&chain(&[[0, 0, 0], [1, 0, 1]], &[0]), 7);
    agree(&standing(chain(&[[0, 1, 0], [0, -1, 1]], &[1]), None), 3);
}

#[test]
fn freeform_robots_take_as_many_moves_as_breadth_first_search() {
    agree(&string(&[[0, 90, 0], [90, 90, 0]]), 3);
    agree(&standing(string(&[[0, 90, 0], [90, 90, 0]]), None), 5);
}

#[test]
fn the_goal_may_have_fewer_connections_and_another_frame() {
    let start = chain(&[[0, 0, 0], [0, 0, 0]], &[0]);
    let mut end = chain(&[[0, 1, 0], [0, 0, 0]], &[0]);
    for module in &mut end.modules {
        module.pose = crate::spatial::Pose::translation(1.0, 2.0, 3.0) * module.pose;
    }
    assert_eq!(solved(&plan(&start, &anywhere(end), &moves())).moves, 1);
}

#[test]
fn labelled_modules_have_places_of_their_own() {
    let start = chain(&[[1, 0, 0], [0, 0, 0]], &[0]);
    let mut swapped = start.clone();
    swapped.modules.swap(0, 1);
    for (index, module) in swapped.modules.iter_mut().enumerate() {
        module.id = format!("m{index}");
    }
    swapped.connections = swapped.touching();
    let any = solved(&plan(&start, &goal(swapped.clone()), &moves())).moves;
    assert_eq!(any, 0);
    let own = Goal { linkage: swapped, matching: Matching { labelled: true, free_frame: true } };
    assert!(solved(&plan(&start, &own, &moves())).moves > 0);
}

#[test]
fn what_cannot_be_reached_is_proved_to_be_out_of_reach() {
    // One module alone reaches every position of its joints.
    let one = |joints: [i32; 3]| chain(&[joints], &[]);
    assert_eq!(solved(&plan(&one([0, 0, 0]), &anywhere(one([1, -1, 1])), &moves())).moves, 3);
    let mut far = one([0, 0, 0]);
    far.modules[0].fixed = true;
    let mut moved = far.clone();
    moved.modules[0].pose = crate::spatial::Pose::translation(1.0, 0.0, 0.0);
    let report = plan(&far, &goal(moved), &moves());
    assert!(matches!(report.outcome, Outcome::Impossible(_)), "{:?}", report.outcome);
}

#[test]
fn threads_change_nothing() {
    let start = standing(chain(&[[0, 0, 0], [0, 0, 0]], &[0]), None);
    let end = standing(chain(&[[0, 1, 0], [1, 0, 0]], &[0]), None);
    let options = Options { objective: Objective::Margin, ..Options::default() };
    let reports: Vec<_> = [1, 2, 4]
        .into_iter()
        .map(|threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            let mut report = pool.install(|| plan(&start, &goal(end.clone()), &options));
            report.statistics.seconds = 0.0;
            report
        })
        .collect();
    solved(&reports[0]);
    assert_eq!(reports[0], reports[1]);
    assert_eq!(reports[0], reports[2]);
}
