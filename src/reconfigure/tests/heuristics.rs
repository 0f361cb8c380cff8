//! The assignment bound against exact distances.

use std::collections::{HashMap, VecDeque};

use super::super::heuristic::{Reach, Targets};
use super::super::layout::Layout;
use super::{cube, layout_of, moves_of};

/// Fewest moves from `goal` to every layout within `radius` moves, whatever is engaged and
/// however it falls: every move leads back, so also to it.
fn distances(goal: &Layout, radius: u32) -> HashMap<Layout, u32> {
    let mut known = HashMap::from([(goal.clone(), 0)]);
    let mut queue = VecDeque::from([goal.clone()]);
    while let Some(layout) = queue.pop_front() {
        let distance = known[&layout];
        if distance == radius {
            continue;
        }
        for step in moves_of(&layout) {
            let next = step.applied(&layout, false);
            if !known.contains_key(&next) {
                known.insert(next.clone(), distance + 1);
                queue.push_back(next);
            }
        }
    }
    known
}

#[test]
fn the_bound_never_exceeds_the_distance_and_is_consistent() {
    for filled in [
        &[[0, 0, 0], [0, 0, 1], [0, 0, 2], [0, 0, 3]][..],
        &[[0, 0, 0], [1, 0, 0], [2, 0, 0], [1, 0, 1]],
        &[[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]],
    ] {
        let goal = layout_of(filled);
        let targets = Targets::new(&goal, vec![Reach::of(&cube())]);
        let known = distances(&goal, 5);
        assert!(known.len() > 100, "the moves lead somewhere");
        let mut tight = 0;
        for (layout, &distance) in &known {
            let bound = targets.fewest_moves(layout, [0; 3]).unwrap();
            assert!(bound <= distance, "{bound} > {distance} for {layout:?}");
            tight += usize::from(bound == distance);
            for step in moves_of(layout) {
                let next = targets.fewest_moves(&step.applied(layout, false), [0; 3]).unwrap();
                assert!(bound <= next + 1, "{step:?} changes the bound from {bound} to {next}");
            }
        }
        assert!(tight * 10 > known.len(), "the bound is tight for {tight} of {} layouts", known.len());
    }
}

#[test]
fn one_move_covers_one_step_or_a_diagonal() {
    for (to, least) in
        [([0, 0, 0], 0), ([1, 0, 0], 1), ([1, -1, 0], 1), ([1, 1, 1], 2), ([3, 0, 0], 3), ([2, 2, -1], 3)]
    {
        assert_eq!(Reach::of(&cube()).fewest_moves([0; 3], to), Some(least), "to {to:?}");
    }
}

#[test]
fn other_numbers_of_modules_and_misplaced_fixed_ones_are_out_of_reach() {
    let (free, held) = (Reach::of(&cube()), Reach::of(&cube().held()));
    let (short, long) = (layout_of(&[[0, 0, 0]]), layout_of(&[[0, 0, 0], [1, 0, 0]]));
    assert_eq!(Targets::new(&long, vec![free]).fewest_moves(&short, [0; 3]), None);
    let elsewhere = layout_of(&[[1, 0, 0]]);
    assert_eq!(Targets::new(&elsewhere, vec![held]).fewest_moves(&short, [0; 3]), None);
    assert_eq!(Targets::new(&elsewhere, vec![free]).fewest_moves(&short, [0; 3]), Some(1));
}
