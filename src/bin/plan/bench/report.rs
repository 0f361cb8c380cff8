//! The report on a suite: tables in Markdown, and figures beside it.

use std::fmt::Write;
use std::io;
use std::path::Path;

use steadfast::statics::Rung;
use steadfast::suite::Suite;
use steadfast::suite::summary::{self, Against, Curve, Entry, Naive, Row, Way};

use super::figures::{Axis, Figure, Mark, Scale, Series};
use crate::files;

/// Errors below this are drawn here: margins are proved to about this width.
const SMALLEST_ERROR: f64 = 1e-6;

/// Times below this are drawn here, in s.
const SHORTEST: f64 = 1e-4;

/// What is reported on.
pub struct Report<'a> {
    /// The suite.
    pub suite: &'a Suite,
    /// How many jobs it has.
    pub jobs: usize,
    /// On what it was run.
    pub machines: &'a [String],
    /// The jobs that are finished.
    pub entries: &'a [Entry<'a>],
}

impl Report<'_> {
    /// How many plans replays refute.
    pub fn refuted(&self) -> usize {
        self.entries.iter().filter(|entry| entry.record.is_refuted()).count()
    }

    /// What was found in all, in one line.
    pub fn headline(&self) -> String {
        let count = |is: &dyn Fn(&Entry<'_>) -> bool| self.entries.iter().filter(|entry| is(entry)).count();
        let naive = summary::naive(self.entries);
        let (plans, breaking) = naive.iter().fold((0, 0), |sum, n| (sum.0 + n.plans, sum.1 + n.breaking));
        format!(
            "{} of {} jobs finished: {} decided, {} with a verified plan; of {plans} plans that ignore stability \
             {breaking} break\n",
            self.entries.len(),
            self.jobs,
            count(&|entry| entry.record.is_decided()),
            count(&|entry| entry.record.is_solved()),
        )
    }

    /// Writes `report.md` and its figures.
    ///
    /// # Errors
    /// A file cannot be written.
    pub fn write(&self, folder: &Path) -> io::Result<()> {
        files::save(&folder.join("report.md"), &self.text())?;
        for (name, figure) in self.figures() {
            figure.draw(&folder.join(name)).map_err(|error| io::Error::other(error.to_string()))?;
        }
        Ok(())
    }

    fn text(&self) -> String {
        let mut text = format!("# Suite {}\n\n{}", self.suite.name, self.headline());
        if self.entries.len() < self.jobs {
            let left = self.jobs - self.entries.len();
            let _ = writeln!(
                text,
                "\n**Not finished: {left} jobs have not been run.** Everything below is about the others."
            );
        }
        for machine in self.machines {
            let _ = writeln!(text, "\nRun on: {machine}.");
        }
        text.push_str(METHOD);
        let rows = summary::rows(self.entries);
        for (way, rows) in &rows {
            let _ = write!(text, "\n## {}\n\n{RESULTS}", title(way));
            rows.iter().for_each(|row| text.push_str(&result(row)));
            text.push_str(&endings(rows));
        }
        naive_plans(&mut text, &summary::naive(self.entries));
        text.push_str(ORACLE);
        for (way, rows) in &rows {
            rows.iter().for_each(|row| text.push_str(&oracle(way, row)));
        }
        text.push_str("\n## Figures\n");
        for (name, figure) in self.figures() {
            let _ = write!(text, "\n![{}]({name})\n", figure.title);
        }
        self.add_refuted(&mut text);
        text
    }

    fn add_refuted(&self, text: &mut String) {
        let refuted: Vec<_> = self.entries.iter().filter(|entry| entry.record.is_refuted()).collect();
        if refuted.is_empty() {
            return;
        }
        text.push_str("\n## Refuted plans\n\nTheir replay finds fault with them: a bug. None of them counts.\n\n");
        for entry in refuted {
            let flaw = entry.record.check.as_ref().and_then(|check| check.flaw.as_ref());
            let what = flaw.map_or("", |flaw| flaw.what.as_str());
            let _ = writeln!(text, "- `{}`: {what}", entry.record.job);
        }
    }

    fn figures(&self) -> [(&'static str, Figure); 5] {
        let [first, answered] = summary::solved_over_time(self.entries);
        let seconds = Axis { name: "time in s", scale: Scale::Logarithmic };
        let share = Axis { name: "share of the problems", scale: Scale::Linear };
        let over_time = |title, curves: &[Curve]| Figure {
            title,
            x: seconds,
            y: share,
            series: curves.iter().map(|curve| steps(curve, 0.0, SHORTEST)).collect(),
        };
        let short = |curve: &Curve| {
            let mut curve = curve.clone();
            curve.steps.iter_mut().for_each(|step| step.share = step.share.max(SMALLEST_ERROR));
            steps(&curve, f64::NAN, SHORTEST)
        };
        let errors = |title, against| Figure {
            title,
            x: seconds,
            y: Axis { name: "margin that is missing", scale: Scale::Logarithmic },
            series: summary::error_over_time(self.entries, against).iter().map(short).collect(),
        };
        let growth = summary::growth(self.entries).into_iter().map(|(way, dots)| Series {
            name: title(&way),
            line: Vec::new(),
            marks: dots
                .iter()
                .map(|dot| Mark { x: dot.modules as f64, y: dot.seconds.max(SHORTEST), hollow: !dot.decided })
                .collect(),
        });
        [
            ("first_plan.svg", over_time("A plan found, and verified later", &first)),
            ("answered.svg", over_time("Answered: best plan proved, or none exists", &answered)),
            ("error.svg", errors("How far margins fall short of the best known (median)", Against::BestKnown)),
            ("gap.svg", errors("How far margins fall short of what is proved of all plans (median)", Against::Proved)),
            (
                "growth.svg",
                Figure {
                    title: "Time to the answer; hollow where it was cut off",
                    x: Axis { name: "modules", scale: Scale::Logarithmic },
                    y: seconds,
                    series: growth.collect(),
                },
            ),
        ]
    }
}

/// A curve of steps from `from` (NaN: from its first step) to the longest time.
fn steps(curve: &Curve, from: f64, shortest: f64) -> Series {
    let size = curve.modules.map_or_else(String::new, |modules| format!(", {modules} modules"));
    let mut line = Vec::new();
    let mut height = from;
    if !from.is_nan() {
        line.push((shortest, from));
    }
    for step in &curve.steps {
        let seconds = step.seconds.max(shortest);
        if !height.is_nan() {
            line.push((seconds, height));
        }
        line.push((seconds, step.share));
        height = step.share;
    }
    if !height.is_nan() {
        line.push((curve.until.max(shortest), height));
    }
    Series { name: format!("{}{size}", title(&curve.way)), line, marks: Vec::new() }
}

fn title(way: &Way) -> String {
    format!("{}, {}, {}", way.family.name(), way.planner.name(), way.objective)
}

const METHOD: &str = "
Every plan was written to a file and replayed from it by code that shares no decision with the search; only plans that a \
replay confirms count. Problems are drawn from their seeds: `docs/random_problems.md` tells how.

Jobs that were cut off, at a limit or by a crash, are censored: shares over time are product-limit (Kaplan-Meier) \
estimates, and a median time is given only where half of the jobs got there. `-` stands for a median that is not known but \
to be longer than the limit, or for nothing to take a median of. Medians of moves and margins are over problems with a \
verified plan, so that different planners' are about different problems where they solve different ones.
";

const RESULTS: &str = "\
| modules | problems | plan verified | best one proved, or none exists | none exists | first plan s | answer s | moves | margin |
| ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |
";

fn result(row: &Row) -> String {
    format!(
        "| {} | {} | {} | {} | {} | {} | {} | {} | {} |\n",
        row.modules,
        row.jobs,
        row.solved,
        row.decided,
        row.impossible,
        time(row.first_plan_seconds),
        time(row.decided_seconds),
        row.moves.map_or("-".to_string(), |moves| format!("{moves:.0}")),
        margin(row.margin),
    )
}

fn time(seconds: Option<f64>) -> String {
    seconds.map_or("-".to_string(), |seconds| format!("{seconds:.3}"))
}

fn margin(margin: Option<f64>) -> String {
    match margin {
        None => "-".to_string(),
        Some(f64::NEG_INFINITY) => "falls".to_string(),
        Some(margin) => format!("{margin:.4}"),
    }
}

/// How the jobs ended that decided nothing.
fn endings(rows: &[Row]) -> String {
    let mut text = String::new();
    for row in rows.iter().filter(|row| !row.open.is_empty()) {
        let open: Vec<String> = row.open.iter().map(|(word, count)| format!("{count} {word}")).collect();
        let _ = write!(text, "\n{} modules, undecided: {}.\n", row.modules, open.join(", "));
    }
    text
}

fn naive_plans(text: &mut String, naive: &[Naive]) {
    if naive.is_empty() {
        return;
    }
    text.push_str(
        "\n## Plans that ignore stability\n\nFewest moves by geometry and connectedness alone, as other planners have \
         them, then carried out. Shares with 95 % intervals (Wilson).\n\n\
         | family | modules | plans | break | share | of these on the way of a move | moves | margin |\n\
         | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n",
    );
    for n in naive {
        let share = 100.0 * n.breaking as f64 / n.plans as f64;
        let [low, high] = n.interval.map(|end| 100.0 * end);
        let _ = writeln!(
            text,
            "| {} | {} | {} | {} | {share:.0} % ({low:.0} to {high:.0}) | {} | {} | {} |",
            n.family.name(),
            n.modules,
            n.plans,
            n.breaking,
            n.on_the_way,
            n.moves.map_or("-".to_string(), |moves| format!("{moves:.0}")),
            margin(n.margin),
        );
    }
}

const ORACLE: &str = "
## What the searches took

Medians, but for the share decided by bounds: transitions whose margin was never asked for, of all that were generated.

| family, planner, objective | modules | expanded | generated | decided by bounds | oracle solves | decided how | peak MB |
| --- | ---: | ---: | ---: | ---: | ---: | --- | ---: |
";

fn oracle(way: &Way, row: &Row) -> String {
    let rung = |rung| match rung {
        Rung::ClosedForm => "closed form",
        Rung::CarriedOver => "carried over",
        Rung::StoppedEarly => "stopped early",
        Rung::Solved => "solved",
        Rung::SolvedGenerally => "solved generally",
    };
    let answered = Rung::ALL.into_iter().filter(|&which| row.decided_by.of(which) > 0);
    let rungs: Vec<String> = answered.map(|which| format!("{} {}", rung(which), row.decided_by.of(which))).collect();
    format!(
        "| {} | {} | {:.0} | {:.0} | {} | {:.0} | {} | {} |\n",
        title(way),
        row.modules,
        row.expanded,
        row.generated,
        row.by_bounds.map_or("-".to_string(), |share| format!("{:.1} %", 100.0 * share)),
        row.oracle_solves,
        rungs.join(", "),
        row.peak_bytes.map_or("-".to_string(), |bytes| (bytes >> 20).to_string()),
    )
}
