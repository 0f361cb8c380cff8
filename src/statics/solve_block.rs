//! A block that needs optimisation: propose with the interior-point method, prove
//! with the bracket, and ask the general solver where the proof is not tight enough.

use crate::spatial::{Twist, Wrench};

use super::assessment::{Bracket, Question};
use super::balance::{idle_contacts, restore, wrenches};
use super::blocks::Block;
use super::bracket::Problem;
use super::clusters::Clusters;
use super::collapse;
use super::conic::{self, Attempt, Iterate};
use super::interior_point::InteriorPoint;
use super::loads::BodyLoad;
use super::locked::{AtRest, lock};
use super::lowered::Lowered;
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

/// Errors below which an iterate is worth proving bounds from in the end, and the
/// growth beyond the least one after which the iteration ends.
const USEFUL: f64 = 1e-2;
const SPOILED: f64 = 1e2;

/// Ways of asking the general solver where that was not enough, tried in turn
/// until the bracket is tight enough.
/// Each bound keeps the best that any of them proved.
/// A positive inset suits structures that cannot clamp themselves; a negative one
/// those that can, since it keeps their self-stress bounded.
const ATTEMPTS: [Attempt; 6] = [
    Attempt { tolerance: 1e-9, inset: 1e-8, regularization: 1e-8 },
    Attempt { tolerance: 1e-9, inset: -1e-8, regularization: 1e-8 },
    Attempt { tolerance: 1e-11, inset: 1e-9, regularization: 1e-9 },
    Attempt { tolerance: 1e-11, inset: -1e-9, regularization: 1e-9 },
    Attempt { tolerance: 1e-7, inset: -1e-6, regularization: 1e-7 },
    Attempt { tolerance: 1e-12, inset: 0.0, regularization: 1e-10 },
];

/// Scaled forces at the start of the block's own method, over those that a spanning tree carries.
const NEAR: f64 = 1.0;

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

/// Rounds of lowering strengths that are not needed.
const LOWERINGS: usize = 6;

/// Error of an iterate that more iterations hardly better.
const CONVERGED: f64 = 1e-10;

/// Inset with which a mechanism of fused clusters is asked for.
const FUSED_INSET: f64 = 1e-8;

/// Ways of asking the general solver for it.
const FUSED_ATTEMPTS: [Attempt; 2] = [
    Attempt { tolerance: 1e-9, inset: 1e-8, regularization: 1e-8 },
    Attempt { tolerance: 1e-11, inset: 1e-9, regularization: 1e-9 },
];

/// Shares of a safely admissible twist field that are mixed into a tight but
/// inadmissible one.
const MIXES: [f64; 4] = [1e-6, 1e-4, 1e-2, 1e-1];

/// Cosine of the angle between two supports' normals from which on they count as
/// facing each other.
const OPPOSITE: f64 = 0.5;

/// Smallest force scale, relative to the largest, of the last resort.
const EVEN: f64 = 1e-2;

/// Shares of the largest contact force below which a contact is left out, tried
/// in turn until the rest balances.
const IDLE: [f64; 4] = [0.0, 1e-6, 1e-4, 1e-2];

/// Shares of the whole power below which the motion of a link counts as none
/// when bodies are fused into clusters.
const FUSED: [f64; 3] = [1e-7, 1e-5, 1e-3];

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
    let mut best = Best::new(block, elsewhere, reductions);
    // Where supports face each other, begin with the attempt that bounds forces.
    let first = usize::from(faces_itself(&problem));
    let inset = ATTEMPTS[first].inset;
    let mut rung = best.iterate(&problem, &program, inset, NEAR, question);
    if best.upper.is_infinite()
        && (!best.answers(question) || collapse::is_quick(structure, block))
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
fn converged(program: &Program, inset: f64, reductions: Reductions) -> Option<(Iterate, bool)> {
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

/// The best bounds so far and the fields that prove them.
struct Best {
    lower: f64,
    upper: f64,
    wrenches: Vec<Wrench>,
    demands: Vec<f64>,
    mechanism: Vec<Twist>,
    shares: Vec<f64>,
    /// Both fields of the iterate that was enough, as they are.
    unproved: Option<(Vec<Wrench>, Vec<Twist>)>,
    /// What mechanisms were restricted to before.
    restrictions: Vec<(Clusters, AtRest)>,
    /// What may be left out on the way.
    reductions: Reductions,
    /// What another part of the structure needs at least.
    elsewhere: f64,
}

impl Best {
    fn new(block: &Block, elsewhere: f64, reductions: Reductions) -> Self {
        Self {
            lower: 0.0,
            upper: f64::INFINITY,
            wrenches: vec![Wrench::ZERO; block.links.len()],
            demands: vec![0.0; block.links.len()],
            mechanism: vec![Twist::ZERO; block.bodies.len()],
            shares: vec![0.0; block.links.len()],
            unproved: None,
            restrictions: Vec::new(),
            reductions,
            elsewhere,
        }
    }

    fn answers(&self, question: Question) -> bool {
        self.upper <= self.elsewhere || question.is_answered_by(&Bracket::new(self.lower, self.upper))
    }

    /// Runs the block's own method until what it proves answers the question, or
    /// it gets no further. Says which of the two it was.
    fn iterate(
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

    /// Asks the general solver, in every way there is.
    fn ask_generally(&mut self, problem: &Problem<'_>, even: &Program, first: usize, question: Question) {
        self.lower_strengths(problem, ATTEMPTS[first].inset, question);
        for attempt in ATTEMPTS[first..].iter().chain(&ATTEMPTS[..first]) {
            if self.answers(question) {
                return;
            }
            if let Some(iterate) = conic::solve(problem.program, attempt) {
                self.improve(problem, &iterate, question);
            }
        }
        for attempt in &ATTEMPTS[..2] {
            if self.answers(question) {
                return;
            }
            if let Some(iterate) = conic::solve(even, attempt) {
                self.improve(problem, &iterate.measured(even, problem.program), question);
            }
        }
    }

    /// Bounds from an iterate, and from what its motion says about clusters.
    fn improve(&mut self, problem: &Problem<'_>, iterate: &Iterate, question: Question) {
        let twists = problem.program.twists(&iterate.v);
        if !self.keep_lower(problem, &twists) {
            self.mix(problem, &twists);
        }
        for share in IDLE {
            if self.keep_upper(problem, iterate, share) {
                break;
            }
        }
        if !self.answers(question) && self.upper.is_finite() {
            self.fuse(problem, &twists, question);
        }
        // Each is proved up to the tolerance on balance; where they cross by
        // that, the truth lies between them.
        if self.lower > self.upper {
            std::mem::swap(&mut self.lower, &mut self.upper);
        }
    }

    /// Keeps what the solver's wrenches prove once they balance, without the
    /// contacts that carry less than `share`; whether they balance.
    fn keep_upper(&mut self, problem: &Problem<'_>, iterate: &Iterate, share: f64) -> bool {
        let mut field = wrenches(problem.program, iterate);
        let idle = idle_contacts(problem.block, &field, share);
        if share > 0.0 && !idle.contains(&true) {
            return false;
        }
        restore(problem, iterate, &mut field, &idle, self.reductions.chains);
        let Some((upper, demands)) = problem.upper_bound(&field, self.unit_mechanism(), 0.0) else { return false };
        if upper < self.upper {
            self.upper = upper;
            self.wrenches = field;
            self.demands = demands;
        }
        true
    }

    /// Charges the upper bound with its imbalance's power in the mechanism, which is new.
    fn charge(&mut self, problem: &Problem<'_>) {
        if self.upper.is_finite()
            && let Some((upper, _)) = problem.upper_bound(&self.wrenches, self.unit_mechanism(), 0.0)
        {
            self.upper = upper;
        }
    }

    /// Mixes a share of the mechanism so far, which is admissible, into a twist
    /// field that is not, but may be tighter.
    fn mix(&mut self, problem: &Problem<'_>, twists: &[Twist]) {
        if self.lower == 0.0 {
            return;
        }
        let safe = self.mechanism.clone();
        for share in MIXES {
            let mix = |(a, b): (&Twist, &Twist)| Twist::new(a.linear + b.linear * share, a.angular + b.angular * share);
            let mixed: Vec<Twist> = twists.iter().zip(&safe).map(mix).collect();
            if self.keep_lower(problem, &mixed) {
                return;
            }
        }
    }

    /// Asks again with the strengths that are not needed lowered, and with the
    /// bodies that they join moving as one.
    fn lower_strengths(&mut self, problem: &Problem<'_>, inset: f64, question: Question) {
        let Problem { structure, block, loads, program } = *problem;
        let mut lowered = Lowered::new(structure, block, program);
        for _ in 0..LOWERINGS {
            let t = self.upper.min(program.t_scale);
            let shares = lowered.shares(t);
            if shares.iter().all(|share| *share == 1.0) {
                return;
            }
            let program = Program::with_shares(structure, block, loads, shares.clone());
            let problem = Problem { program: &program, ..*problem };
            self.iterate(&problem, &program, inset, NEAR, question);
            if self.answers(question) || !self.upper.is_finite() {
                return;
            }
            let moving = vec![[false; 6]; block.links.len()];
            let idle = |link: usize| shares[link] < 1.0 && self.demands[link] < shares[link] * self.upper;
            self.move_as_one(&problem, Clusters::new(structure, block, |link, _| idle(link)), moving, question);
            if self.answers(question) || !(lowered.raise(&shares, &self.demands, self.upper) || self.upper < 0.5 * t) {
                return;
            }
        }
    }

    /// Lets bodies that hardly move against each other in `twists` move as one,
    /// and asks for the best mechanism of that kind. Parts that are clamped by
    /// their own stress have no admissible motion but rest: there the solver's
    /// twists are noise, which nothing else would make admissible.
    fn fuse(&mut self, problem: &Problem<'_>, twists: &[Twist], question: Question) {
        let Problem { structure, block, loads, .. } = *problem;
        let powers = problem.link_powers(twists);
        let power: f64 = block.bodies.iter().zip(twists).map(|(&body, v)| v.power(&loads[body].wrench)).sum();
        for share in FUSED {
            let least = share * power;
            let at_rest = powers.iter().map(|link| link.map(|along| along <= least)).collect();
            let clusters = Clusters::new(structure, block, |link, _| powers[link].iter().sum::<f64>() <= least);
            self.move_as_one(problem, clusters, at_rest, question);
            if self.answers(question) {
                return;
            }
        }
    }

    /// Keeps the best mechanism in which each of `clusters` moves as one and what is
    /// `at_rest` between them is held.
    fn move_as_one(&mut self, problem: &Problem<'_>, clusters: Clusters, at_rest: AtRest, question: Question) {
        let restriction = (clusters, at_rest);
        if self.restrictions.contains(&restriction) {
            return;
        }
        let (clusters, at_rest) = &restriction;
        let Problem { structure, block, loads, .. } = *problem;
        let Some(mut reduced) = clusters.reduce(structure, block, loads) else { return };
        lock(&mut reduced, at_rest);
        let program = Program::new(&reduced.structure, &reduced.block, &reduced.loads, Purpose::Utilisation);
        let inner =
            Problem { structure: &reduced.structure, block: &reduced.block, loads: &reduced.loads, program: &program };
        let reductions = self.reductions;
        let own = std::iter::once_with(|| converged(&program, FUSED_INSET, reductions));
        let generally =
            FUSED_ATTEMPTS.iter().map(|attempt| conic::solve(&program, attempt).map(|iterate| (iterate, false)));
        for (iterate, last) in own.chain(generally).flatten() {
            let twists = program.twists(&iterate.v);
            let Some((lower, inner_shares)) = inner.lower_bound(&twists) else { continue };
            if lower > self.lower {
                self.lower = lower;
                self.mechanism = clusters.spread(structure, block, &reduced, &twists);
                self.shares = vec![0.0; block.links.len()];
                for (&origin, share) in reduced.origins.iter().zip(inner_shares) {
                    self.shares[origin] = share;
                }
                self.charge(problem);
            }
            if last || self.answers(question) {
                break;
            }
        }
        self.restrictions.push(restriction);
    }

    /// Keeps what `twists` prove; whether they were admissible.
    fn keep_lower(&mut self, problem: &Problem<'_>, twists: &[Twist]) -> bool {
        let Some((lower, shares)) = problem.lower_bound(twists) else { return false };
        if lower > self.lower {
            self.lower = lower;
            self.shares = shares;
            self.mechanism = twists.to_vec();
            self.charge(problem);
        }
        true
    }

    /// The mechanism, if it proves anything: its dissipation is about 1.
    fn unit_mechanism(&self) -> Option<&[Twist]> {
        (self.lower > 0.0).then_some(&self.mechanism[..])
    }
}
