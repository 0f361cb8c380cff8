//! The methods that are compared, each with the knob that trades time for accuracy.

use clarabel::solver::SolverStatus;
use steadfast::statics::{
    Assessment, Explanation, Memory, Question, Reductions, Remaining, Structure, assess, assess_near, assess_reduced,
    explain,
};

use crate::cone_program::{Solution, settings};
use crate::pyramid::{Side, linear};
use crate::{paper, standard};

/// A method with its knob set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Method {
    /// The paper's formulation in Clarabel at a tolerance.
    Paper(f64),
    /// The standard form in Clarabel at a tolerance.
    Standard(f64),
    /// The standard form over pyramids with so many sides, a linear program, in Clarabel at its
    /// default tolerance.
    Pyramid(Side, usize),
    /// The oracle, stopped at a gap.
    ToGap(f64),
    /// The same, with something left in that the scene does not need.
    Unreduced(LeftIn, f64),
    /// The oracle, asked only whether the utilisation is at most 1.
    Decide,
    /// The same question, first put to the fields of a neighbouring state.
    CarriedOver,
}

/// Which of the oracle's reductions is switched off. (Solving blocks at the same time is not
/// among them: everything here is done by one thread.)
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LeftIn {
    RigidLinks,
    Blocks,
    ClosedForm,
    Chains,
    Planar,
    Everything,
}

impl LeftIn {
    pub const ALL: [Self; 6] =
        [Self::RigidLinks, Self::Blocks, Self::ClosedForm, Self::Chains, Self::Planar, Self::Everything];

    const fn reductions(self) -> Reductions {
        let all = Reductions::ALL;
        match self {
            Self::RigidLinks => Reductions { rigid_links: false, ..all },
            Self::Blocks => Reductions { blocks: false, ..all },
            Self::ClosedForm => Reductions { closed_form: false, ..all },
            Self::Chains => Reductions { chains: false, ..all },
            Self::Planar => Reductions { planar: false, ..all },
            Self::Everything => Reductions::NONE,
        }
    }

    /// Whether there is anything of the kind in a structure.
    pub fn is_found_in(self, structure: &Structure) -> bool {
        let found: Explanation = explain(structure, Reductions::ALL).expect(SOUND);
        let chains = |block: &Remaining| block.chains > 0;
        match self {
            Self::RigidLinks => found.merged_bodies > 0,
            Self::Blocks => found.remaining.len() > 1,
            Self::ClosedForm => found.closed_form_connections + found.closed_form_contacts > 0,
            Self::Chains => found.remaining.iter().any(chains),
            Self::Planar => found.remaining.iter().any(Remaining::is_planar),
            Self::Everything => Self::ALL[..5].iter().any(|one| one.is_found_in(structure)),
        }
    }
}

/// What a method claims about an answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Claim {
    /// An interval that is proved to hold the utilisation.
    Proved,
    /// A number, called solved.
    Solved,
    /// A number, with a status other than solved; of carried-over fields an interval that a
    /// solve was needed for after all.
    Stopped,
    /// A number, called solved, on the wrong side of the reference for a method that bounds from the other.
    Misplaced,
    /// That no strength suffices.
    Infeasible,
    /// Nothing.
    Nothing,
}

/// An answer: one number or an interval, and what is claimed about it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Answer {
    pub claim: Claim,
    pub lower: f64,
    pub upper: f64,
}

/// Whether everything holds.
pub const DECIDE: Question = Question::Decide(1.0);

/// Why the oracle cannot refuse.
const SOUND: &str = "the scenes are sound";

/// Clarabel's default tolerance.
pub const DEFAULT: f64 = 1e-8;

impl Method {
    /// Every method with every setting.
    pub fn all() -> Vec<Self> {
        let tolerances = [1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12];
        let mut all: Vec<Self> = tolerances.map(Self::Paper).to_vec();
        all.extend(tolerances.map(Self::Standard));
        for side in [Side::Inner, Side::Outer] {
            all.extend([4, 8, 16, 32].map(|sides| Self::Pyramid(side, sides)));
        }
        all.extend([1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9].map(Self::ToGap));
        for left_in in LeftIn::ALL {
            let gaps: &[f64] = if left_in == LeftIn::Everything { &[1e-2, 1e-4, 1e-6, 1e-8] } else { &[1e-6] };
            all.extend(gaps.iter().map(|&gap| Self::Unreduced(left_in, gap)));
        }
        all.extend([Self::Decide, Self::CarriedOver]);
        all
    }

    /// The method without its knob.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Paper(_) => "paper",
            Self::Standard(_) => "standard",
            Self::Pyramid(Side::Inner, _) => "pyramid inner",
            Self::Pyramid(Side::Outer, _) => "pyramid outer",
            Self::ToGap(_) => "ours",
            Self::Unreduced(LeftIn::RigidLinks, _) => "ours, rigid links left in",
            Self::Unreduced(LeftIn::Blocks, _) => "ours, not cut into blocks",
            Self::Unreduced(LeftIn::ClosedForm, _) => "ours, no closed form",
            Self::Unreduced(LeftIn::Chains, _) => "ours, chains left in",
            Self::Unreduced(LeftIn::Planar, _) => "ours, planes in space",
            Self::Unreduced(LeftIn::Everything, _) => "ours, nothing left out",
            Self::Decide => "ours, verdict",
            Self::CarriedOver => "ours, carried over",
        }
    }

    /// Where its knob stands: a tolerance, a number of sides, a gap or a threshold.
    pub const fn parameter(self) -> f64 {
        match self {
            Self::Paper(tolerance) | Self::Standard(tolerance) => tolerance,
            Self::Pyramid(_, sides) => sides as f64,
            Self::ToGap(gap) | Self::Unreduced(_, gap) => gap,
            Self::Decide | Self::CarriedOver => 1.0,
        }
    }

    /// Answers from the structure alone: everything from there on is part of the time. Only what
    /// is carried over needs the memory of a neighbour with the same bodies.
    pub fn run(self, structure: &Structure, neighbour: Option<&Memory>) -> Answer {
        match self {
            Self::Paper(tolerance) => match paper::solve(structure, tolerance) {
                paper::Answer::Utilisation(value) => Answer::number(Claim::Solved, value),
                paper::Answer::Infeasible => Answer::INFEASIBLE,
                paper::Answer::GaveUp(value) => Answer::number(Claim::Stopped, value),
            },
            Self::Standard(tolerance) => {
                let solution = standard::program::<f64>(structure).solve(settings(tolerance));
                solution.as_ref().map_or(Answer::NOTHING, from_dual)
            }
            Self::Pyramid(side, sides) => {
                let program = linear(&standard::program(structure), side, sides);
                let solution = program.solve(settings(DEFAULT));
                solution.as_ref().map_or(Answer::NOTHING, from_dual)
            }
            Self::ToGap(gap) => proved(&assess(structure, Question::ToGap(gap)).expect(SOUND)),
            Self::Unreduced(left_in, gap) => {
                proved(&assess_reduced(structure, Question::ToGap(gap), left_in.reductions()).expect(SOUND))
            }
            Self::Decide => proved(&assess(structure, DECIDE).expect(SOUND)),
            Self::CarriedOver => neighbour.map_or(Answer::NOTHING, |memory| carried_over(structure, memory)),
        }
    }
}

impl Answer {
    const NOTHING: Self = Self { claim: Claim::Nothing, lower: 0.0, upper: f64::INFINITY };
    const INFEASIBLE: Self = Self { claim: Claim::Infeasible, lower: f64::INFINITY, upper: f64::INFINITY };

    const fn number(claim: Claim, value: f64) -> Self {
        if value.is_finite() { Self { claim, lower: value, upper: value } } else { Self::NOTHING }
    }

    /// The largest distance of anything in the answer from `value`: by how much one can be
    /// wrong who trusts it. `None` without an answer of finite width.
    pub fn error(&self, value: f64) -> Option<f64> {
        let error = (value - self.lower).abs().max((self.upper - value).abs());
        error.is_finite().then_some(error)
    }
}

/// The claim behind the status of a solver that was handed the dual.
fn from_dual(solution: &Solution<f64>) -> Answer {
    match solution.status {
        SolverStatus::Solved => Answer::number(Claim::Solved, solution.value),
        SolverStatus::DualInfeasible => Answer::INFEASIBLE,
        _ => Answer::number(Claim::Stopped, solution.value),
    }
}

fn proved(answer: &Assessment) -> Answer {
    let (lower, upper) = (answer.utilisation.lower, answer.utilisation.upper);
    let claim = if lower.is_infinite() { Claim::Infeasible } else { Claim::Proved };
    Answer { claim, lower, upper }
}

fn carried_over(structure: &Structure, memory: &Memory) -> Answer {
    let same: Vec<Option<usize>> = (0..structure.bodies.len()).map(Some).collect();
    let (answer, _memory) = assess_near(structure, DECIDE, memory, &same).expect(SOUND);
    match proved(&answer) {
        found if answer.decided_by.is_without_solve() => found,
        found => Answer { claim: Claim::Stopped, ..found },
    }
}
