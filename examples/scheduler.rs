//! A program that runs a robot: it plans, carries out half of the plan, hears that a connector has become weak, and
//! plans on from where the robot is, with a deadline and the planner's events through a channel.
//!
//! ```text
//! cargo run --example scheduler
//! ```

use std::error::Error;
use std::io::{Write, stdout};
use std::path::Path;
use std::time::{Duration, Instant};

use steadfast::io::{SourceFile, no_references, read_problem};
use steadfast::reconfigure::partial_order::OrderOptions;
use steadfast::reconfigure::{News, Objective, Options, Outcome};
use steadfast::schedule::{Job, Problem, Robot, best, plan_batch, until, weaken_connector, without};

fn main() -> Result<(), Box<dyn Error>> {
    let mut out = stdout().lock();
    let directory = Path::new(env!("CARGO_MANIFEST_DIR")).join("problems/cubes/arm_of_eight");
    let file = |name: &str| Ok::<_, std::io::Error>(SourceFile::new(name, std::fs::read(directory.join(name))?));
    let read = read_problem(&file("start.json")?, &file("goal.json")?, &no_references)?;
    let read = read.into_lattice().ok_or("cubes sit in a lattice")?;
    let mut problem = Problem::lattice(read.start, read.goal);
    let options = Options { objective: Objective::Moves, ..Options::default() };

    // A first plan, and which of its actions may run at the same time.
    let report = problem.plan(&options, &mut |_| {})?;
    let plan = report.plan.ok_or("no plan")?;
    let order = problem.partial_order(&plan, &OrderOptions::default())?;
    let times = order.timetable(|action| if plan.actions[action].action.is_move() { 10.0 } else { 1.0 });
    writeln!(out, "{} moves, {:.0} s instead of {:.0} s", plan.moves, times.makespan, times.one_by_one)?;

    // The robot carries out half of it; then a test finds that the connectors hold only 90 % of their rating.
    let done = plan.actions.iter().take(plan.actions.len() / 2).map(|planned| &planned.action);
    let now = problem.start.after(done)?;
    problem = problem.from_state(now);
    let connector = problem.start.catalogue().connectors[0].name.clone();
    weaken_connector(&mut problem, &connector, 0.9)?;

    // Plan on from the middle, on another thread, for a minute at most.
    let deadline = Instant::now() + Duration::from_secs(60);
    let job = Job::start(problem.clone(), until(deadline, options.clone()));
    let canceller = job.canceller(); // for whoever sees that the robot is needed elsewhere
    for event in job.events() {
        match event.news {
            News::Plan(better) => writeln!(out, "  a plan of {} moves", better.moves)?,
            News::Bound => writeln!(out, "  no plan has fewer than {} moves", event.known.moves_at_least)?,
            News::Progress => {}
        }
        if Instant::now() > deadline {
            canceller.cancel();
        }
    }
    match job.wait()? {
        answer if answer.plan.is_some() => {
            let plan = answer.plan.as_ref().ok_or("no plan")?;
            let check = problem.replay(plan, 0.0)?;
            writeln!(out, "{} moves to go, verified: {}", plan.moves, check.is_verified())?;
        }
        answer => match answer.outcome {
            Outcome::Impossible(reason) => writeln!(out, "impossible: {reason}")?,
            other => writeln!(out, "nothing found: {other:?}")?,
        },
    }

    // A module is gone: which of the goal's places is best left empty?
    let gone = problem.start.ids().last().map(ToString::to_string).ok_or("no modules")?;
    let left = without(&problem, &gone)?;
    let within = Options { time_limit: Some(Duration::from_secs(5)), ..options };
    let batch: Vec<_> = left.iter().map(|(_, problem)| (problem.clone(), within.clone())).collect();
    let reports = plan_batch(&batch, &Default::default()).into_iter().collect::<Result<Vec<_>, _>>()?;
    match best(&reports) {
        Some(index) => writeln!(out, "without {gone}: leave the place of {} empty", left[index].0)?,
        None => writeln!(out, "without {gone} no plan was found")?,
    }
    Ok(())
}
