//! Motions that users bring: geometry against continuous sweeps, and the planner against the definitions.

use std::collections::BTreeSet;
use std::sync::Arc;

use proptest::prelude::*;

use crate::geometry::{self, Solid, first_collision};
use crate::reconfigure::course::motion;
use crate::reconfigure::layout::Layout;
use crate::reconfigure::moves::Move;
use crate::reconfigure::problem::{bonds, cells};
use crate::reconfigure::step::Step;
use crate::reconfigure::ways::{Ability, fitting};
use crate::reconfigure::{MARGIN_TOLERANCE, Objective, Options, Outcome, Reduction};
use crate::robot::{Catalogue, Cell, Configuration, Face, Motion, MotionType, Placement, Stencil, Turn};
use crate::spatial::Vec3;

use super::motions::legal_by_definition;
use super::{cubes, goal, plan, polycube};

fn stencil(motion: Motion, occupied: &[Cell], free: &[Cell]) -> Stencil {
    Stencil { motion, occupied: occupied.to_vec(), free: free.to_vec(), mirrored: false }
}

/// Cubes with motions that are not built in: two cells at once, across a diagonal, from one support to a wall beside
/// the target, and a quarter turn that wants more room.
fn runners() -> Catalogue {
    let along = |by| Motion::Translation { by };
    let over = Motion::Rotation { support: Face::NegZ, towards: Face::PosX, turn: Turn::Quarter };
    let motions = [
        ("dash", stencil(along([2, 0, 0]), &[[0, 0, -1], [1, 0, -1], [2, 0, -1]], &[])),
        ("glide", stencil(along([1, 1, 0]), &[[0, 0, -1], [1, 1, -1]], &[])),
        ("corner", Stencil { mirrored: true, ..stencil(along([1, 0, 0]), &[[0, 0, -1], [1, 1, 0]], &[]) }),
        ("tip", stencil(over, &[[0, 0, -1], [1, 0, -1]], &[[-1, 0, 0], [2, 0, 0]])),
    ];
    let mut catalogue = Catalogue::cube();
    let named = motions.map(|(name, stencil)| MotionType { name: name.into(), stencils: vec![stencil] });
    catalogue.motions.extend(named);
    catalogue.module_types[0].lattice.as_mut().unwrap().motions = (0..catalogue.motions.len()).collect();
    catalogue
}

fn running(filled: &[Cell], fixed: usize) -> Configuration {
    Configuration { catalogue: Arc::new(runners()), ..cubes(filled, fixed) }
}

fn moves_of(layout: &Layout) -> Vec<Move> {
    let ability = Ability::new(&runners(), 0);
    fitting(layout, |_| &ability)
}

#[test]
fn the_motions_of_these_tests_are_sound() {
    assert_eq!(runners().problems(), []);
}

/// The order in which slides and pivots were always generated: plans of equal worth depend on it.
#[test]
fn slides_come_before_pivots_in_the_order_of_the_faces() {
    let slides = Face::ALL.map(|direction| Motion::Translation { by: direction.step() });
    let pivots = Face::ALL.into_iter().flat_map(|support| {
        let across = Face::ALL.into_iter().filter(move |side| side.axis() != support.axis());
        across.flat_map(move |towards| {
            [Turn::Quarter, Turn::Half].map(|turn| Motion::Rotation { support, towards, turn })
        })
    });
    let expected: Vec<Motion> = slides.into_iter().chain(pivots).collect();
    let ways: Vec<Motion> = super::cube().ways().iter().map(|way| way.motion).collect();
    assert_eq!(ways, expected);
}

/// What a translation sweeps is where a cube would be hit on the way.
#[test]
fn a_translation_sweeps_what_the_continuous_sweep_hits() {
    let shape = cubes(&[[0; 3]], 0).module_type(0).body().shape.clone();
    let at = |cell: Cell| Solid::new(shape.clone(), Placement::new(cell).pose(0.05));
    let range = |c: i32| c.min(0) - 1..=c.max(0) + 1;
    for by in [[2, 0, 0], [-3, 0, 0], [1, 1, 0], [0, 2, -1], [1, 1, 1], [3, -2, 0], [2, 1, -1], [0, 0, 1]] {
        let step = Move { from: [0; 3], motion: Motion::Translation { by }, kind: 0 };
        let way: geometry::Motion = motion(step, 0.05);
        let near = range(by[0]).flat_map(|x| range(by[1]).flat_map(move |y| range(by[2]).map(move |z| [x, y, z])));
        let hit = |cell: &Cell| *cell != [0; 3] && first_collision(&at([0; 3]), &way, &at(*cell)).is_some();
        assert_eq!(step.room().into_iter().collect::<BTreeSet<_>>(), near.filter(hit).collect(), "{by:?}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    /// Wherever the module is on its way, it is in all cells of some station, and its stations are in order.
    #[test]
    fn a_module_is_nowhere_in_fewer_cells_than_at_a_station(
        by in [-4..5_i32, -4..5_i32, -4..5_i32], phase in 0.0..=1.0_f64,
    ) {
        let motion = Motion::Translation { by };
        prop_assume!(by != [0; 3]);
        let place = Vec3::from(by.map(f64::from)) * phase;
        let is_in = |cell: &Cell| (0..3).all(|i| (f64::from(cell[i]) - place[i]).abs() < 1.0 + 1e-9);
        let stations = motion.stations();
        prop_assert!(stations.iter().any(|cells| cells.iter().all(is_in)), "{by:?} at {phase}: {stations:?}");
        prop_assert_eq!((&stations[0], &stations[stations.len() - 1]), (&vec![[0; 3]], &vec![by]));
        let mut everywhere: BTreeSet<Cell> = motion.swept().into_iter().collect();
        everywhere.insert([0; 3]);
        prop_assert!(stations.iter().flatten().all(|cell| everywhere.contains(cell)));
    }
}

/// What is made of a stencil is made of each of its variants, half of it where mirror images were asked for.
#[test]
fn variants_are_closed_under_turns() {
    for stencil in runners().motions.iter().flat_map(|motion| &motion.stencils) {
        let variants = stencil.variants();
        let whole = if stencil.mirrored { 2 } else { 1 };
        for variant in &variants {
            let again = variant.variants();
            assert!(again.iter().all(|image| variants.contains(image)), "{variant:?}");
            assert_eq!(again.len() * whole, variants.len(), "{variant:?}");
        }
        assert_eq!(24 % (variants.len() / whole), 0);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    /// The generator gives exactly the moves that the definitions allow, with solids swept continuously.
    #[test]
    fn users_motions_are_generated_as_defined(filled in polycube(7), kept in any::<u32>()) {
        let mut configuration = running(&filled, 0);
        let mut index = 0;
        configuration.connections.retain(|_| { index += 1; kept >> (index % 32) & 3 != 0 });
        let (layout, engaged) = (cells(&configuration), bonds(&configuration));
        let ability = Ability::new(&configuration.catalogue, 0);
        let moves = moves_of(&layout).into_iter().filter(|&step| ability.allows(&layout, &engaged, step));
        let generated: Vec<String> =
            moves.map(|step| format!("{:?}", Step::Move(step).action(&configuration).unwrap())).collect();
        let legal = legal_by_definition(&configuration, 2);
        prop_assert_eq!(generated.iter().cloned().collect::<BTreeSet<_>>(), legal);
    }

    /// Every move is undone by its inverse, which fits where it has led.
    #[test]
    fn users_motions_lead_back(filled in polycube(8)) {
        let state = running(&filled, 0);
        for step in moves_of(&cells(&state)) {
            let mut after = state.clone();
            Step::Move(step).apply(&mut after);
            let (layout, engaged) = (cells(&after), bonds(&after));
            prop_assert!(moves_of(&layout).contains(&step.inverse()), "after {step:?}");
            prop_assert!(Ability::new(&state.catalogue, 0).allows(&layout, &engaged, step.inverse()));
            for back in Step::Move(step).reversal(&state) {
                back.apply(&mut after);
            }
            prop_assert_eq!(&after.modules, &state.modules);
        }
    }
}

/// Problems with a plan: start, goal, and how many modules are held.
const SMALL: &[(&[Cell], &[Cell], usize)] = &[
    // Along a held beam and round its end.
    (&[[0, 0, 2], [1, 0, 2], [2, 0, 2], [0, 0, 3]], &[[0, 0, 2], [1, 0, 2], [2, 0, 2], [3, 0, 2]], 3),
    // Across the corner of a held plate.
    (&[[0, 0, 2], [1, 0, 2], [1, 1, 2], [0, 0, 1]], &[[0, 0, 2], [1, 0, 2], [1, 1, 2], [1, 1, 1]], 3),
];

#[test]
fn saturated_and_primitive_search_agree_on_users_motions() {
    for &(from, to, fixed) in SMALL {
        let (start, target) = (running(from, fixed), goal(running(to, fixed)));
        for objective in [Objective::Margin, Objective::Moves] {
            let of = |reduction| plan(&start, &target, &Options { objective, reduction, ..Options::default() });
            let (saturated, primitive) = (of(Reduction::Saturated), of(Reduction::Primitive));
            assert_eq!((&saturated.outcome, &primitive.outcome), (&Outcome::Solved, &Outcome::Solved));
            let (a, b) = (saturated.plan.unwrap(), primitive.plan.unwrap());
            assert_eq!(a.moves, b.moves, "{from:?} to {to:?}");
            if objective == Objective::Margin {
                let (a, b) = (a.margin.unwrap().lower, b.margin.unwrap().lower);
                assert!((a - b).abs() <= 2.0 * MARGIN_TOLERANCE, "{from:?} to {to:?}: {a} against {b}");
            }
        }
    }
}
