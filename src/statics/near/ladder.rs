//! The bounds on one block that carried fields prove, from the cheapest on, until
//! they answer the question.

use crate::spatial::{Twist, Vec3, Wrench};

use super::super::assessment::{Bracket, Question};
use super::super::blocks::Link;
use super::super::bracket::Problem;
use super::super::connector::Connector;
use super::super::demand::{WrenchError, demand_at_most};
use super::super::part::Part;
use super::super::rung::Rung;
use super::super::structure::Structure;
use super::field::{Field, face};
use super::give::{Give, balances, lacking};
use super::opening::Opening;
use super::put_back::put_back;
use super::room::Rooms;

/// Rounds of putting wrenches back into their cones and balancing them again.
/// Each costs a factorisation; later ones rarely decide.
const ROUNDS: usize = 4;

/// Excess of the demand, relative to the level that is asked for, from which on more rounds are
/// hopeless after each.
const HOPELESS: [f64; ROUNDS] = [1.4, 0.8, 0.2, 0.0];

/// What a round has to leave at most, of that excess or of what the lower bound lacks, for the next
/// one to be worth its factorisation.
const WORTHWHILE: f64 = 0.5;

/// Excess above which a second round that got nowhere says little: it is the first one that
/// begins from wrenches put back into their cones.
const ASTRAY: f64 = 0.1;

/// Share of the way to the middles of the cones in the first round, which starts
/// from a field that was good where it comes from, and in later ones.
const CENTRING: [f64; 2] = [0.5, 0.9];

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
    field: Field,
    demands: Vec<f64>,
    mechanism: Vec<Twist>,
    shares: Vec<f64>,
    /// The springs that balanced it.
    give: Option<Give>,
}

/// Springs that balanced a neighbouring block of the same bodies.
pub(super) struct Sprung<'m> {
    pub give: &'m Give,
    /// Of each link, if it was there.
    pub springs: Vec<Option<usize>>,
}

/// What carried fields say about a block.
pub(super) struct Climbed {
    pub part: Part,
    /// Forces at the points of its faces, one face after the other.
    pub points: Vec<Vec3>,
    /// The springs that balanced it, where none that were known did.
    pub give: Option<Give>,
}

impl<'p> Ladder<'p> {
    pub(super) fn new(problem: Problem<'p>, question: Question) -> Self {
        let (bodies, links) = (problem.block.bodies.len(), problem.block.links.len());
        Self {
            problem,
            question,
            bracket: Bracket::new(0.0, f64::INFINITY),
            field: Field { wrenches: vec![Wrench::ZERO; links], points: Vec::new() },
            demands: vec![0.0; links],
            mechanism: vec![Twist::ZERO; bodies],
            shares: vec![0.0; links],
            give: None,
        }
    }

    /// Tries `twists`, if any, and `wrenches`; where the neighbour `falls`, the twists first.
    /// `known` has what the points of a face carried, `sprung` what balanced them.
    pub(super) fn climb(
        mut self,
        twists: Option<Vec<Twist>>,
        wrenches: Vec<Wrench>,
        known: impl Fn(Link) -> Vec<Vec3>,
        falls: bool,
        sprung: Option<Sprung<'_>>,
    ) -> Climbed {
        let twists = twists.unwrap_or_default();
        if falls {
            self.try_motion(&twists);
        }
        let balanced = || balances(&self.problem, &lacking(&self.problem, &wrenches));
        if !self.answered() && balanced() {
            self.keep_carried(&wrenches);
        }
        if let (false, Some(level)) = (self.answered(), level(self.question)) {
            let field = Field::new(&self.problem, wrenches, level, known);
            if let Some(sprung) = sprung {
                self.balance(&field, level, &sprung);
            }
            if !self.answered() {
                self.repair(field, level, &twists);
            }
        } else if !falls && !self.answered() {
            self.try_motion(&twists);
        }
        // Each end is proved up to the tolerance on balance; where they cross by
        // that, the truth lies between them.
        if self.bracket.lower > self.bracket.upper {
            std::mem::swap(&mut self.bracket.lower, &mut self.bracket.upper);
        }
        let part = Part::Stands {
            utilisation: self.bracket,
            wrenches: self.field.wrenches,
            demands: self.demands,
            mechanism: self.mechanism,
            shares: self.shares,
            undecided_because: None,
            decided_by: Rung::CarriedOver,
            unproved: None,
        };
        Climbed { part, points: self.field.points, give: self.give }
    }

    fn answered(&self) -> bool {
        self.question.is_answered_by(&self.bracket)
    }

    /// Lower bounds: the carried twists as they are or a little opened by breathing.
    fn try_motion(&mut self, twists: &[Twist]) {
        if !twists.is_empty() {
            self.keep_lower(&Opening::breathing(&self.problem), twists.to_vec());
        }
    }

    /// Upper bound from the field balanced by springs that are known.
    fn balance(&mut self, field: &Field, level: f64, sprung: &Sprung<'_>) {
        let mut field = field.clone();
        if sprung.give.refine_by(&self.problem, &mut field, |link| sprung.springs[link]) {
            self.keep_upper(&field, level);
        }
    }

    /// Upper bounds from the field balanced and put back into its cones in turns, lower
    /// bounds from the way in which the loads win where that is not enough.
    fn repair(&mut self, mut field: Field, level: f64, twists: &[Twist]) {
        let mut before = [f64::INFINITY; 2];
        for (round, hopeless) in HOPELESS.into_iter().enumerate() {
            let rooms = Rooms::new(&self.problem, &field, level);
            let give = match self.give.take() {
                Some(mut give) => {
                    give.renew(&self.problem, rooms);
                    give
                }
                None => Give::new(&self.problem, rooms),
            };
            let share = CENTRING[round.min(1)];
            let balancing = give.balancing(&self.problem, &field, share);
            field.add(&balancing.field, 1.0);
            // Where it is too large already, the last digits do not matter.
            let most = self.most(&field, level);
            if most.is_some_and(|most| most <= level) && give.refine(&self.problem, &mut field) {
                self.keep_upper(&field, level);
            }
            let give = self.give.insert(give);
            if self.question.is_answered_by(&self.bracket) {
                return;
            }
            let centring = give.centring(&self.problem);
            let less =
                |(v, c): (&Twist, &Twist)| Twist::new(v.linear - c.linear * share, v.angular - c.angular * share);
            let way = balancing.twists.iter().zip(&centring).map(less).collect();
            let opening = Opening::new(&self.problem, centring);
            self.keep_lower(&opening, way);
            if round == 0 && !twists.is_empty() && !self.answered() {
                self.keep_lower(&opening, twists.to_vec());
            }
            let excess = most.map_or(f64::INFINITY, |most| most / level - 1.0);
            let left = [excess, 1.0 - self.bracket.lower / level];
            let got_on = left.iter().zip(&before).any(|(left, before)| *left <= WORTHWHILE * before);
            let may_come = got_on || round == 1 && excess > ASTRAY;
            if self.answered() || most.is_some() && excess > hopeless || !may_come {
                return;
            }
            before = left;
            put_back(&self.problem, &mut field, level);
        }
    }

    /// Opens `twists` where that is needed and keeps what they prove, scaled to
    /// unit dissipation.
    fn keep_lower(&mut self, opening: &Opening<'_>, mut twists: Vec<Twist>) {
        if !opening.open(&mut twists) {
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

    fn mechanism(&self) -> Option<&[Twist]> {
        (self.bracket.lower > 0.0).then_some(&self.mechanism[..])
    }

    /// Keeps what the carried wrenches prove as they are.
    fn keep_carried(&mut self, wrenches: &[Wrench]) {
        let enough = level(self.question).unwrap_or(0.0);
        if let Some((upper, demands)) = self.problem.upper_bound(wrenches, self.mechanism(), enough) {
            self.bracket.upper = upper;
            self.field.wrenches = wrenches.to_vec();
            self.demands = demands;
        }
    }

    /// The largest demand in a field, if it is known and finite.
    fn most(&self, field: &Field, level: f64) -> Option<f64> {
        let demands = self.problem.demands(&field.wrenches, demand(self.problem.structure, &field.points, level))?;
        Some(demands.into_iter().fold(0.0, f64::max))
    }

    /// Keeps what a balanced field proves.
    fn keep_upper(&mut self, field: &Field, level: f64) {
        let demand = demand(self.problem.structure, &field.points, level);
        let Some((upper, demands)) = self.problem.upper_bound_by(&field.wrenches, self.mechanism(), demand) else {
            return;
        };
        if upper < self.bracket.upper {
            self.bracket.upper = upper;
            self.field = field.clone();
            self.demands = demands;
        }
    }
}

/// Demands of connections, of faces by the forces at their `points`.
fn demand(
    structure: &Structure,
    mut points: &[Vec3],
    level: f64,
) -> impl FnMut(Link, &Connector, &Wrench, &WrenchError) -> f64 {
    move |link, connector, wrench, error| {
        let Some(face) = face(structure, link) else { return demand_at_most(connector, wrench, error, level) };
        let (own, others) = points.split_at(face.points.len());
        points = others;
        face.at_most(wrench, own, level).unwrap_or_else(|| demand_at_most(connector, wrench, error, level))
    }
}
