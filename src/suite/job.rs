//! What is to be run.

use std::collections::BTreeSet;
use std::time::Duration;

use crate::generate::{Family, GoalKind, Request, Setting};
use crate::reconfigure::Objective;

/// How to plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Planner {
    /// The default search, exact.
    Exact,
    /// One module after another to where it is wanted, for many cubes; nothing is proved but that plans are safe.
    Decompose,
    /// The search over single actions: the slow reference, for cubes.
    Primitive,
    /// By geometry alone, as other planners do. Its plans are replayed to see which of them break.
    IgnoreStability,
}

/// What may be spent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Time of one job, planning alone.
    pub job_time: Duration,
    /// Memory of one job in bytes.
    pub job_bytes: u64,
    /// Time of all jobs together, by the wall clock; `None` without limit.
    pub total_time: Option<Duration>,
    /// Memory of all jobs that run at a time, in bytes; `None` without limit.
    pub total_bytes: Option<u64>,
}

/// Problems of one family, each planned for in several ways.
#[derive(Clone, Debug, PartialEq)]
pub struct Case {
    /// What kind of robot.
    pub family: Family,
    /// How many modules: a problem each.
    pub modules: Vec<usize>,
    /// Where the random numbers begin: a problem each.
    pub seeds: Vec<u64>,
    /// What surrounds the robot: a problem each.
    pub settings: Vec<Setting>,
    /// Whether the first module is held.
    pub held: bool,
    /// Where the goal comes from.
    pub goal: GoalKind,
    /// How far it is: see [`Request::difficulty`].
    pub difficulty: Option<usize>,
    /// Margin of start and goal.
    pub margin: f64,
    /// Margin that every transient state must have.
    pub min_margin: f64,
    /// What makes a plan better: a job each.
    pub objectives: Vec<Objective>,
    /// How to plan: a job each.
    pub planners: Vec<Planner>,
    /// Time of one job, where it is not the suite's.
    pub job_time: Option<Duration>,
    /// Memory of one job in bytes, where it is not the suite's.
    pub job_bytes: Option<u64>,
}

/// All that is to be run.
#[derive(Clone, Debug, PartialEq)]
pub struct Suite {
    /// Its name.
    pub name: String,
    /// What may be spent.
    pub limits: Limits,
    /// Its problems.
    pub cases: Vec<Case>,
}

/// One problem, planned for in one way.
#[derive(Clone, Debug, PartialEq)]
pub struct Job {
    /// The problem.
    pub request: Request,
    /// What makes a plan better.
    pub objective: Objective,
    /// How to plan.
    pub planner: Planner,
    /// Margin that every transient state must have.
    pub min_margin: f64,
    /// Time that planning may take.
    pub time: Duration,
    /// Memory that it may take, in bytes.
    pub bytes: u64,
}

impl Suite {
    /// The jobs in the order of the suite, each once: case by case, and problem by problem within a case.
    pub fn jobs(&self) -> Vec<Job> {
        let mut names = BTreeSet::new();
        let all = self.cases.iter().flat_map(|case| case.jobs(&self.limits));
        all.filter(|job| names.insert(job.name())).collect()
    }
}

impl Case {
    fn jobs(&self, limits: &Limits) -> Vec<Job> {
        let mut jobs = Vec::new();
        for &modules in &self.modules {
            for &setting in &self.settings {
                for &seed in &self.seeds {
                    for &objective in &self.objectives {
                        jobs.extend(self.planners.iter().map(|&planner| Job {
                            request: self.request(modules, setting, seed),
                            // Without margins there is none to be best at.
                            objective: if planner == Planner::IgnoreStability { Objective::Moves } else { objective },
                            planner,
                            min_margin: self.min_margin,
                            time: self.job_time.unwrap_or(limits.job_time),
                            bytes: self.job_bytes.unwrap_or(limits.job_bytes),
                        }));
                    }
                }
            }
        }
        jobs
    }

    fn request(&self, modules: usize, setting: Setting, seed: u64) -> Request {
        Request {
            family: self.family,
            modules,
            seed,
            setting,
            held: self.held,
            goal: self.goal,
            difficulty: self.difficulty,
            margin: self.margin,
        }
    }
}

impl Job {
    /// The problem's name: equal for equal problems. Everything that the problem depends on is in it.
    pub fn problem(&self) -> String {
        let Request { family, modules, seed, setting, held, goal, difficulty, margin } = self.request;
        let held = if held { "-held" } else { "" };
        let far = difficulty.map_or_else(String::new, |difficulty| format!("-{difficulty}"));
        format!("{}-{modules}-{}{held}-{}{far}-m{margin}-s{seed}", family.name(), setting.name(), goal.name())
    }

    /// The job's name: equal for equal jobs. Everything that its result depends on is in it, but for the
    /// machine and the program.
    pub fn name(&self) -> String {
        let Self { objective, planner, min_margin, time, bytes, .. } = self;
        let (objective, megabytes) = (objective_name(*objective), bytes >> 20);
        let least = if *min_margin == 0.0 { String::new() } else { format!("-above-{min_margin}") };
        format!("{}-{}-{objective}{least}-{}s-{megabytes}MB", self.problem(), planner.name(), time.as_secs_f64())
    }
}

impl Planner {
    /// Name as files write it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Exact => "exact",
            Self::Decompose => "decompose",
            Self::Primitive => "primitive",
            Self::IgnoreStability => "ignore-stability",
        }
    }
}

/// Name of an objective as files write it.
pub const fn objective_name(objective: Objective) -> &'static str {
    match objective {
        Objective::Margin => "margin",
        Objective::Moves => "moves",
        Objective::Pareto => "pareto",
    }
}
