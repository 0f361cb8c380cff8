//! Where displacements change nothing: that they do not, what switches that off, and proofs of the best margin against exhaustive
//! search of a box.

use planners::{Periodic, Reversible, Search, Space, Transition, Width};
use proptest::prelude::*;

use crate::reconfigure::domain::Domain;
use crate::reconfigure::layout::displaced;
use crate::reconfigure::moves::Move;
use crate::reconfigure::open_ground::OpenGround;
use crate::reconfigure::plan::{Objective, Outcome};
use crate::reconfigure::problem::{Problem, cells};
use crate::reconfigure::saturated::{Action, Saturated, State, of_move};
use crate::reconfigure::symmetry::Symmetry;
use crate::reconfigure::{Layout, MARGIN_TOLERANCE, Options};
use crate::robot::{Cell, Configuration, ModuleLoad, Obstacle, Region, Shape, Terrain};
use crate::spatial::{Pose, Vec3};
use crate::statics::Model;

use super::{cubes, goal, plan, polycube, solved};

fn symmetry(start: &Configuration) -> Option<Symmetry> {
    Symmetry::of(&Problem::new(start, &goal(start.clone())).unwrap())
}

/// The layout of cubes in these cells.
fn layout_of(filled: &[Cell]) -> Layout {
    cells(&cubes(filled, 0))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// The image of a move that stands for all of them is a move of an image of its layout, and as strong.
    #[test]
    fn images_of_moves_have_their_margins(filled in polycube(6), choice in any::<usize>(), by in [-40..40_i32, -40..40_i32]) {
        let start = cubes(&filled.iter().map(|&cell| displaced(cell, [by[0], by[1], 0])).collect::<Vec<_>>(), 0);
        let problem = Problem::new(&start, &goal(start.clone())).unwrap();
        let domain = Domain::new(&problem, true);
        let symmetry = Symmetry::of(&problem).unwrap();
        let moves = domain.moves(problem.start_layout());
        let Some(&step) = moves.get(choice % moves.len().max(1)) else { return Ok(()) };
        let (layout, image) = symmetry.kind_of_move(problem.start_layout(), step);
        prop_assert_eq!(symmetry.kind(&layout), symmetry.kind(problem.start_layout()));
        let images = domain.moves(&layout);
        prop_assert_eq!(moves.len(), images.len(), "there are as many moves");
        prop_assert!(images.contains(&image), "the image is a move");
        let of = |layout: &Layout, step| of_move(&domain, layout, step, f64::NEG_INFINITY).margin;
        let (own, other) = (of(problem.start_layout(), step), of(&layout, image));
        // Impossible moves are so wherever they are.
        let close = |a: f64, b: f64| a == b || (a - b).abs() <= MARGIN_TOLERANCE * a.abs().max(1.0);
        prop_assert!(close(own.lower, other.lower) && close(own.upper, other.upper), "{:?} and {:?}", own, other);
        // The modules that stay are where they are for the other moves of the module, up to their own symmetries.
        let staying = |layout: &Layout, step: Move| {
            layout.placed().iter().copied().filter(|placed| placed.cell != step.from).collect::<Vec<_>>()
        };
        for &other in moves.iter().filter(|other| other.from == step.from) {
            let (elsewhere, other) = symmetry.kind_of_move(problem.start_layout(), other);
            prop_assert_eq!(staying(&layout, image), staying(&elsewhere, other));
        }
        // And it leads to an image of where the move leads.
        let after = [domain.after(problem.start_layout(), step), domain.after(&layout, image)];
        prop_assert_eq!(symmetry.kind(&after[0]), symmetry.kind(&after[1]));
    }

    /// Classes are what they are, wherever a layout is; kinds whichever way it is turned or seen in a mirror.
    #[test]
    fn classes_forget_where_and_kinds_which_way(filled in polycube(8), by in [-40..40_i32, -40..40_i32], quarters in 0..4) {
        let symmetry = symmetry(&cubes(&filled, 0)).unwrap();
        let here = layout_of(&filled);
        let moved = here.displaced([by[0], by[1], 0]);
        let ((class, at), (same, there)) = (symmetry.class(&here), symmetry.class(&moved));
        prop_assert_eq!(&class, &same);
        prop_assert_eq!(displaced(at, [by[0], by[1], 0]), there);
        prop_assert_eq!(class.displaced(at), here.clone());
        prop_assert_eq!(symmetry.class(&class), (class.clone(), [0; 3]));
        let mirror = |[x, y, z]: Cell| [y, x, z];
        let turned: Vec<Cell> = (0..quarters).fold(filled, |cells, _| cells.iter().map(|&[x, y, z]| [-y, x, z]).collect());
        prop_assert_eq!(symmetry.kind(&layout_of(&turned)), symmetry.kind(&here));
        let mirrored: Vec<Cell> = turned.into_iter().map(mirror).collect();
        prop_assert_eq!(symmetry.kind(&layout_of(&mirrored)), symmetry.kind(&here));
        prop_assert_eq!(symmetry.kind(&symmetry.kind(&here)), symmetry.kind(&here));
    }
}

#[test]
fn whatever_has_a_place_takes_displacements_away() {
    let free = cubes(&[[0, 0, 0], [1, 0, 0], [0, 0, 1]], 0);
    assert!(symmetry(&free).is_some());
    assert_eq!(symmetry(&cubes(&[[0, 0, 0], [1, 0, 0], [0, 0, 1]], 1)), None, "a held module");
    let mut stays = free.clone();
    stays.require.stay = vec![0];
    assert_eq!(symmetry(&stays), None, "a module that may not move");
    let mut wall = free.clone();
    wall.environment.obstacles = vec![Obstacle {
        shape: Terrain::Solid(Shape::Cuboid { half_extents: Vec3::new(1.0, 0.1, 1.0) }),
        pose: Pose::translation(0.0, 5.0, 1.0),
        friction: 0.5,
    }];
    assert_eq!(symmetry(&wall), None, "a wall, however far");
    let mut region = free.clone();
    region.require.keep_out = vec![Region { low: Vec3::new(9.0, 9.0, 0.0), high: Vec3::new(10.0, 10.0, 1.0) }];
    assert_eq!(symmetry(&region), None, "a forbidden region");
}

#[test]
fn what_has_a_direction_takes_turns_away_but_no_displacements() {
    let free = cubes(&[[0, 0, 0], [1, 0, 0], [0, 0, 1]], 0);
    let layouts = |start: &Configuration| {
        let symmetry = symmetry(start).expect("it displaces freely");
        let beside: [&[Cell]; 2] = [&[[0, 0, 0], [1, 0, 0], [0, 0, 1]], &[[0, 0, 0], [0, 1, 0], [0, 0, 1]]];
        beside.map(|cells| symmetry.kind(&layout_of(cells)))
    };
    let [a, b] = layouts(&free);
    assert_eq!(a, b);
    let mut tilted = free.clone();
    tilted.gravity.x = 1.0;
    let [a, b] = layouts(&tilted);
    assert_ne!(a, b, "gravity is not vertical");
    let mut pushed = free.clone();
    pushed.loads = vec![ModuleLoad { module: 0, force: Vec3::x(), torque: Vec3::zeros(), at: None }];
    let [a, b] = layouts(&pushed);
    assert_ne!(a, b, "a load");
    // Points of a patch that a quarter turn leaves where they are, but no mirror.
    let mut twisted = free;
    let catalogue = std::sync::Arc::make_mut(&mut twisted.catalogue);
    let (face, pitch) = (catalogue.module_types[0].cell().face, catalogue.module_types[0].cell().pitch);
    let points = [[0.4, 0.1], [-0.1, 0.4], [-0.4, -0.1], [0.1, -0.4]].map(|point| point.map(|c| c * pitch)).to_vec();
    catalogue.connectors[face].model = Model::Patch { friction: 0.5, points };
    let symmetry = symmetry(&twisted).unwrap();
    let hand = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 0, 1]];
    let other = hand.map(|[x, y, z]| [y, x, z]);
    let turned = hand.map(|[x, y, z]| [-y, x, z]);
    assert_eq!(symmetry.kind(&layout_of(&hand)), symmetry.kind(&layout_of(&turned)));
    assert_ne!(symmetry.kind(&layout_of(&hand)), symmetry.kind(&layout_of(&other)));
}

/// What of an open ground is within a box.
struct Boxed<'s, 'a> {
    space: &'s OpenGround<'a>,
    most: i32,
}

impl Space for Boxed<'_, '_> {
    type State = State;
    type Action = Action;

    fn start(&self) -> State {
        self.space.start()
    }

    fn is_goal(&self, state: &State) -> bool {
        self.space.is_goal(state)
    }

    fn transitions(&self, from: &State) -> Vec<Transition<State, Action>> {
        let mut transitions = self.space.transitions(from);
        let is_inside = |cell: &Cell| cell[..2].iter().all(|c| c.abs() <= self.most);
        transitions.retain(|transition| transition.to.layout().placed().iter().all(|placed| is_inside(&placed.cell)));
        transitions
    }

    fn certify(&self, from: &State, action: &Action, to: &State, floor: f64) -> Width {
        self.space.certify(from, action, to, floor)
    }

    fn remaining_cost(&self, _: &State) -> Option<u32> {
        Some(0)
    }
}

/// Pairs of layouts, each with room on all sides in a box of so many cells either way.
const PAIRS: &[(&[Cell], &[Cell])] = &[
    (&[[0, 0, 0], [1, 0, 0], [0, 0, 1]], &[[2, 0, 0], [2, 1, 0], [2, 0, 1]]),
    (&[[0, 0, 0], [0, 0, 1], [0, 0, 2]], &[[-1, 1, 0], [0, 1, 0], [1, 1, 0]]),
    (&[[0, 0, 0], [1, 0, 0], [2, 0, 0]], &[[0, 2, 0], [0, 2, 1], [0, 2, 2]]),
    (&[[0, 0, 0], [0, 0, 1], [1, 0, 1], [1, -1, 1]], &[[1, 0, 0], [1, 0, 1], [2, 0, 1], [2, 1, 1]]),
];

/// The best margin is that of an exhaustive search for the widest path, which uses neither classes nor estimates nor decisions; and
/// it is proved, although the robot could walk away for ever.
#[test]
fn proofs_on_open_ground_agree_with_exhaustive_search_of_a_box() {
    for &(from, to) in PAIRS {
        let (start, target) = (cubes(from, 0), goal(cubes(to, 0)));
        let problem = Problem::new(&start, &target).unwrap();
        let domain = Domain::new(&problem, true);
        let saturated = Saturated::new(&domain, Width::UNLIMITED, f64::INFINITY);
        let space = OpenGround::new(&domain, saturated, Symmetry::of(&problem).unwrap());
        let boxed = Boxed { space: &space, most: if from.len() < 4 { 5 } else { 4 } };
        let widest = Search::new(&boxed, planners::Options::default()).widest(f64::NEG_INFINITY);
        let widest = widest.solved().expect("there is a way").width.lower;
        let ends = [from, to].map(|cells| {
            let layout = Problem::new(&cubes(cells, 0), &goal(cubes(cells, 0))).unwrap();
            domain.of_state(layout.start_layout(), layout.start_bonds()).margin.lower
        });
        let truth = ends.into_iter().fold(widest, f64::min);
        let report = plan(&start, &target, &Options::default());
        let best = solved(&report).margin.unwrap().lower;
        assert!((best - truth).abs() <= 2.0 * MARGIN_TOLERANCE, "{from:?} to {to:?}: {best}, but {truth} in a box");
        assert!(report.proof.optimal && report.proof.margin_at_most >= best);
    }
}

/// Nothing leads there above the margin, and the robot could walk away for ever from both ends.
#[test]
fn no_plan_is_proved_on_open_ground() {
    let (from, to) = PAIRS[3];
    let (start, target) = (cubes(from, 0), goal(cubes(to, 0)));
    let best = solved(&plan(&start, &target, &Options::default())).margin.unwrap().lower;
    let options =
        |min_margin| Options { min_margin: Some(min_margin), objective: Objective::Moves, ..Options::default() };
    assert_eq!(plan(&start, &target, &options(best - 1e-5)).outcome, Outcome::Solved);
    let report = plan(&start, &target, &options(best + 1e-5));
    assert!(matches!(report.outcome, Outcome::Impossible(_)), "{report:#?}");
}

/// Classes of the space are those of its layouts, and no goal is one.
#[test]
fn the_space_keeps_its_promise_about_classes() {
    let start = cubes(PAIRS[3].0, 0);
    let target = goal(cubes(PAIRS[3].1, 0));
    let problem = Problem::new(&start, &target).unwrap();
    let domain = Domain::new(&problem, true);
    let saturated = Saturated::new(&domain, Width::UNLIMITED, f64::INFINITY);
    let space = OpenGround::new(&domain, saturated, Symmetry::of(&problem).unwrap());
    let state = space.start();
    let (class, at) = space.class(&state);
    assert_eq!(space.class(&class), (class.clone(), [0; 3]));
    let image = |transition: &Transition<State, Action>, shift: [i64; 3]| {
        let (to, by) = space.class(&transition.to);
        (
            to,
            std::array::from_fn::<i64, 3, _>(|i| by[i] + shift[i]),
            transition.cost,
            transition.width_at_most.to_bits(),
        )
    };
    for steps in [Space::transitions, <OpenGround as Reversible>::transitions_into] {
        let of = |state: &State, shift| -> Vec<_> {
            steps(&space, state).iter().map(|transition| image(transition, shift)).collect()
        };
        let (mut here, mut there) = (of(&state, [0; 3]), of(&class, at));
        let order = |a: &(State, [i64; 3], u32, u64), b: &(State, [i64; 3], u32, u64)| {
            (a.0.layout(), a.1, a.2, a.3).cmp(&(b.0.layout(), b.1, b.2, b.3))
        };
        here.sort_by(order);
        there.sort_by(order);
        assert_eq!(here, there);
        assert!(!here.is_empty());
    }
}
