//! `plan generate`

use std::fmt::Write;
use std::io;
use std::path::{Path, PathBuf};

use clap::{ArgGroup, Args, ValueEnum};
use steadfast::generate::{Failure, Family, Generated, GoalKind, Pair, Request, Setting, generate};
use steadfast::io::{write_configuration, write_goal, write_linkage, write_linkage_goal};

use crate::exit::Exit;
use crate::{files, output};

/// What `plan generate` can be asked.
#[derive(Debug, Args)]
#[command(group(ArgGroup::new("where").required(true).multiple(true).args(["out", "out_start"])))]
pub struct Arguments {
    /// What kind of robot
    #[arg(long, value_enum)]
    family: FamilyArgument,
    /// How many modules; of freesn half are nodes
    #[arg(long, value_name = "N")]
    modules: usize,
    /// Where the random numbers begin: the same seed draws the same problem
    #[arg(long, value_name = "S")]
    seed: u64,
    /// What surrounds the robot [default: flat, for rofi space]
    #[arg(long, value_enum)]
    terrain: Option<TerrainArgument>,
    /// Whether the first module is held immovably [default: only that of freesn]
    #[arg(long, value_name = "YES")]
    held: Option<bool>,
    /// Where the goal comes from [default: grown for cubes, walk for others]
    #[arg(long, value_enum)]
    goal: Option<GoalArgument>,
    /// How far the goal is: of a grown one how many modules change places, of a walk how many moves it takes
    #[arg(long, value_name = "D")]
    difficulty: Option<usize>,
    /// Margin that start and goal have at least, and every state of a walk
    #[arg(long, value_name = "X", default_value_t = 0.1)]
    margin: f64,
    /// Folder to write start.json and goal.json to; it is made where it is missing
    #[arg(long, value_name = "DIR", conflicts_with_all = ["out_start", "out_goal"])]
    out: Option<PathBuf>,
    /// File to write the start to
    #[arg(long, value_name = "FILE", requires = "out_goal")]
    out_start: Option<PathBuf>,
    /// File to write the goal to
    #[arg(long, value_name = "FILE", requires = "out_start")]
    out_goal: Option<PathBuf>,
}

/// `--family`.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum FamilyArgument {
    /// Magnetic cubes in a lattice
    Cubes,
    /// Struts and nodes
    Freesn,
    /// Universal modules of the RoFI platform
    Rofi,
}

/// `--terrain`.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum TerrainArgument {
    /// Nothing, not even gravity; the goal is met anywhere
    Space,
    /// Gravity and no ground; the first module is held
    Mounted,
    /// A floor
    Flat,
    /// An inclined floor
    Slope,
    /// A floor with blocks
    Steps,
    /// A floor with pits
    Rough,
}

/// `--goal`.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum GoalArgument {
    /// Grown like the start: nobody knows whether there is a plan
    Grown,
    /// The end of a random walk from the start: there is a plan
    Walk,
}

impl Arguments {
    fn request(&self) -> Request {
        let family = match self.family {
            FamilyArgument::Cubes => Family::Cubes,
            FamilyArgument::Freesn => Family::Freesn,
            FamilyArgument::Rofi => Family::Rofi,
        };
        let usual = Request::new(family, self.modules, self.seed);
        Request {
            setting: self.terrain.map_or(usual.setting, |terrain| match terrain {
                TerrainArgument::Space => Setting::Space,
                TerrainArgument::Mounted => Setting::Mounted,
                TerrainArgument::Flat => Setting::Flat,
                TerrainArgument::Slope => Setting::Slope,
                TerrainArgument::Steps => Setting::Steps,
                TerrainArgument::Rough => Setting::Rough,
            }),
            held: self.held.unwrap_or(usual.held),
            goal: self.goal.map_or(usual.goal, |goal| match goal {
                GoalArgument::Grown => GoalKind::Grown,
                GoalArgument::Walk => GoalKind::Walk,
            }),
            difficulty: self.difficulty,
            margin: self.margin,
            ..usual
        }
    }
}

/// Draws a problem and writes its two files.
///
/// # Errors
/// The output cannot be written.
pub fn run(arguments: &Arguments) -> io::Result<Exit> {
    let request = arguments.request();
    let generated = match generate(&request) {
        Ok(generated) => generated,
        Err(failure) => {
            output::message(&format!("error: {failure}"))?;
            let is_luck = matches!(failure, Failure::NoneFound(_));
            return Ok(if is_luck { Exit::Undecided } else { Exit::BadInput });
        }
    };
    let texts = match &generated.pair {
        Pair::Lattice { start, goal } => write_configuration(start).and_then(|start| Ok([start, write_goal(goal)?])),
        Pair::Linkage { start, goal } => write_linkage(start).and_then(|start| Ok([start, write_linkage_goal(goal)?])),
    };
    let texts = match texts {
        Ok(texts) => texts,
        Err(trouble) => {
            output::message(&format!("bug: the problem cannot be written: {trouble}"))?;
            return Ok(Exit::Bug);
        }
    };
    let paths = arguments.paths();
    if let Some(folder) = &arguments.out
        && let Err(trouble) = std::fs::create_dir_all(folder)
    {
        return unwritable(folder, &trouble);
    }
    for (path, text) in paths.iter().zip(&texts) {
        if let Err(trouble) = files::save(path, text) {
            return unwritable(path, &trouble);
        }
    }
    output::result(&summary(&request, &generated, &paths))?;
    Ok(Exit::Yes)
}

impl Arguments {
    /// The files of start and goal.
    fn paths(&self) -> [PathBuf; 2] {
        match (&self.out, &self.out_start, &self.out_goal) {
            (None, Some(start), Some(goal)) => [start.clone(), goal.clone()],
            (folder, ..) => {
                let folder = folder.clone().unwrap_or_default();
                [folder.join("start.json"), folder.join("goal.json")]
            }
        }
    }
}

fn unwritable(path: &Path, trouble: &io::Error) -> io::Result<Exit> {
    output::message(&format!("error: {}: {trouble}", path.display()))?;
    Ok(Exit::BadInput)
}

fn summary(request: &Request, generated: &Generated, paths: &[PathBuf; 2]) -> String {
    let mut text = format!(
        "{} modules of the family {}, terrain {}, seed {}\n",
        request.modules,
        request.family.name(),
        request.setting.name(),
        request.seed
    );
    let _ = match (request.goal, generated.difficulty) {
        (GoalKind::Walk, Some(moves)) => {
            writeln!(text, "goal: {moves} admissible random moves from the start, so that there is a plan")
        }
        (GoalKind::Grown, Some(moved)) => {
            writeln!(text, "goal: grown, with {moved} modules elsewhere; whether there is a plan is not known")
        }
        (_, None) => writeln!(text, "goal: grown; whether there is a plan is not known"),
    };
    let _ = writeln!(text, "margin of start and goal: proved to be {} or more", request.margin);
    let tally = generated.tally;
    let _ = writeln!(
        text,
        "{} modules placed, {} of them blocked and {} taken back as unstable; {} shapes given up",
        tally.drawn, tally.blocked, tally.unstable, tally.restarts
    );
    let [start, goal] = paths;
    let _ = writeln!(text, "written: {} and {}", start.display(), goal.display());
    text
}
