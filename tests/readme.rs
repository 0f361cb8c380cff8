//! The files that the README shows do what it says of them.

use steadfast::io::{Checkable, NamedStructure, SourceFile, no_references, read_checkable, read_problem};
use steadfast::reconfigure::linkage::replay::replay;
use steadfast::reconfigure::linkage::solve;
use steadfast::reconfigure::{Objective, Options, Outcome};
use steadfast::statics::{Question, Verdict, assess};

/// The JSON files under a heading.
fn files(heading: &str) -> Vec<SourceFile> {
    let text = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/README.md")).unwrap();
    let (_, section) = text.split_once(&format!("## {heading}\n")).expect("the heading is there");
    let section = section.split("\n## ").next().unwrap();
    let blocks = section.split("```json\n").skip(1).filter_map(|block| block.split("```").next());
    blocks.map(|block| SourceFile::new("README.md", block)).collect()
}

/// The motions shown are those of a problem that the planner's tests solve.
#[test]
fn own_motions_are_those_of_a_problem() {
    let text = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/README.md")).unwrap();
    let (_, shown) = text.split_once("```jsonc\n").expect("motions are shown");
    let shown = shown.split("```").next().unwrap();
    let problem = std::fs::read_to_string(problems::root().join("cubes/dash/start.json")).unwrap();
    assert!(problem.contains(shown), "{shown}");
}

#[test]
fn a_problem_reads() {
    let files = files("Writing a problem");
    assert_eq!(files.len(), 1);
    assert!(matches!(read_checkable(&files[0], &no_references), Ok(Checkable::Configuration(_))));
}

#[test]
fn own_modules_read_and_are_planned_for() {
    let files = files("Bringing your own modules");
    let [start, goal, strut] = files.as_slice() else { panic!("three files are shown") };
    let problem = read_problem(start, goal, &no_references).unwrap().into_linkage().unwrap();
    let options = Options { objective: Objective::Moves, ..Options::default() };
    let report = solve(&problem.start, &problem.goal, &options, &mut |_| {}).unwrap();
    assert_eq!(report.outcome, Outcome::Solved);
    let plan = report.plan.unwrap();
    assert_eq!(plan.moves, 3);
    assert!(replay(&problem.start, &problem.goal, &plan, 0.0).unwrap().is_verified());
    match read_checkable(strut, &no_references) {
        Ok(Checkable::Linkage(linkage)) => {
            let structure = NamedStructure::of_linkage(&linkage).structure;
            assert_eq!(assess(&structure, Question::VALUE).unwrap().verdict, Verdict::Stable);
        }
        other => panic!("{other:?}"),
    }
}
