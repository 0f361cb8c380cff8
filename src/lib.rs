//! A reconfiguration planner for modular self-reconfigurable robots in which
//! every transient state is proved stable.
//!
//! Modular robots change shape by detaching, moving and attaching modules, and
//! every moment in between the connectors must hold. This crate joins a
//! graph search over such actions with an oracle that finds, by second-order cone
//! programming, how strong the connections must be for a state to stand.
//!
//! # The problem
//!
//! A [structure](statics::Structure) is a set of rigid bodies held by connections
//! (magnets, latches, faces) and frictional contacts under gravity and loads. The
//! oracle finds its **utilisation**
//!
//! ```text
//! t* = min t   subject to   balance of every free body (6 equations),
//!                           |f_t| <= mu f_n at every contact,
//!                           s_l(w_l) <= t S_l for every connection,
//! ```
//!
//! where `s_l(w)` is the strength that a wrench `w` demands of connection `l` and
//! `S_l` its rated strength. `t* <= 1` is stable, `t* > 1` internally unstable (some
//! connection must break), and no solution at all whole-body unstable (it tips,
//! slides or falls). The **internal stability margin** is `1 - t*`; positive is safe.
//! Every answer is a [bracket](statics::Bracket) whose two ends are evaluated from
//! wrenches and twists on the original data, whatever a solver claims.
//!
//! # Questions beyond a verdict
//!
//! [`statics::load_range`] finds the interval of a force `lambda e` on a body that the structure
//! withstands, each end one program and a bracket,
//!
//! ```text
//! max lambda   subject to   balance under L + lambda e, friction cones, s_l <= u S_l;
//! ```
//!
//! [`statics::failure_order`] the order in which connections would give way,
//!
//! ```text
//! t_k = min max s_l / S_l over connections not yet critical, those critical at level j < k at t_j S_l;
//! ```
//!
//! [`statics::contact_self_stress`] whether a structure that stands does so only by contacts that press
//! on each other though no load makes them.
//!
//! # Plans
//!
//! A plan is a sequence of actions; its margin is the smallest margin over all its
//! transient states. [`reconfigure::solve`] finds the plan with the largest margin,
//! or the shortest one with enough of it, and says what it proved.
//!
//! The method of the oracle follows the paper on quasi-static stability of
//! modular robots with cone-constrained connectors (see `ARCHITECTURE.md`).
//!
//! # Conventions
//!
//! SI units throughout: m, kg, s, N, N m, rad. Frames are right-handed; gravity is a
//! vector of the input. Forces come before torques. A connection's wrench acts
//! **on the child**, at the connection point, in the connection frame, whose z
//! axis points towards the child; pushing the bodies together is `f_z > 0`.
//!
//! # Layers
//!
//! Each uses only what stands before it: [`spatial`] (poses, wrenches, twists),
//! [`statics`] (the oracle), [`certificate`] (proofs of its answers and their checker),
//! [`robot`] (module types, configurations), [`geometry`] (contacts and sweeps),
//! [`reconfigure`] (actions, transient states, plans), [`generate`] (random problems), [`suite`] (many
//! of them, and what can be said about the answers), [`io`] (files). The search engines are the package `planners`,
//! which knows no robots.
//!
//! # Asking the oracle
//!
//! ```
//! use steadfast::spatial::{Pose, Rotation, Vec3};
//! use steadfast::statics::{
//!     Anchor, Body, Connection, Connector, Model, Question, Structure, Verdict, assess,
//! };
//!
//! // One kilogram hangs from a magnet of 100 N.
//! let structure = Structure {
//!     gravity: Vec3::new(0.0, 0.0, -9.81),
//!     bodies: vec![Body { mass: 1.0, com: Vec3::new(0.0, 0.0, -0.1), fixed: false }],
//!     connectors: vec![Connector {
//!         name: "magnet".into(),
//!         strength: 100.0,
//!         model: Model::Cone { friction: [0.8, 0.8], radius: [0.02, 0.02, 0.02] },
//!     }],
//!     connections: vec![Connection {
//!         parent: Anchor::World,
//!         child: Anchor::Body(0),
//!         connector: 0,
//!         // z points from the ceiling down, towards the child.
//!         frame: Pose::from_parts(
//!             Vec3::zeros().into(),
//!             Rotation::from_axis_angle(&Vec3::x_axis(), std::f64::consts::PI),
//!         ),
//!     }],
//!     ..Structure::default()
//! };
//! let answer = assess(&structure, Question::VALUE).expect("the data is sound");
//! assert_eq!(answer.verdict, Verdict::Stable);
//! assert!(answer.utilisation.contains(0.0981));
//! ```
//!
//! # Planning from a scheduler
//!
//! ```
//! use std::sync::Arc;
//! use std::time::Duration;
//! use steadfast::reconfigure::{Objective, Options, Outcome, replay::replay, solve};
//! use steadfast::robot::{
//!     Catalogue, Configuration, Environment, Goal, Matching, Module, Orientation, Placement, Requirement,
//! };
//! use steadfast::spatial::Vec3;
//!
//! // Three cubes on a wall: the first is held, and the last is to come out from
//! // above the second to its far side.
//! let robot = |cells: [[i32; 3]; 3]| {
//!     let module = |(index, cell): (usize, [i32; 3])| Module {
//!         id: ["a", "b", "c"][index].to_string(),
//!         module_type: 0,
//!         placement: Placement { cell, orientation: Orientation::IDENTITY },
//!         fixed: index == 0,
//!     };
//!     let mut configuration = Configuration {
//!         catalogue: Arc::new(Catalogue::cube()),
//!         gravity: Vec3::new(0.0, 0.0, -9.81),
//!         environment: Environment::default(),
//!         modules: cells.into_iter().enumerate().map(module).collect(),
//!         connections: Vec::new(),
//!         loads: Vec::new(),
//!         require: Requirement::default(),
//!     };
//!     configuration.connections = configuration.touching_connections();
//!     configuration
//! };
//! let start = robot([[0, 0, 0], [1, 0, 0], [1, 0, 1]]);
//! let goal = Goal { configuration: robot([[0, 0, 0], [1, 0, 0], [2, 0, 0]]), matching: Matching::default() };
//!
//! let options = Options {
//!     objective: Objective::Moves,
//!     min_margin: Some(0.2),
//!     time_limit: Some(Duration::from_secs(60)),
//!     ..Options::default()
//! };
//! let report = solve(&start, &goal, &options, &mut |_progress| {}).expect("the input is sound");
//! assert_eq!(report.outcome, Outcome::Solved);
//! let plan = report.plan.expect("solved");
//! assert_eq!(plan.moves, 1);
//!
//! // Trust is good: replay it by code that shares no decision with the search.
//! let check = replay(&start, &goal, &plan, 0.2).expect("the input is sound");
//! assert!(check.is_verified());
//! ```
//!
//! # What it does not do
//!
//! Quasi-static only: no inertia, no impact, no vibration. Rigid bodies: among all
//! balanced force distributions the oracle takes the best one, so contacts may be
//! counted on for friction that a real sequence of loading would not raise (see
//! [`statics::contact_self_stress`]). Moves
//! are checked on samples (at most 15 degrees or an eighth of a cell apart, refined
//! around the worst), not between them. One module, joint or connection moves at a time.

pub mod certificate;
pub mod generate;
pub mod geometry;
pub mod io;
pub mod reconfigure;
pub mod robot;
pub mod schedule;
pub mod spatial;
pub mod statics;
pub mod suite;

/// The README's examples, compiled.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
pub struct Readme;
