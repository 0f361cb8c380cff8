//! What can be asked on the command line.

use std::path::PathBuf;
use std::time::Duration;

use clap::{ArgGroup, Args, Parser, Subcommand, ValueEnum};
use steadfast::robot::Region;

use crate::{bench, generate};

/// Reconfiguration planner for modular robots in which every transient state is proved stable
#[derive(Debug, Parser)]
#[command(
    name = "plan",
    version,
    after_help = EXIT_CODES,
    args_conflicts_with_subcommands = true,
    subcommand_negates_reqs = true
)]
pub struct Arguments {
    #[command(subcommand)]
    pub command: Option<Command>,
    #[command(flatten)]
    pub planning: Option<PlanningArguments>,
}

const EXIT_CODES: &str = "Exit codes: 0 plan found, structure stable, plan verified; 2 usage; 10 proved that no plan \
exists, structure unstable, plan does not verify; 11 not decided within the limits; 30 bad input; 101 a bug";

/// What `plan START GOAL` can be asked. It is there when these two are: without their names in the group, the arguments
/// that are flattened into it would leave the group empty.
#[derive(Debug, Args)]
#[group(args = ["start", "goal"])]
pub struct PlanningArguments {
    /// Where the robot is: a configuration/1 file
    #[arg(required = true)]
    pub start: PathBuf,
    /// Where it is to be: a configuration/1 file, which may leave out what the start says
    #[arg(required = true)]
    pub goal: PathBuf,
    /// What makes one plan better than another
    #[arg(long, value_enum, default_value_t = ObjectiveArgument::Margin)]
    pub objective: ObjectiveArgument,
    /// Margin that every transient state must have [default: what the start requires, or 0]
    #[arg(long, value_name = "X", value_parser = margin)]
    pub min_margin: Option<f64>,
    /// How many plans to find; they differ in more than the order of independent moves
    #[arg(long, value_name = "K", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub plans: u32,
    /// Seconds after which to stop with the best plan so far
    #[arg(long, value_name = "S", value_parser = seconds)]
    pub time_limit: Option<Duration>,
    /// Memory not to exceed, in bytes or with K, M, G or T for powers of 1024; the search stops with the best plan so
    /// far [default: half of the machine's memory]
    #[arg(long, value_name = "SIZE", value_parser = crate::memory::size)]
    pub memory_limit: Option<usize>,
    /// Threads for the oracle [default: all cores]; the plan does not depend on it
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Seed for choices among equals of a decomposition; the exact search makes none
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub seed: u64,
    /// Print a plan/1 document (and errors as an errors/1 document)
    #[arg(long)]
    pub json: bool,
    /// Write the plan/1 document to a file
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Write the plan's margins over time: .csv as a table, .svg as a picture
    #[arg(long, value_name = "FILE", value_parser = profile_file)]
    pub profile: Option<PathBuf>,
    /// Plan by geometry alone, for comparison; `plan verify` tells where such a plan breaks
    #[arg(long)]
    pub ignore_stability: bool,
    /// Search single attach, detach and move actions instead of whole moves: the slow reference
    #[arg(long)]
    pub primitive: bool,
    /// How to look for plans of lattice robots
    #[arg(long, value_enum, default_value_t = PlannerArgument::Auto)]
    pub planner: PlannerArgument,
    /// A module that no action may move, though nothing else holds it; may be given several times
    #[arg(long, value_name = "ID")]
    pub forbid_module: Vec<String>,
    /// A box that no move may pass through, by its lowest and highest corner in m; may be given several times
    #[arg(
        long,
        value_name = "X0,Y0,Z0,X1,Y1,Z1",
        value_parser = crate::restrictions::region,
        allow_hyphen_values = true
    )]
    pub forbid_region: Vec<Region>,
}

/// `--planner`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum PlannerArgument {
    /// Exact for few movable modules, decomposition for many
    Auto,
    /// Search of all states, with proofs of optimality
    Exact,
    /// One module after another to where it is wanted, for hundreds of modules; proved safe, not best
    Decompose,
}

/// `--objective`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ObjectiveArgument {
    /// The largest worst-case margin, then the fewest moves
    Margin,
    /// The fewest moves with at least the required margin
    Moves,
    /// Every trade between margin and moves that no other plan beats
    Pareto,
}

fn profile_file(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    let extension = path.extension().and_then(|extension| extension.to_str()).map(str::to_ascii_lowercase);
    match extension.as_deref() {
        Some("csv" | "svg") => Ok(path),
        _ => Err("a profile is written as .csv or .svg".to_string()),
    }
}

fn margin(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() && value <= 1.0 => Ok(value),
        Ok(_) => Err("a margin is at most 1, which only an unloaded robot has".to_string()),
        Err(error) => Err(error.to_string()),
    }
}

fn seconds(text: &str) -> Result<Duration, String> {
    let value: f64 = text.parse().map_err(|error: std::num::ParseFloatError| error.to_string())?;
    Duration::try_from_secs_f64(value).map_err(|error| error.to_string())
}

#[derive(Debug, Subcommand)]
pub enum Command {
    /// Check everything that a plan or a certificate claims: replay the one, recompute the other's proof
    Verify(VerifyArguments),
    /// Say whether a structure or a configuration is stable, and by what margin
    Check(CheckArguments),
    /// Find the range of a force at a module that a structure or a configuration withstands, and what fails
    /// at its ends
    #[command(after_help = RANGE_EXIT_CODES)]
    LoadRange(LoadRangeArguments),
    /// Map where a strut may stand over its node, or a joint in its range, and with what margin
    #[command(after_help = MOTION_EXIT_CODES)]
    MotionRange(MotionRangeArguments),
    /// Say which actions of a plan may run at the same time, so that whatever overlaps is stable throughout
    Parallel(ParallelArguments),
    /// Write a robot in another format: a configuration/1 file, or one of the RoFI platform's
    Convert(ConvertArguments),
    /// Draw a random problem: a start and a goal that both stand
    Generate(generate::Arguments),
    /// Plan for all problems of a suite, verify every plan, and report
    Bench(bench::Arguments),
    /// Print the JSON Schema of a format, or the names of all formats
    Schema(SchemaArguments),
}

#[derive(Debug, Args)]
pub struct CheckArguments {
    /// A structure/1 or configuration/1 file; `-` reads standard input
    pub file: PathBuf,
    /// Print a check/1 document (and errors as an errors/1 document)
    #[arg(long)]
    pub json: bool,
    /// Write a certificate/1 document that proves the verdict to anyone: see `plan verify`
    #[arg(long, value_name = "FILE")]
    pub certificate: Option<PathBuf>,
    /// Say what was left out of the optimisation and why, and what remained
    #[arg(long)]
    pub explain: bool,
    /// Of all states at the same utilisation show the one with the least sum of forces, and
    /// which connections are at their limit
    #[arg(long)]
    pub distribution: bool,
    /// Say in which order connections would give way: what the most loaded need at least,
    /// then the most loaded of the others, and so on
    #[arg(long)]
    pub order: bool,
    /// How many of the most loaded connections, and levels of the order, to show
    #[arg(long, value_name = "N", default_value_t = 10)]
    pub top: usize,
}

const RANGE_EXIT_CODES: &str = "Exit codes: 0 both ends known; 2 usage; 10 proved that no force along the line is \
enough; 11 not decided, or an end known only roughly; 30 bad input; 101 a bug";

#[derive(Debug, Args)]
pub struct LoadRangeArguments {
    /// A structure/1 or configuration/1 file; `-` reads standard input
    pub file: PathBuf,
    /// The module, or the body of a structure, that the force acts on
    #[arg(long, value_name = "ID", visible_alias = "body")]
    pub module: String,
    /// The force's direction in the world frame; its length does not matter
    #[arg(long, value_name = "X,Y,Z", value_parser = direction, allow_hyphen_values = true)]
    pub direction: [f64; 3],
    /// The force's point of action in m: in the module's frame for a configuration, in the world frame for a
    /// structure [default: the centre of mass]
    #[arg(long, value_name = "X,Y,Z", value_parser = triple, allow_hyphen_values = true)]
    pub at: Option<[f64; 3]>,
    /// Margin that is to be left at the ends of the range
    #[arg(long, value_name = "M", default_value_t = 0.0, value_parser = margin_to_leave)]
    pub margin: f64,
    /// Print a load-range/1 document (and errors as an errors/1 document)
    #[arg(long)]
    pub json: bool,
}

const MOTION_EXIT_CODES: &str = "Exit codes: 0 the robot stands in some position; 2 usage; 10 it stands in none; \
11 not decided; 30 bad input; 101 a bug";

#[derive(Debug, Args)]
#[command(group(ArgGroup::new("what").required(true).args(["connection", "joint"])))]
pub struct MotionRangeArguments {
    /// A configuration/1 file of modules outside lattices; `-` reads standard input
    pub file: PathBuf,
    /// The connection of a strut and a node: two modules, or ports where they have several connections. The
    /// first one's side moves, unless it is fixed
    #[arg(long, value_name = "A,B")]
    pub connection: Option<String>,
    /// The joint: a module, a dot and its name. The child's side moves, unless it is fixed
    #[arg(long, value_name = "MODULE.JOINT")]
    pub joint: Option<String>,
    /// Distance of positions in degrees
    #[arg(long, value_name = "DEGREES", default_value_t = 15.0, value_parser = map_step)]
    pub step: f64,
    /// Write every position with its verdict and margin as CSV; `-` writes to standard output
    #[arg(long, value_name = "FILE")]
    pub csv: Option<PathBuf>,
    /// Write a picture in polar coordinates, coloured by margin; `-` writes to standard output
    #[arg(long, value_name = "FILE")]
    pub svg: Option<PathBuf>,
}

fn map_step(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if (0.5..=90.0).contains(&value) => Ok(value),
        Ok(_) => Err("a step is from 0.5 to 90 degrees".to_string()),
        Err(error) => Err(error.to_string()),
    }
}

fn triple(text: &str) -> Result<[f64; 3], String> {
    let numbers: Vec<f64> = text
        .split(',')
        .map(|part| part.trim().parse::<f64>().map_err(|error| format!("`{part}`: {error}")))
        .collect::<Result<_, _>>()?;
    match <[f64; 3]>::try_from(numbers) {
        Ok(numbers) if numbers.iter().all(|x| x.is_finite()) => Ok(numbers),
        Ok(_) => Err("every number must be finite".to_string()),
        Err(numbers) => Err(format!("three numbers with commas between are needed, not {}", numbers.len())),
    }
}

fn direction(text: &str) -> Result<[f64; 3], String> {
    let numbers = triple(text)?;
    let length = numbers.iter().map(|x| x * x).sum::<f64>().sqrt();
    if length.is_normal() { Ok(numbers) } else { Err("a direction must have a length".to_string()) }
}

fn margin_to_leave(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() && value < 1.0 => Ok(value),
        Ok(_) => Err("less than 1 can be left, which only an unloaded robot has".to_string()),
        Err(error) => Err(error.to_string()),
    }
}

#[derive(Debug, Args)]
pub struct VerifyArguments {
    /// A plan/1 or certificate/1 file; `-` reads standard input
    pub file: PathBuf,
}

#[derive(Debug, Args)]
pub struct ParallelArguments {
    /// A plan/1 file; `-` reads standard input
    pub file: PathBuf,
    /// How many moves may be under way at once
    #[arg(long, value_name = "N", default_value_t = 2, value_parser = clap::value_parser!(u32).range(1..=8))]
    pub most: u32,
    /// Margin that every state must have [default: what the plan was made for]
    #[arg(long, value_name = "X", value_parser = margin)]
    pub min_margin: Option<f64>,
    /// How long a move takes, in any unit
    #[arg(long, value_name = "T", default_value_t = 1.0, value_parser = duration)]
    pub move_time: f64,
    /// How long attaching or detaching takes, in the same unit
    #[arg(long, value_name = "T", default_value_t = 0.1, value_parser = duration)]
    pub latch_time: f64,
    /// Seconds after which what was not looked at keeps the plan's order
    #[arg(long, value_name = "S", value_parser = seconds)]
    pub time_limit: Option<Duration>,
    /// Print a partial-order/1 document (and errors as an errors/1 document)
    #[arg(long)]
    pub json: bool,
    /// Write a chart of when each action runs
    #[arg(long, value_name = "FILE")]
    pub svg: Option<PathBuf>,
    /// Write the graph for Graphviz
    #[arg(long, value_name = "FILE")]
    pub dot: Option<PathBuf>,
}

fn duration(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() && value >= 0.0 => Ok(value),
        Ok(_) => Err("a duration is finite and not negative".to_string()),
        Err(error) => Err(error.to_string()),
    }
}

#[derive(Debug, Args)]
pub struct ConvertArguments {
    /// A configuration/1 file, or a JSON world, text or voxels of the RoFI platform; `-` reads standard input
    pub input: PathBuf,
    /// File to write [default: standard output]
    #[arg(required_unless_present = "to")]
    pub output: Option<PathBuf>,
    /// Format to write [default: rofi-text for .rofi and .in, otherwise configuration]
    #[arg(long, value_enum, value_name = "FORMAT")]
    pub to: Option<RobotFormat>,
    /// Leave out what surrounds the robot: gravity, ground, obstacles, loads, and that modules are fixed
    #[arg(long)]
    pub robot_only: bool,
}

/// `--to`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum RobotFormat {
    /// This program's own format, configuration/1
    Configuration,
    /// A JSON world of the RoFI platform
    RofiJson,
    /// Text of the RoFI platform
    RofiText,
    /// Voxels of the RoFI platform
    RofiVoxel,
}

#[derive(Debug, Args)]
pub struct SchemaArguments {
    /// Name of the format; without it, all names are listed
    pub name: Option<String>,
}
