//! Moves against their definitions, their sweeps and their way back.

use std::collections::BTreeSet;

use proptest::prelude::*;

use crate::geometry::{Solid, first_collision};
use crate::robot::{Cell, Configuration, Face, Motion, Orientation, Placement, Turn};

use super::super::action::Action;
use super::super::course::motion;
use super::super::layout::{displaced, neighbour};
use super::super::moves::Move;
use super::super::problem::{bonds, cells};
use super::super::replay::legality::transition;
use super::super::step::Step;
use super::{cube, cubes, moves_of, polycube};

/// All moves of the cube in one cell, whether they fit or not.
fn all_moves(from: Cell) -> Vec<Move> {
    cube().ways().iter().map(|way| Move { from, motion: way.motion, kind: way.kind }).collect()
}

fn cube_at(cell: Cell) -> Solid {
    let configuration = cubes(&[cell], 0);
    Solid::new(configuration.module_type(0).body().shape.clone(), configuration.pose(0))
}

/// The room of a move is exactly where a cube would be hit on the way.
#[test]
fn the_room_of_a_move_is_what_the_continuous_sweep_hits() {
    let pitch = cubes(&[[0; 3]], 0).pitch();
    let near = || (-2..=2).flat_map(|x| (-2..=2).flat_map(move |y| (-2..=2).map(move |z| [x, y, z])));
    for step in all_moves([0; 3]) {
        let hit = |cell: &Cell| first_collision(&cube_at([0; 3]), &motion(step, pitch), &cube_at(*cell)).is_some();
        let swept: BTreeSet<Cell> = near().filter(|cell| *cell != [0; 3]).filter(hit).collect();
        assert_eq!(step.room().into_iter().collect::<BTreeSet<_>>(), swept, "{step:?}");
    }
}

#[test]
fn a_motion_ends_where_the_move_says_turned_as_it_says() {
    let pitch = cubes(&[[0; 3]], 0).pitch();
    for step in all_moves([3, -2, 5]) {
        let start = Placement::new(step.from);
        let end = Placement { cell: step.to(), orientation: start.orientation.turned(step.rotation()) };
        let reached = motion(step, pitch).pose(&start.pose(pitch), 1.0);
        let off = reached.inv_mul(&end.pose(pitch));
        assert!(off.translation.vector.norm() < 1e-12 && off.rotation.angle() < 1e-7, "{step:?} is off by {off}");
    }
}

#[test]
fn every_move_and_its_inverse_are_the_identity() {
    for step in all_moves([0; 3]) {
        let back = step.inverse();
        assert_eq!((back.from, back.to()), (step.to(), step.from), "{step:?}");
        assert_eq!(step.rotation().turned(back.rotation()), Orientation::IDENTITY, "{step:?}");
        assert_eq!(back.inverse(), step);
    }
}

/// All moves that the definitions allow in a configuration, by trying every cell within `reach`.
pub(super) fn legal_by_definition(configuration: &Configuration, reach: i32) -> BTreeSet<String> {
    let count = configuration.modules.len();
    let kinds = u16::try_from(configuration.catalogue.motions.len()).unwrap();
    let supports: Vec<Option<usize>> = (0..count).map(Some).chain([None]).collect();
    let mut legal = BTreeSet::new();
    for module in 0..count {
        let from = configuration.modules[module].placement.cell;
        let within = || -reach..=reach;
        let cells = within().flat_map(|x| within().flat_map(move |y| within().map(move |z| [x, y, z])));
        for to in cells.map(|offset| displaced(from, offset)) {
            let actions = supports
                .iter()
                .flat_map(|&support| (0..kinds).map(move |motion| Action::Move { motion, module, support, to }));
            for action in actions {
                let Ok(next) = transition(configuration, &action) else { continue };
                let path = next.path.unwrap();
                let solid =
                    |m: usize| Solid::new(configuration.module_type(m).body().shape.clone(), configuration.pose(m));
                let mut others = (0..count).filter(|&m| m != module).map(solid);
                if others.all(|other| first_collision(&solid(module), &path.motion, &other).is_none()) {
                    legal.insert(format!("{action:?}"));
                }
            }
        }
    }
    legal
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    /// The generator gives exactly the moves that the definitions allow, with
    /// solids swept continuously, for random connections.
    #[test]
    fn the_generator_agrees_with_the_definitions(filled in polycube(7), kept in any::<u32>()) {
        let mut configuration = cubes(&filled, 0);
        let mut index = 0;
        configuration.connections.retain(|_| { index += 1; kept >> (index % 32) & 3 != 0 });
        let (layout, bonds) = (cells(&configuration), bonds(&configuration));
        let moves = moves_of(&layout).into_iter().filter(|&step| cube().allows(&layout, &bonds, step));
        let generated: Vec<String> =
            moves.map(|step| format!("{:?}", Step::Move(step).action(&configuration).unwrap())).collect();
        prop_assert_eq!(generated.iter().cloned().collect::<BTreeSet<_>>(), legal_by_definition(&configuration, 1));
        prop_assert_eq!(generated.iter().collect::<BTreeSet<_>>().len(), generated.len(), "a move twice");
    }

    /// A random walk leads to the states that the definitions give, and back to where it began.
    #[test]
    fn walks_lead_back_exactly(filled in polycube(7), choices in proptest::collection::vec(any::<usize>(), 1..25)) {
        let start = cubes(&filled, 0);
        let mut state = start.clone();
        let mut back = Vec::new();
        for choice in choices {
            let (layout, engaged) = (cells(&state), bonds(&state));
            let moves = moves_of(&layout).into_iter().filter(|&step| cube().allows(&layout, &engaged, step));
            let open = layout.touching().into_iter().filter(|bond| !engaged.contains(bond));
            let steps: Vec<Step> = moves
                .map(Step::Move)
                .chain(open.map(Step::Attach))
                .chain(engaged.iter().copied().map(Step::Detach))
                .collect();
            let Some(&step) = steps.get(choice % steps.len().max(1)) else { break };
            let defined = transition(&state, &step.action(&state).unwrap()).unwrap().after;
            back.push(step.reversal(&state));
            step.apply(&mut state);
            prop_assert_eq!(&state, &defined, "after {:?}", step);
        }
        for step in back.into_iter().rev().flatten() {
            step.apply(&mut state);
        }
        prop_assert_eq!(state, start);
    }
}

#[test]
fn a_slide_needs_two_coplanar_neighbours() {
    let slides = |filled: &[Cell]| {
        let moves = moves_of(&super::layout_of(filled)).into_iter();
        moves.filter(|step| step.from == [0, 0, 1] && matches!(step.motion, Motion::Translation { .. })).count()
    };
    assert_eq!(slides(&[[0, 0, 0], [0, 0, 1]]), 0);
    assert_eq!(slides(&[[0, 0, 0], [1, 0, 0], [0, 0, 1]]), 1);
    assert_eq!(slides(&[[0, 0, 0], [1, 0, 0], [-1, 0, 0], [0, 0, 1]]), 2);
    assert_eq!(slides(&[[0, 0, 0], [1, 0, 0], [0, 0, 1], [1, 0, 1]]), 0, "the target is filled");
}

#[test]
fn a_pivot_lands_on_the_face_that_it_comes_down_on() {
    let quarter = Move {
        from: [0, 0, 1],
        motion: Motion::Rotation { support: Face::NegZ, towards: Face::PosX, turn: Turn::Quarter },
        kind: 1,
    };
    assert_eq!(quarter.to(), [1, 0, 1]);
    let half =
        Move { motion: Motion::Rotation { support: Face::NegZ, towards: Face::PosX, turn: Turn::Half }, ..quarter };
    assert_eq!(half.to(), neighbour([0, 0, 0], Face::PosX));
    let layout = super::layout_of(&[[0, 0, 0], [1, 0, 0], [0, 0, 1]]);
    assert_eq!(quarter.landing(&layout)[0].cells(), [[1, 0, 0], [1, 0, 1]]);
    assert_eq!(half.landing(&layout)[0].cells(), [[0, 0, 0], [1, 0, 0]]);
}

#[test]
fn bonds_and_connections_name_the_same_faces() {
    let state = cubes(&[[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 0, 1]], 0);
    assert_eq!(bonds(&state), cells(&state).touching());
}
