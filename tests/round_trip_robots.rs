//! Configurations and plan files come back equal, whatever they say: written
//! and read, also where a plan makes no sense or contradicts itself.

use std::sync::Arc;

use proptest::collection::vec;
use proptest::option;
use proptest::prelude::*;
use proptest::sample::{Index, select};
use steadfast::io::{
    AxisAngle, Contradiction, LatticeProblem, PlanDocument, SourceFile, no_references, read_configuration, read_plan,
    write_configuration, write_plan,
};
use steadfast::reconfigure::{
    Action, Bottleneck, IfStronger, Impossible, Limit, Moment, Objective, Outcome, Plan, PlannedAction, Proof, Report,
    Statistics, Turn, Which,
};
use steadfast::robot::{
    Catalogue, Cell, Configuration, Environment, Face, FaceConnection, Goal, Ground, HeightField, Hull, Matching, Mesh,
    Module, ModuleLoad, Motion, MotionType, Obstacle, Orientation, Placement, Port, Requirement, Shape, Stencil,
    Terrain,
};
use steadfast::spatial::{Pose, Rotation, Vec3};
use steadfast::statics::Bracket;

fn number() -> impl Strategy<Value = f64> {
    use prop::num::f64;
    f64::NORMAL | f64::SUBNORMAL | f64::ZERO
}

fn vector() -> impl Strategy<Value = Vec3> {
    [number(), number(), number()].prop_map(Vec3::from)
}

fn face() -> impl Strategy<Value = Face> {
    select(Face::ALL.to_vec())
}

fn orientation() -> impl Strategy<Value = Orientation> {
    vec(face(), 0..4).prop_map(|turns| {
        turns.into_iter().fold(Orientation::IDENTITY, |so_far, axis| so_far.turned(Orientation::quarter_turn(axis)))
    })
}

/// A connected set of different cells.
fn cells() -> impl Strategy<Value = Vec<Cell>> {
    vec((any::<Index>(), face()), 0..7).prop_map(|growth| {
        let mut cells = vec![[3, -2, 1]];
        for (from, towards) in growth {
            let next = add(*from.get(&cells), towards.step());
            if !cells.contains(&next) {
                cells.push(next);
            }
        }
        cells
    })
}

fn add(a: Cell, b: Cell) -> Cell {
    std::array::from_fn(|i| a[i] + b[i])
}

/// The built-in catalogue, or one like it that a file must spell out.
fn catalogue() -> impl Strategy<Value = Catalogue> {
    option::of((1e-3..10.0, "\\PC{0,9}", motions())).prop_map(|own| {
        let mut catalogue = Catalogue::cube();
        if let Some((mass, name, motions)) = own {
            catalogue.name = name;
            catalogue.module_types[0].bodies[0].mass = mass;
            catalogue.motions.extend(motions);
            catalogue.module_types[0].lattice.as_mut().unwrap().motions = (1..catalogue.motions.len()).collect();
        }
        catalogue
    })
}

/// Motions that are not built in: several cells at once over a row, and a turn, wanting more or less room.
fn motions() -> impl Strategy<Value = Vec<MotionType>> {
    let turn = select(vec![Turn::Quarter, Turn::Half]);
    option::of(("[a-z]{4}\\PC{0,5}", 1..9i32, turn, any::<bool>())).prop_map(|own| {
        own.into_iter()
            .filter(|(name, ..)| !["roll", "slide", "pivot", "rotate"].contains(&name.as_str()))
            .map(|(name, cells, turn, mirrored)| {
                let motion = Motion::Translation { by: [0, cells, 0] };
                let occupied = (0..=cells).map(|y| [1, y, 0]).collect();
                let along = Stencil { motion, occupied, free: vec![[-1, 0, 0], [-1, cells, 0]], mirrored };
                let motion = Motion::Rotation { support: Face::NegY, towards: Face::PosX, turn };
                let over =
                    Stencil { motion, occupied: vec![[0, -1, 0], [1, -1, 0]], free: Vec::new(), mirrored: false };
                let round = Stencil { occupied: vec![[0, -1, 0]], ..over.clone() };
                let about = if turn == Turn::Quarter { over } else { round };
                MotionType { name, stencils: vec![along, about] }
            })
            .collect()
    })
}

/// Every kind of shape that an obstacle has, of a few metres.
fn terrain() -> impl Strategy<Value = Terrain> {
    let size = || 0.01..1.0;
    let points = || vec([size(), size(), size()].prop_map(Vec3::from), 4..9);
    let mesh = (points(), vec([0u32..4, 0u32..4, 0u32..4], 1..6))
        .prop_filter_map("no area", |(points, triangles)| Mesh::new(points, triangles).ok());
    prop_oneof![
        [size(), size(), size()].prop_map(|half| Shape::Cuboid { half_extents: Vec3::from(half) }.into()),
        (size(), size()).prop_map(|(radius, height)| Shape::Cylinder { radius, height }.into()),
        size().prop_map(|radius| Shape::Ball { radius }.into()),
        points().prop_filter_map("flat", |points| Some(Shape::Convex(Arc::new(Hull::new(points).ok()?)).into())),
        Just(Terrain::HalfSpace),
        (size(), size(), vec(vec(size(), 3), 2..4))
            .prop_map(|(x, y, heights)| { Terrain::HeightField(Arc::new(HeightField::new([x, y], heights).unwrap())) }),
        mesh.prop_map(|mesh| Terrain::Mesh(Arc::new(mesh))),
    ]
}

prop_compose! {
    /// An obstacle where no module can be.
    fn obstacles()(
        shape in terrain(), at in [50.0..60.0, -60.0..60.0, -60.0..60.0],
        turn in [-3.2..3.2, -1.6..1.6, -3.2..3.2], friction in number(),
    ) -> Obstacle {
        let rotation = Rotation::from_euler_angles(turn[0], turn[1], turn[2]);
        // A half-space that looks away from the modules.
        let rotation = if shape == Terrain::HalfSpace { Rotation::from_euler_angles(0.0, -1.5, 0.0) } else { rotation };
        Obstacle { shape, pose: Pose::from_parts(Vec3::from(at).into(), rotation), friction: friction.abs() }
    }
}

prop_compose! {
    fn configurations()(
        cells in cells(), catalogue in catalogue(), name in "\\PC{0,9}", gravity in vector(),
        turns in vec(orientation(), 8), fixed in vec(any::<bool>(), 8), module_type: Index,
        obstacles in vec(obstacles(), 0..3), ground in option::of((0.0..1.0, number())), module_friction in number(),
        loads in vec((any::<Index>(), vector(), vector(), option::of(vector())), 0..3),
        margin in number(), connected: bool, engaged in vec(any::<bool>(), 32),
    ) -> Configuration {
        let module_type = module_type.index(catalogue.module_types.len());
        let pitch = catalogue.module_types[module_type].cell().pitch;
        let lowest = cells.iter().map(|cell| cell[2]).min().unwrap();
        let ground = ground.map(|(gap, friction)| Ground {
            height: f64::from(lowest) * pitch - gap,
            friction: friction.abs(),
        });
        let modules = cells.iter().enumerate().map(|(i, &cell)| Module {
            id: format!("{name}{i}"),
            module_type,
            placement: Placement { cell, orientation: turns[i] },
            fixed: fixed[i],
        });
        let modules: Vec<_> = modules.collect();
        let load = |(module, force, torque, at): (Index, Vec3, Vec3, Option<Vec3>)| ModuleLoad {
            module: module.index(modules.len()), force, torque, at,
        };
        let mut configuration = Configuration {
            loads: loads.into_iter().map(load).collect(),
            catalogue: Arc::new(catalogue),
            gravity,
            environment: Environment { ground, obstacles, module_friction: module_friction.abs() },
            modules,
            connections: Vec::new(),
            require: Requirement { margin, connected, ..Requirement::default() },
        };
        let mut engaged = engaged.into_iter().cycle();
        configuration.connections = configuration.touching_connections();
        configuration.connections.retain(|_| connected || engaged.next() == Some(true));
        configuration
    }
}

fn bracket() -> impl Strategy<Value = Bracket> {
    let lower = prop_oneof![3 => number(), 1 => Just(f64::NEG_INFINITY)];
    let upper = prop_oneof![3 => number(), 1 => Just(f64::INFINITY)];
    (lower, upper).prop_map(|(lower, upper)| Bracket::new(lower, upper))
}

/// What an action is made of, before there are modules.
#[derive(Clone, Debug)]
struct Draft {
    kind: usize,
    modules: [Index; 2],
    faces: [Face; 3],
    half: bool,
    to: Cell,
    margin: Option<Bracket>,
    phase: Option<f64>,
}

prop_compose! {
    fn drafts()(
        kind in 0..4usize, modules: [Index; 2], faces in [face(), face(), face()], half: bool,
        to in [-1_000_000..=1_000_000, -1_000_000..=1_000_000, -1_000_000..=1_000_000],
        margin in option::of(bracket()), phase in option::of(0.0..=1.0),
    ) -> Draft {
        Draft { kind, modules, faces, half, to, margin, phase }
    }
}

#[derive(Clone, Debug)]
struct Sketch {
    drafts: Vec<Draft>,
    margin: Option<Bracket>,
    moves: u32,
    /// Action and phase.
    bottleneck: Option<(Option<usize>, f64)>,
    held: Option<(Index, Face, Face)>,
}

prop_compose! {
    fn sketches()(
        drafts in vec(drafts(), 0..6), margin in option::of(bracket()), moves: u32,
        bottleneck in option::of((option::of(0..9usize), 0.0..=1.0)), held in option::of((any::<Index>(), face(), face())),
    ) -> Sketch {
        Sketch { drafts, margin, moves, bottleneck, held }
    }
}

fn connection(modules: [usize; 2], faces: [Face; 2]) -> FaceConnection {
    FaceConnection::new(Port { module: modules[0], face: faces[0] }, Port { module: modules[1], face: faces[1] })
}

/// The plan of a sketch, and what in it contradicts itself.
fn plan(start: &Configuration, sketch: &Sketch, number: usize) -> (Plan, Vec<Contradiction>) {
    let mut cells: Vec<Cell> = start.modules.iter().map(|module| module.placement.cell).collect();
    let mut contradictions = Vec::new();
    let mut actions = Vec::new();
    let kinds = u16::try_from(start.catalogue.motions.len()).unwrap();
    for draft in &sketch.drafts {
        let [module, other] = draft.modules.map(|index| index.index(cells.len()));
        let pair = connection([module, other], [draft.faces[0], draft.faces[1]]);
        let action = match draft.kind {
            0 => Action::Attach(pair),
            1 => Action::Detach(pair),
            2 if module != other => {
                let beside = if draft.half { cells[other] } else { cells[module] };
                Action::Move { motion: kinds - 1, module, support: Some(other), to: add(beside, draft.faces[0].step()) }
            }
            _ => Action::Move { motion: if kinds > 2 { 2 } else { 0 }, module, support: None, to: draft.to },
        };
        if let Action::Move { module, support: Some(support), to, .. } = action {
            let given = AxisAngle { axis: draft.faces[2], turn: if draft.half { Turn::Half } else { Turn::Quarter } };
            let actual = AxisAngle::between(cells[module], cells[support], to);
            if actual != Some(given) && (actual.is_none() || draft.faces[1] == Face::NegX) {
                contradictions.push(Contradiction { plan: number, action: actions.len(), given, actual });
            }
        }
        if let Action::Move { module, to, .. } = action {
            cells[module] = to;
        }
        actions.push(PlannedAction { action, margin: draft.margin, phase: draft.phase });
    }
    let held = sketch.held.map(|(module, a, b)| connection([module.index(cells.len()); 2], [a, b]));
    let bottleneck = sketch.bottleneck.map(|(action, phase)| Bottleneck { action, phase, connection: held });
    let moment = |margin| Moment { action: Some(actions.len()), phase: 0.25, margin };
    let profile = sketch.margin.map(moment).into_iter().collect();
    let if_stronger = sketch.margin.map(|margin| IfStronger { factor: 2.0, margin });
    (Plan { margin: sketch.margin, moves: sketch.moves, bottleneck, actions, profile, if_stronger }, contradictions)
}

fn limit() -> impl Strategy<Value = Limit> {
    select(vec![Limit::Deadline, Limit::Expansions, Limit::Memory, Limit::Cancelled, Limit::Precision])
}

/// Reasons; module indices are all 0.
fn impossible() -> impl Strategy<Value = Impossible> {
    let which = || select(vec![Which::Start, Which::Goal]);
    let margin = prop_oneof![bracket(), Just(Bracket::exact(f64::NEG_INFINITY))];
    let held = option::of((face(), face())).prop_map(|faces| faces.map(|(a, b)| connection([0, 0], [a, b])));
    prop_oneof![
        ("\\PC*", any::<[u32; 2]>()).prop_map(|(module_type, [start, goal])| Impossible::ModulesDiffer {
            module_type,
            start: start as usize,
            goal: goal as usize,
        }),
        "\\PC*".prop_map(|module| Impossible::FixedModule { module }),
        which().prop_map(Impossible::Disconnected),
        (which(), margin, number(), held).prop_map(|(which, margin, required, connection)| Impossible::Unstable {
            which,
            margin,
            required,
            connection,
        }),
        (any::<i32>(), which()).prop_map(|(level, which)| Impossible::Sealed { level, which }),
        prop_oneof![number(), Just(f64::NEG_INFINITY)].prop_map(|required| Impossible::Exhausted { required }),
    ]
}

fn outcomes() -> impl Strategy<Value = Outcome> {
    prop_oneof![
        Just(Outcome::Solved),
        limit().prop_map(Outcome::OutOfBudget),
        impossible().prop_map(Outcome::Impossible)
    ]
}

prop_compose! {
    fn statistics()(counts: [u64; 6], seconds in number()) -> Statistics {
        let [expanded, states, generated, certified, oracle_solves, bytes] = counts;
        let seconds = seconds.abs();
        Statistics { expanded, states, generated, certified, oracle_solves, bytes, seconds, ..Statistics::default() }
    }
}

/// A goal for a start: as it is, or its mirror image with other orientations where no module is fixed.
fn goal(start: &Configuration, labelled: bool, free_frame: bool, turns: &[Orientation]) -> Goal {
    let mut configuration = start.clone();
    if start.modules.iter().all(|module| !module.fixed) {
        for (module, turn) in configuration.modules.iter_mut().zip(turns) {
            module.placement.cell[0] *= -1;
            module.placement.orientation = *turn;
        }
        configuration.connections = configuration.touching_connections();
    }
    Goal { configuration, matching: Matching { labelled, free_frame } }
}

prop_compose! {
    fn documents()(
        start in configurations(), labelled: bool, free_frame: bool, turns in vec(orientation(), 8),
        outcome in outcomes(), cut_by in option::of(limit()), by_moves: bool, required in option::of(number()), found: bool,
        sketches in vec(sketches(), 1..4), statistics in statistics(), optimal: bool,
        bounds in (option::of(number()), option::of(0..u32::MAX)),
    ) -> PlanDocument {
        let goal = goal(&start, labelled, free_frame, &turns);
        let has_plan = match outcome {
            Outcome::Solved => true,
            Outcome::OutOfBudget(_) => found,
            Outcome::Impossible(_) => false,
        };
        let sketches = sketches.iter().filter(|_| has_plan).enumerate();
        let (plans, contradictions): (Vec<_>, Vec<_>) =
            sketches.map(|(number, sketch)| plan(&start, sketch, number)).unzip();
        let mut plans = plans.into_iter();
        // Without any plan, everything holds of all plans; else no bound is an infinite one.
        let unproved = if matches!(outcome, Outcome::Impossible(_)) {
            (f64::NEG_INFINITY, u32::MAX)
        } else {
            (f64::INFINITY, 0)
        };
        PlanDocument {
            problem: LatticeProblem { start, goal },
            report: Report {
                outcome,
                objective: if by_moves { Objective::Moves } else { Objective::Pareto },
                required,
                plan: plans.next(),
                alternatives: plans.collect(),
                alternatives_cut_by: cut_by,
                in_the_way: None,
                proof: Proof {
                    optimal,
                    margin_at_most: bounds.0.unwrap_or(unproved.0),
                    moves_at_least: bounds.1.unwrap_or(unproved.1),
                },
                statistics,
            },
            contradictions: contradictions.concat(),
        }
    }
}

proptest! {
    #[test]
    fn configurations_come_back(configuration in configurations()) {
        let text = write_configuration(&configuration).unwrap();
        match read_configuration(&SourceFile::new("written", text), &no_references) {
            Ok(read) => prop_assert_eq!(read, configuration),
            Err(diagnostics) => prop_assert!(false, "{}", diagnostics),
        }
    }

    #[test]
    fn plan_files_come_back(document in documents()) {
        let text = write_plan(&document).unwrap();
        match read_plan(&SourceFile::new("written", text)) {
            Ok(read) => prop_assert_eq!(read, document),
            Err(diagnostics) => prop_assert!(false, "{}", diagnostics),
        }
    }
}
