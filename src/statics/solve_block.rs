//! A block that needs optimisation: propose with the interior-point method, prove
//! with the bracket, and ask the general solver where the proof is not tight enough
//! (see `best`, `as_one` and `attempts`).

use crate::spatial::{Twist, Wrench};

use super::assessment::{Bracket, Question};
use super::attempts::ATTEMPTS;
use super::balance::wrenches;
use super::best::Best;
use super::blocks::Block;
use super::bracket::Problem;
use super::collapse;
use super::conic::Iterate;
use super::interior_point::InteriorPoint;
use super::loads::BodyLoad;
use super::part::Part;
use super::program::{Program, Purpose, local_body};
use super::reductions::Reductions;
use super::rung::Rung;
use super::structure::Structure;

/// Iterations after which the block's own interior-point method gives up; it needs
/// 10 to 25, more where parts clamp themselves.
const ITERATIONS: usize = 50;

/// Error in t, as a share of the bracket's width that is asked for, from which on
/// an iterate may prove a bracket that narrow.
const NARROW: f64 = 0.5;

/// Least improvement of the error from one attempt to prove a bracket to the next.
const WORTHWHILE: f64 = 0.5;

/// Scaled imbalance from which on an iterate's forces may prove an upper bound.
const BALANCED: f64 = 1e-6;

/// Scaled imbalance up to which that is worth a try where only the motion is of use so far.
const NEARLY_BALANCED: f64 = 1e-2;

/// Errors below which an iterate is worth proving bounds from in the end, and the
/// growth beyond the least one after which the iteration ends.
const USEFUL: f64 = 1e-2;
const SPOILED: f64 = 1e2;

/// Error of an iterate that more iterations hardly better.
const CONVERGED: f64 = 1e-10;

/// Scaled forces at the start of the block's own method, over those that a spanning tree carries.
pub(super) const NEAR: f64 = 1.0;

/// Further ways of asking the block's own method.
#[derive(Clone, Copy, Debug)]
struct Start {
    /// Whether all bodies are measured by about the same force.
    even: bool,
    inset: Option<f64>,
    from: f64,
}

const STARTS: [Start; 5] = [
    Start { even: true, inset: None, from: NEAR },
    Start { even: true, inset: Some(CLAMPED), from: NEAR },
    Start { even: true, inset: None, from: 1e2 },
    Start { even: false, inset: None, from: 1e2 },
    Start { even: false, inset: Some(CLAMPED), from: 1e2 },
];

/// Inset that bounds the forces of parts that clamp themselves tightly.
const CLAMPED: f64 = -1e-4;

/// Cosine of the angle between two supports' normals from which on they count as
/// facing each other.
const OPPOSITE: f64 = 0.5;

/// Smallest force scale, relative to the largest, of the last resort.
const EVEN: f64 = 1e-2;

/// Assesses a block with cycles. Where it is proved not to need more than `elsewhere`, which
/// another part of the structure needs at least, no more is asked.
pub(super) fn assess_block(
    structure: &Structure,
    block: &Block,
    loads: &[BodyLoad],
    question: Question,
    elsewhere: f64,
    reductions: Reductions,
) -> Part {
    if block.bodies.iter().all(|&body| loads[body].is_zero()) {
        return unloaded(block);
    }
    let program = Program::new(structure, block, loads, Purpose::Utilisation);
    let problem = Problem { structure, block, loads, program: &program };
    let mut best = Best::new(structure, block, elsewhere, reductions);
    // Where supports face each other, begin with the attempt that bounds forces.
    let first = usize::from(faces_itself(&problem));
    let inset = ATTEMPTS[first].inset;
    let mut rung = best.iterate(&problem, &program, inset, NEAR, question);
    if best.upper.is_infinite()
        && (!best.answers(question) || best.may_fall)
        && let Some(mechanism) = collapse::find(structure, block, loads)
    {
        return Part::Collapses { mechanism, decided_by: Rung::Solved };
    }
    if !best.answers(question) {
        let even = Program::with_floor(structure, block, loads, Purpose::Utilisation, EVEN);
        for start in STARTS {
            let inset = start.inset.unwrap_or(inset);
            let program = if start.even { &even } else { &program };
            rung = best.iterate(&problem, program, inset, start.from, question);
            if best.answers(question) {
                break;
            }
        }
        if !best.answers(question) {
            rung = Rung::SolvedGenerally;
            best.ask_generally(&problem, &even, first, question);
        }
    }
    let tight = best.answers(question);
    Part::Stands {
        utilisation: Bracket::new(best.lower, best.upper),
        wrenches: best.wrenches,
        demands: best.demands,
        mechanism: best.mechanism,
        shares: best.shares,
        undecided_because: (!tight).then(|| {
            format!(
                "the solvers left the bracket [{:.9}, {:.9}] on a block of {} bodies",
                best.lower,
                best.upper,
                block.bodies.len()
            )
        }),
        decided_by: rung,
        unproved: best.unproved,
    }
}

/// Whether two supports of the block press against each other, as floor and
/// ceiling do, so that it could clamp itself between them.
fn faces_itself(problem: &Problem<'_>) -> bool {
    let Problem { block, program, .. } = problem;
    let outward = program.frames.iter().filter_map(|frame| {
        let sign =
            frame.sides().into_iter().find_map(|(side, sign)| local_body(block, side).is_none().then_some(-sign))?;
        Some(frame.axes.column(2) * sign)
    });
    let normals: Vec<_> = outward.collect();
    normals.first().is_some_and(|first| normals.iter().any(|normal| normal.dot(first) < -OPPOSITE))
}

/// The finest iterate of the block's own method, and whether it converged.
pub(super) fn converged(program: &Program, inset: f64, reductions: Reductions) -> Option<(Iterate, bool)> {
    let mut method = InteriorPoint::new(program, inset, NEAR, reductions);
    let (mut least, mut finest) = (USEFUL, None);
    for _ in 0..ITERATIONS {
        let error = method.estimate().error;
        if error <= least {
            least = error;
            finest = Some(method.iterate());
        } else if finest.is_some() && error > SPOILED * least {
            break;
        }
        if error <= CONVERGED || !method.step() {
            break;
        }
    }
    finest.map(|iterate| (iterate, least <= CONVERGED))
}

/// Nothing to hold: no force anywhere.
fn unloaded(block: &Block) -> Part {
    Part::Stands {
        utilisation: Bracket::exact(0.0),
        wrenches: vec![Wrench::ZERO; block.links.len()],
        demands: vec![0.0; block.links.len()],
        mechanism: vec![Twist::ZERO; block.bodies.len()],
        shares: vec![0.0; block.links.len()],
        undecided_because: None,
        decided_by: Rung::ClosedForm,
        unproved: None,
    }
}

impl Best {
    /// Runs the block's own method until what it proves answers the question, or
    /// it gets no further. Says which of the two it was.
    pub(super) fn iterate(
        &mut self,
        problem: &Problem<'_>,
        program: &Program,
        inset: f64,
        start: f64,
        question: Question,
    ) -> Rung {
        let mut method = InteriorPoint::new(program, inset, start, self.reductions);
        let (mut least, mut useful) = (USEFUL, Vec::new());
        let mut tried = f64::INFINITY;
        for _ in 0..ITERATIONS {
            let estimate = method.estimate();
            match question {
                Question::Decide(threshold) => {
                    if estimate.lower > threshold {
                        self.keep_lower(
                            problem,
                            &problem.program.twists(&method.iterate().measured(program, problem.program).v),
                        );
                    } else if estimate.upper <= threshold && estimate.imbalance <= BALANCED {
                        self.keep_upper(problem, &method.iterate().measured(program, problem.program), 0.0);
                    }
                }
                Question::ToGap(_) | Question::Full => {
                    let gap = question.gap();
                    if estimate.upper <= self.elsewhere && estimate.imbalance <= BALANCED {
                        self.keep_upper(problem, &method.iterate().measured(program, problem.program), 0.0);
                    } else if estimate.error <= NARROW * gap && estimate.error <= WORTHWHILE * tried {
                        tried = estimate.error;
                        let iterate = method.iterate().measured(program, problem.program);
                        self.keep_lower(problem, &problem.program.twists(&iterate.v));
                        self.keep_upper(problem, &iterate, 0.0);
                    }
                }
            }
            if self.answers(question) {
                let iterate = method.iterate().measured(program, problem.program);
                // That strength is all it lacks is sooner shown by forces than by looking in
                // vain for a motion that no strength holds.
                if self.may_fall && self.upper.is_infinite() && estimate.imbalance <= NEARLY_BALANCED {
                    self.keep_upper(problem, &iterate, 0.0);
                }
                self.unproved = Some((wrenches(problem.program, &iterate), problem.program.twists(&iterate.v)));
                return Rung::StoppedEarly;
            }
            // What the last digits of the factorisation spoil is given back as it was.
            if estimate.error <= least {
                least = estimate.error;
                useful.push(method.iterate().measured(program, problem.program));
            } else if estimate.error > SPOILED * least && !useful.is_empty() {
                break;
            }
            if !method.step() {
                break;
            }
        }
        if let Some(finest) = useful.pop() {
            // What lies deeper inside the cones may be put right where the finest cannot.
            // The lower bound comes first: its mechanism is what imbalance is charged with.
            let coarser = || std::iter::once(&finest).chain(useful.iter().rev());
            if self.lower == 0.0 {
                coarser().any(|iterate| self.keep_lower(problem, &problem.program.twists(&iterate.v)));
            }
            if self.upper.is_infinite() {
                coarser().any(|iterate| self.keep_upper(problem, iterate, 0.0));
            }
            self.improve(problem, &finest, question);
        }
        Rung::Solved
    }
}
