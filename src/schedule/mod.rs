//! What a program that runs robots for a long time wants of the planner.
//!
//! Nothing here keeps anything between calls. The state of the robot is a value (a [`Problem`] has it as its start),
//! what changes is a function from one problem to the next (`changes`), and planning again is planning from there:
//!
//! - [`Robot::after`] gives the configuration after some actions of a plan, also from its middle, and
//!   [`Robot::misplaced`] tells what is not where it should be;
//! - [`weaken_connector`], [`weaken_port`], [`remove`] and [`without`] say what has happened; modules that may not move and
//!   regions that none may enter are plain data in the start's [`Requirement`](crate::robot::Requirement);
//! - a [`Job`] plans on a thread of its own: events through a channel, cancelled from anywhere, until a deadline
//!   ([`until`]);
//! - [`plan_batch`] plans many problems at once.
//!
//! Which actions of a plan may run at the same time, [`Problem::partial_order`] says, for lattices and linkages alike:
//! a graph of what waits for what, and when everything ends if each action begins as early as it may. Errors are types,
//! and nothing is printed.
//!
//! ```
//! use steadfast::reconfigure::{Objective, Options};
//! use steadfast::schedule::{Job, Problem, Robot, until};
//! # use steadfast::io::{SourceFile, no_references, read_problem};
//! # let file = |name: &str| {
//! #     let path = format!("{}/problems/cubes/overhang/{name}", env!("CARGO_MANIFEST_DIR"));
//! #     SourceFile::new(name, std::fs::read(path).expect("the problem library is there"))
//! # };
//! # let read = read_problem(&file("start.json"), &file("goal.json"), &no_references).expect("sound input");
//! # let read = read.into_lattice().expect("cubes sit in a lattice");
//! let problem = Problem::lattice(read.start, read.goal);
//! let soon = std::time::Instant::now() + std::time::Duration::from_secs(60);
//! let options = until(soon, Options { objective: Objective::Moves, ..Options::default() });
//!
//! let job = Job::start(problem.clone(), options.clone());
//! let plan = job.wait()?.plan.expect("there is one");
//!
//! // The robot has done half of it when something changes: plan on from where it is.
//! let done = plan.actions.iter().take(plan.actions.len() / 2).map(|planned| &planned.action);
//! let now = problem.from_state(problem.start.after(done).expect("a plan is legal"));
//! let rest = now.plan(&options, &mut |_| {})?.plan.expect("there still is one");
//! assert!(rest.moves <= plan.moves);
//! # Ok::<(), steadfast::reconfigure::Refusal>(())
//! ```

mod batch;
mod changes;
mod job;
mod robot;

use std::time::Instant;

use crate::reconfigure::linkage::{self, replay as linkage_replay};
use crate::reconfigure::partial_order::{OrderError, OrderOptions, PartialOrder};
use crate::reconfigure::replay::{Replay, replay};
use crate::reconfigure::{Event, Options, Plan, Refusal, Report, solve};
use crate::robot::linkage::Linkage;
use crate::robot::{self as parts, Configuration, Matching};

pub use batch::{best, plan_batch};
pub use changes::{ChangeError, remove, weaken_connector, weaken_port, without};
pub use job::{Canceller, Job};
pub use robot::{Deviation, Robot};

/// Where a robot is and where it is to be.
#[derive(Clone, Debug, PartialEq)]
pub struct Problem<R> {
    /// Where it is now, in its surroundings, with what every transient state must satisfy.
    pub start: R,
    /// Where its modules are to be.
    pub goal: R,
    /// How the goal is compared with a state.
    pub matching: Matching,
}

/// What planning answers about a robot.
pub type ReportOf<R> = Report<<R as Robot>::Action, <R as Robot>::Connection>;

/// What a caller sees of planning for a robot.
pub type EventOf<R> = Event<<R as Robot>::Action, <R as Robot>::Connection>;

/// A plan of a robot.
pub type PlanOf<R> = Plan<<R as Robot>::Action, <R as Robot>::Connection>;

/// The partial order of a plan of a robot.
pub type OrderOf<R> = PartialOrder<<R as Robot>::Touched>;

/// Why a plan of a robot has no partial order.
pub type BrokenOf<R> = OrderError<<R as Robot>::Touched>;

impl Problem<Configuration> {
    /// Of lattice modules.
    pub fn lattice(start: Configuration, goal: parts::Goal) -> Self {
        Self { start, goal: goal.configuration, matching: goal.matching }
    }
}

impl Problem<Linkage> {
    /// Of modules outside lattices.
    pub fn linkage(start: Linkage, goal: parts::linkage::Goal) -> Self {
        Self { start, goal: goal.linkage, matching: goal.matching }
    }
}

impl<R: Robot> Problem<R> {
    /// The same goal from another state.
    #[must_use]
    pub fn from_state(&self, now: R) -> Self {
        Self { start: now, ..self.clone() }
    }

    /// Plans, on this thread and those of the rayon pool that it is called in. See
    /// [`solve`](crate::reconfigure::solve()) for what is guaranteed.
    ///
    /// # Errors
    /// [`Refusal`] for bad input.
    pub fn plan(&self, options: &Options, on_event: &mut dyn FnMut(&EventOf<R>)) -> Result<ReportOf<R>, Refusal> {
        R::solve(self, options, on_event)
    }

    /// Checks a plan by code that shares no decision with the planner; `required` is the margin that every transient
    /// state must have.
    ///
    /// # Errors
    /// [`Refusal`] for bad input.
    pub fn replay(&self, plan: &PlanOf<R>, required: f64) -> Result<Replay<R::Connection, R::Touched>, Refusal> {
        R::replay(self, plan, required)
    }

    /// Which actions of a plan from the start may run at the same time, and which have to wait for which: every order
    /// and every overlap that it allows is legal, free of collision and stable. See
    /// [`partial_order`](mod@crate::reconfigure::partial_order).
    ///
    /// # Errors
    /// [`OrderError`] for a plan that does not hold in its own order.
    pub fn partial_order(&self, plan: &PlanOf<R>, options: &OrderOptions) -> Result<OrderOf<R>, BrokenOf<R>> {
        self.start.partial_order(plan, options)
    }
}

/// Options with which planning ends at `deadline`, or after their own time limit if that is sooner. Counted from now.
#[must_use]
pub fn until(deadline: Instant, options: Options) -> Options {
    let left = deadline.saturating_duration_since(Instant::now());
    Options { time_limit: Some(options.time_limit.map_or(left, |limit| limit.min(left))), ..options }
}

fn solve_lattice(
    problem: &Problem<Configuration>,
    options: &Options,
    on_event: &mut dyn FnMut(&Event),
) -> Result<Report, Refusal> {
    let goal = parts::Goal { configuration: problem.goal.clone(), matching: problem.matching };
    solve(&problem.start, &goal, options, on_event)
}

fn replay_lattice(problem: &Problem<Configuration>, plan: &Plan, required: f64) -> Result<Replay, Refusal> {
    let goal = parts::Goal { configuration: problem.goal.clone(), matching: problem.matching };
    replay(&problem.start, &goal, plan, required)
}

fn solve_linkage(
    problem: &Problem<Linkage>,
    options: &Options,
    on_event: &mut dyn FnMut(&EventOf<Linkage>),
) -> Result<ReportOf<Linkage>, Refusal> {
    let goal = parts::linkage::Goal { linkage: problem.goal.clone(), matching: problem.matching };
    linkage::solve(&problem.start, &goal, options, on_event)
}

fn replay_linkage(
    problem: &Problem<Linkage>,
    plan: &PlanOf<Linkage>,
    required: f64,
) -> Result<Replay<linkage::assembly::Held, linkage::assembly::Touched>, Refusal> {
    let goal = parts::linkage::Goal { linkage: problem.goal.clone(), matching: problem.matching };
    linkage_replay::replay(&problem.start, &goal, plan, required)
}
