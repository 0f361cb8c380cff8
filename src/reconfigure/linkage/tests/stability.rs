//! Margins of linkages' states and moves.

use proptest::prelude::*;
use proptest::sample::Index;

use crate::reconfigure::linkage::assembly::assemble;
use crate::reconfigure::options::Options;
use crate::reconfigure::plan::{Objective, Outcome};
use crate::robot::linkage::Linkage;
use crate::statics::{Question, assess};

use super::{chain, goal, plan, solved, standing, string};

fn margin(linkage: &Linkage) -> crate::statics::Bracket {
    assess(&assemble(linkage).structure, Question::VALUE).expect("sound").margin()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    #[test]
    fn attaching_never_lowers_the_margin(
        bends in prop::collection::vec((-1..=1, -1..=1, 0..4), 4),
        rolls in prop::collection::vec(0..4, 3),
        left_out in any::<Index>(),
        struts in prop::bool::ANY,
    ) {
        let joints: Vec<[i32; 3]> = bends.iter().map(|&(a, b, c)| [a, b, c]).collect();
        let spots: Vec<[i32; 3]> = bends.iter().map(|&(a, b, c)| [90 * c, 90 + 90 * a, 90 * b]).collect();
        let robot = if struts { string(&spots) } else { chain(&joints, &rolls) };
        let all = standing(robot, Some(-0.06));
        let mut fewer = all.clone();
        fewer.connections.remove(left_out.index(all.connections.len()));
        let (more, less) = (margin(&all), margin(&fewer));
        prop_assert!(less.lower <= more.upper, "{:?} {:?}", more, less);
    }
}

#[test]
fn a_short_way_is_not_taken_where_the_motors_are_too_weak() {
    // Two modules straight out from the wall, or folded: the joints lift what is beyond them.
    let start = standing(chain(&[[0, 0, 0], [0, 0, 0]], &[0]), None);
    let end = standing(chain(&[[0, 1, 0], [0, 0, 0]], &[0]), None);
    let options = Options { objective: Objective::Margin, ..Options::default() };
    let report = plan(&start, &goal(end.clone()), &options);
    let best = solved(&report).margin.expect("with margins");
    assert!(report.proof.optimal && report.proof.margin_at_most >= best.lower);
    // No plan is better, so none is found where more is asked for.
    let more = Options { objective: Objective::Moves, min_margin: Some(best.upper + 1e-3), ..Options::default() };
    assert!(matches!(plan(&start, &goal(end), &more).outcome, Outcome::Impossible(_)));
}

#[test]
fn a_strut_rolls_over_a_node_that_is_held() {
    let start = standing(string(&[[0, 90, 0]]), None);
    let end = standing(string(&[[90, 90, 0]]), None);
    let options = Options { objective: Objective::Margin, ..Options::default() };
    let report = plan(&start, &goal(end), &options);
    assert_eq!(solved(&report).moves, 1);
}
