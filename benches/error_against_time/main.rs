//! Error against run time, and growth of time and memory, of the oracle and of
//! what one would use in its place. Writes `benches/record/` and the tables in
//! `docs/error_against_time.md`.
//!
//!     cargo bench --bench error_against_time             # all of it, within ten minutes
//!     cargo bench --bench error_against_time -- study    # or growth: one of the two parts
//!     cargo bench --bench error_against_time -- --quick  # a small one, into target/, under a minute
//!
//! Under `cargo test --benches` it only shows that it works.

#[path = "../support/cone_program.rs"]
mod cone_program;
mod double_double;
mod figures;
mod growth;
#[path = "../support/machine.rs"]
mod machine;
mod methods;
#[path = "../../tests/support/paper.rs"]
mod paper;
mod plot;
mod pyramid;
#[path = "../../tests/support/random.rs"]
mod random;
mod record;
mod reference;
mod scenes;
#[path = "../../tests/support/scenes.rs"]
mod scenes_support;
#[path = "../support/standard.rs"]
mod standard;
mod study;
mod tables;
#[path = "../support/timing.rs"]
mod timing;

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::time::Duration;

use methods::Method;
use study::Effort;

type Failure = Box<dyn std::error::Error>;

fn main() -> Result<(), Failure> {
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global()?;
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if arguments.first().is_some_and(|first| first == growth::ONE_POINT) {
        return say(&growth::one_point(&arguments[1..]));
    }
    let asked = |part: &str| arguments.iter().any(|argument| argument == part);
    let extent = if !timing::measuring() {
        Extent::Smoke
    } else if asked("--quick") {
        Extent::Quick
    } else {
        Extent::Full
    };
    let run = Run { extent, machine: machine::describe() };
    std::fs::create_dir_all(run.folder())?;
    if asked("study") || !asked("growth") {
        run.study()?;
    }
    if asked("growth") || !asked("study") {
        run.growth()?;
    }
    say(&format!("written to {}", run.folder().display()))
}

/// How much is measured.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Extent {
    /// Each method once on few scenes.
    Smoke,
    /// A scene per family.
    Quick,
    /// Everything; the only one that is kept.
    Full,
}

struct Run {
    extent: Extent,
    machine: String,
}

impl Run {
    fn folder(&self) -> PathBuf {
        match self.extent {
            Extent::Full => Path::new(env!("CARGO_MANIFEST_DIR")).join("benches/record"),
            Extent::Quick | Extent::Smoke => Path::new(env!("CARGO_TARGET_TMPDIR")).join("error_against_time"),
        }
    }

    fn study(&self) -> Result<(), Failure> {
        let scenes = scenes::scenes(self.extent != Extent::Full);
        let (budget, most) = match self.extent {
            Extent::Smoke => (Duration::ZERO, 0),
            Extent::Quick => (Duration::from_millis(60), 5),
            Extent::Full => (Duration::from_millis(250), 25),
        };
        let mut rows = Vec::new();
        for scene in &scenes {
            say(&format!("{}, {} bodies", scene.name, scene.structure.bodies.len()))?;
            rows.extend(study::study(scene, &Method::all(), Effort { budget, most }));
        }
        std::fs::write(self.folder().join("error_against_time.csv"), record::study_csv(&rows))?;
        for family in scenes::FAMILIES {
            let name = format!("error_{}.svg", family.replace(' ', "_"));
            figures::error_against_time(family, &rows).draw(&self.folder().join(name))?;
        }
        let header = format!("{}; medians of processor time, the methods in turns.", self.machine);
        let tables = [tables::exact(&rows), tables::reductions(&rows), tables::trust(&rows)];
        self.tell("study", &format!("{header}\n\n{}", tables.join("\n")))
    }

    fn growth(&self) -> Result<(), Failure> {
        let (limit, most) = match self.extent {
            Extent::Smoke => (Duration::from_secs(2), 30),
            Extent::Quick => (Duration::from_secs(2), 1000),
            Extent::Full => (Duration::from_secs(10), usize::MAX),
        };
        let points = growth::growth(limit, most);
        std::fs::write(self.folder().join("growth.csv"), record::growth_csv(&points))?;
        let draw = |name: &str, figure: plot::Figure| figure.draw(&self.folder().join(name));
        draw("growth_time.svg", figures::growth("Growth of time", "time, ms", |p| p.milliseconds, &points))?;
        draw("growth_memory.svg", figures::growth("Growth of memory", "memory added, MiB", |p| p.added, &points))?;
        let header = format!("{}; processor time, a process a point, at most {} s.", self.machine, limit.as_secs());
        self.tell("growth", &format!("{header}\n\n{}\n{}", tables::growth(&points), tables::long(&points)))
    }

    /// Prints a part, and puts it into the page if this run is kept.
    fn tell(&self, part: &str, text: &str) -> Result<(), Failure> {
        say(text)?;
        if self.extent == Extent::Full {
            let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/error_against_time.md");
            record::splice(&page, part, text)?;
        }
        Ok(())
    }
}

fn say(text: &str) -> Result<(), Failure> {
    writeln!(std::io::stdout().lock(), "{text}")?;
    Ok(())
}
