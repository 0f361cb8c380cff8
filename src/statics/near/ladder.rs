//! The bounds on one block that carried fields prove, from the cheapest on, until
//! they answer the question.

use crate::spatial::{Twist, Wrench};

use super::super::assessment::{Bracket, Question};
use super::super::bracket::Problem;
use super::super::part::Part;
use super::super::rung::Rung;
use super::give::{Give, balances, lacking};
use super::opening::{inadmissible, open};
use super::put_back::put_back;
use super::room::Rooms;

/// Rounds of putting wrenches back into their cones and balancing them again.
/// Each costs a factorisation; later ones rarely decide.
const ROUNDS: usize = 4;

/// Share of the way to the middles of the cones in the first round, which starts
/// from a field that was good where it comes from, and in later ones.
const CENTRING: [f64; 2] = [0.3, 0.7];

/// Strengths, relative to the rated ones, at which a block is asked for.
fn level(question: Question) -> Option<f64> {
    match question {
        // Nothing can be put into a cone without any room.
        Question::Decide(threshold) => (threshold > 0.0).then_some(threshold),
        Question::ToGap(_) | Question::Full => None,
    }
}

/// What was proved of a block so far.
pub(super) struct Ladder<'p> {
    problem: Problem<'p>,
    question: Question,
    bracket: Bracket,
    wrenches: Vec<Wrench>,
    demands: Vec<f64>,
    mechanism: Vec<Twist>,
    shares: Vec<f64>,
}

impl<'p> Ladder<'p> {
    pub(super) fn new(problem: Problem<'p>, question: Question) -> Self {
        let (bodies, links) = (problem.block.bodies.len(), problem.block.links.len());
        Self {
            problem,
            question,
            bracket: Bracket::new(0.0, f64::INFINITY),
            wrenches: vec![Wrench::ZERO; links],
            demands: vec![0.0; links],
            mechanism: vec![Twist::ZERO; bodies],
            shares: vec![0.0; links],
        }
    }

    /// Tries `twists`, if any, and `field`; first the one that is more likely to answer.
    pub(super) fn climb(mut self, twists: Option<Vec<Twist>>, field: Vec<Wrench>, falls: bool) -> Part {
        for motion in [falls, !falls] {
            if self.answered() {
                break;
            }
            match (&twists, motion) {
                (Some(twists), true) => self.try_motion(twists, &field),
                (None, true) => {}
                (_, false) => self.try_forces(field.clone()),
            }
        }
        // Each end is proved up to the tolerance on balance; where they cross by
        // that, the truth lies between them.
        if self.bracket.lower > self.bracket.upper {
            std::mem::swap(&mut self.bracket.lower, &mut self.bracket.upper);
        }
        Part::Stands {
            utilisation: self.bracket,
            wrenches: self.wrenches,
            demands: self.demands,
            mechanism: self.mechanism,
            shares: self.shares,
            undecided_because: None,
            decided_by: Rung::CarriedOver,
            unproved: None,
        }
    }

    fn answered(&self) -> bool {
        self.question.is_answered_by(&self.bracket)
    }

    /// Lower bounds: the carried twists as they are or a little opened, then with
    /// the links locked that do not admit them.
    fn try_motion(&mut self, twists: &[Twist], field: &[Wrench]) {
        self.keep_lower(twists.to_vec());
        if let (false, Some(level)) = (self.answered(), level(self.question)) {
            let locked = inadmissible(&self.problem, twists);
            if locked.contains(&true) {
                let rooms = Rooms::locking(&self.problem, field, level, |l| locked[l]);
                let give = Give::new(&self.problem, rooms);
                self.keep_lower(give.lock(&self.problem, twists, &locked));
            }
        }
    }

    /// Upper bounds: the carried wrenches as they are, if they balance, then
    /// balanced and put back into their cones in turns.
    fn try_forces(&mut self, mut field: Vec<Wrench>) {
        if balances(&self.problem, &lacking(&self.problem, &field)) {
            self.keep_upper(&field);
            if self.answered() {
                return;
            }
            self.put_back(&mut field);
        }
        let Some(level) = level(self.question) else { return };
        let mut give: Option<Give> = None;
        for round in 0..ROUNDS {
            let rooms = Rooms::new(&self.problem, &field, level);
            let give = match &mut give {
                Some(give) => {
                    give.renew(rooms);
                    give
                }
                None => give.insert(Give::new(&self.problem, rooms)),
            };
            let way = give.balance(&self.problem, &mut field, CENTRING[round.min(1)]);
            self.keep_upper(&field);
            if !self.answered() {
                self.keep_lower(way);
            }
            if self.answered() {
                return;
            }
            self.put_back(&mut field);
        }
    }

    fn put_back(&self, field: &mut [Wrench]) {
        let Some(level) = level(self.question) else { return };
        for (&link, wrench) in self.problem.block.links.iter().zip(field) {
            put_back(self.problem.structure, link, wrench, level);
        }
    }

    /// Opens `twists` where that is needed and keeps what they prove, scaled to
    /// unit dissipation.
    fn keep_lower(&mut self, mut twists: Vec<Twist>) {
        if !open(&self.problem, &mut twists) {
            return;
        }
        let Some((lower, shares)) = self.problem.lower_bound(&twists) else { return };
        if lower > self.bracket.lower {
            let bodies = self.problem.block.bodies.iter().zip(&twists);
            let power: f64 = bodies.map(|(&body, twist)| twist.power(&self.problem.loads[body].wrench)).sum();
            let scale = lower / power;
            self.bracket.lower = lower;
            self.shares = shares;
            self.mechanism = twists.iter().map(|v| Twist::new(v.linear * scale, v.angular * scale)).collect();
        }
    }

    fn keep_upper(&mut self, field: &[Wrench]) {
        let enough = level(self.question).unwrap_or(0.0);
        let mechanism = (self.bracket.lower > 0.0).then_some(&self.mechanism[..]);
        let Some((upper, demands)) = self.problem.upper_bound(field, mechanism, enough) else { return };
        if upper < self.bracket.upper {
            self.bracket.upper = upper;
            self.wrenches = field.to_vec();
            self.demands = demands;
        }
    }
}
