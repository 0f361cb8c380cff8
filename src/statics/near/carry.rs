//! The fields of a neighbouring state as bounds on this one.

use crate::spatial::{Twist, Vec3, Wrench};

use super::super::assess::Knowledge;
use super::super::assessment::{Assessment, Bracket, Question};
use super::super::blocks::{Block, Link, Vertex};
use super::super::bracket::Problem;
use super::super::frame::LinkFrame;
use super::super::loads::BodyLoad;
use super::super::part::Part;
use super::super::program::Program;
use super::super::rung::Rung;
use super::super::structure::Structure;
use super::breathing::repair;
use super::memory::{Held, Known, Memory, NotNear, links};
use super::project::{Give, imbalance, lacking};

pub static STAGES: [std::sync::atomic::AtomicUsize; 20] = [const { std::sync::atomic::AtomicUsize::new(0) }; 20];

/// Puts a wrench into its cone at this level.
fn clip(structure: &Structure, link: Link, wrench: &mut Wrench, level: f64) {
    use super::super::connector::Model;
    use super::super::second_order::norm;
    let (f, m) = (&mut wrench.force, &mut wrench.torque);
    const IN: f64 = 0.98;
    match link {
        Link::Contact(i) => {
            let mu = structure.contacts[i].friction;
            if mu > 0.0 { f.z = f.z.max(f.xy().norm() / mu / IN) } else { *f = Vec3::z() * f.z.max(0.0) }
            *m = Vec3::zeros();
        }
        Link::Connection(i) => {
            let connector = &structure.connectors[structure.connections[i].connector];
            let held = level * connector.strength;
            match &connector.model {
                Model::Cone { friction: [a, b], radius: [c, d, e] } => {
                    let tail = norm(&[f.x / a, f.y / b, m.x / c, m.y / d, m.z / e]);
                    let head = held + f.z;
                    if head * IN < tail {
                        // Nearest point of the cone, about.
                        let to = ((head + tail) / 2.0).max(0.0);
                        f.z = to / IN.sqrt() - held;
                        let factor = to * IN.sqrt() / tail;
                        f.x *= factor;
                        f.y *= factor;
                        *m *= factor;
                    }
                }
                Model::Box { shear, tension, compression, bending, torsion } => {
                    let to = |x: f64, low: f64, high: f64| x.clamp(-low * level * IN, high * level * IN);
                    f.x = to(f.x, shear[0], shear[0]);
                    f.y = to(f.y, shear[1], shear[1]);
                    f.z = to(f.z, *tension, *compression);
                    m.x = to(m.x, bending[0], bending[0]);
                    m.y = to(m.y, bending[1], bending[1]);
                    m.z = to(m.z, *torsion, *torsion);
                }
                Model::Patch { .. } => {}
            }
        }
    }
}

/// Pressure of each point.
pub(super) fn pressures(wrench: &Wrench, held: f64, points: &[[f64; 2]]) -> Vec<Vec3> {
    let n = points.len() as f64;
    let total = (held + wrench.force.z).max(1e-3 * held);
    let (mut xx, mut yy) = (0.0, 0.0);
    for p in points {
        xx += p[0] * p[0];
        yy += p[1] * p[1];
    }
    // tau = sum p x g: tau_x = sum y g, tau_y = - sum x g.
    let (bx, by) = (-wrench.torque.y / xx.max(f64::MIN_POSITIVE), wrench.torque.x / yy.max(f64::MIN_POSITIVE));
    points.iter().map(|p| Vec3::z() * (total / n + bx * p[0] + by * p[1]).max(1e-3 * total / n)).collect()
}

/// What is remembered of a neighbour, laid out for this structure.
pub(super) struct Carried<'s> {
    structure: &'s Structure,
    question: Question,
    links: Vec<Held>,
    twists: Vec<Option<Twist>>,
    lower_first: bool,
    known: bool,
    noted: Vec<(Block, Vec<Twist>)>,
}

impl<'s> Carried<'s> {
    pub(super) fn nothing(structure: &'s Structure, question: Question) -> Self {
        Self {
            structure,
            question,
            links: links(structure),
            twists: vec![None; structure.bodies.len()],
            lower_first: false,
            known: false,
            noted: Vec::new(),
        }
    }

    pub(super) fn new(
        structure: &'s Structure,
        question: Question,
        memory: &Memory,
        matching: &[Option<usize>],
    ) -> Result<Self, NotNear> {
        memory.check(structure, matching)?;
        let mut links = links(structure);
        memory.recall(&mut links, matching);
        let twists = memory.twists(structure, matching);
        let lower_first = match question {
            Question::Decide(threshold) => memory.utilisation.lower > threshold,
            Question::ToGap(_) => false,
        };
        Ok(Self { structure, question, links, twists, lower_first, known: true, noted: Vec::new() })
    }

    fn held(&self, link: Link) -> &Held {
        match link {
            Link::Connection(i) => &self.links[i],
            Link::Contact(i) => &self.links[self.structure.connections.len() + i],
        }
    }

    fn held_mut(&mut self, link: Link) -> &mut Held {
        match link {
            Link::Connection(i) => &mut self.links[i],
            Link::Contact(i) => &mut self.links[self.structure.connections.len() + i],
        }
    }

    /// Twists of the block's bodies relative to its root.
    fn relative(&self, block: &Block) -> Option<Vec<Twist>> {
        let root = match block.root {
            Vertex::Ground => (Twist::ZERO, Vec3::zeros()),
            Vertex::Body(i) => (self.twists[i].unwrap_or(Twist::ZERO), self.structure.bodies[i].com),
        };
        let mut any = false;
        let twists = block
            .bodies
            .iter()
            .map(|&body| {
                let com = self.structure.bodies[body].com;
                let with = root.0.moved(&(com - root.1));
                let twist = self.twists[body].unwrap_or(with);
                let relative = Twist::new(twist.linear - with.linear, twist.angular - with.angular);
                any |= relative != Twist::ZERO;
                relative
            })
            .collect();
        any.then_some(twists)
    }

    pub(super) fn into_memory(mut self, answer: &Assessment) -> Memory {
        let mut twists: Vec<Twist> = vec![Twist::ZERO; self.structure.bodies.len()];
        for (block, relative) in std::mem::take(&mut self.noted) {
            let root = match block.root {
                Vertex::Ground => (Twist::ZERO, Vec3::zeros()),
                Vertex::Body(i) => (twists[i], self.structure.bodies[i].com),
            };
            for (&body, twist) in block.bodies.iter().zip(relative) {
                let with = root.0.moved(&(self.structure.bodies[body].com - root.1));
                twists[body] = Twist::new(with.linear + twist.linear, with.angular + twist.angular);
            }
        }
        let bodies = self.structure.bodies.iter().zip(twists);
        let bodies = bodies.map(|(body, twist)| Known { com: body.com, twist }).collect();
        Memory { utilisation: answer.utilisation, bodies, links: self.links }
    }

    fn lower(&self, problem: &Problem<'_>) -> Option<(f64, Vec<f64>, Vec<Twist>)> {
        let mut twists = self.relative(problem.block)?;
        if !repair(problem, &mut twists) {
            return None;
        }
        let (lower, shares) = problem.lower_bound(&twists)?;
        Some((lower, shares, twists))
    }
}

impl Knowledge for Carried<'_> {
    fn bound(&mut self, structure: &Structure, block: &Block, loads: &[BodyLoad]) -> Option<Part> {
        if !self.known || block.bodies.iter().all(|&body| loads[body].is_zero()) {
            return None;
        }
        let program = Program::unstated(structure, block, loads, 1e-9);
        let problem = Problem { structure, block, loads, program: &program };
        let level = match self.question {
            Question::Decide(threshold) => threshold,
            Question::ToGap(_) => 1.0,
        };
        let mut bracket = Bracket::new(0.0, f64::INFINITY);
        let (mut mechanism, mut shares) = (vec![Twist::ZERO; block.bodies.len()], vec![0.0; block.links.len()]);
        let (mut wrenches, mut demands) = (vec![Wrench::ZERO; block.links.len()], vec![0.0; block.links.len()]);
        let mut field: Vec<Wrench> = block
            .links
            .iter()
            .zip(&program.frames)
            .map(|(&link, frame): (&Link, &LinkFrame)| {
                let Wrench { force, torque } = self.held(link).wrench;
                Wrench::new(frame.axes.tr_mul(&force), frame.axes.tr_mul(&torque))
            })
            .collect();
        let mut stage = 0;
        'done: for lower in [self.lower_first, !self.lower_first] {
            if lower {
                if let Some((bound, by, twists)) = self.lower(&problem) {
                    bracket.lower = bound;
                    (shares, mechanism) = (by, twists);
                }
                stage = 1;
                if self.question.is_answered_by(&bracket) {
                    break;
                }
                if let Some(twists) = self.relative(block) {
                    let largest = twists.iter().map(|twist| twist.linear.norm()).fold(0.0, f64::max);
                    let bad: Vec<bool> = super::breathing::reserves(&problem, &twists).iter().map(|r| *r < -1e-6 * largest).collect();
                    if bad.contains(&true) {
                        let give = Give::new(&problem, &field, level, Some(&bad));
                        let mut locked = give.lock(&problem, &twists, &bad);
                        if repair(&problem, &mut locked) && let Some((bound, by)) = problem.lower_bound(&locked) && bound > bracket.lower {
                            bracket.lower = bound;
                            (shares, mechanism) = (by, locked);
                            stage = 2;
                        }
                    }
                }
            } else {
                let missing = lacking(&problem, &field);
                let balanced = imbalance(&problem, &missing) <= 1e-12;
                for round in 0..4 {
                    stage = 3 + round;
                    if !balanced || round > 0 {
                        let give = Give::new(&problem, &field, level, None);
                        let mut y = give.project(&problem, &mut field);
                        if let Some((bound, all)) = problem.upper_bound(&field, None) && bound < bracket.upper {
                            bracket.upper = bound;
                            (wrenches, demands) = (field.clone(), all);
                        }
                        if self.question.is_answered_by(&bracket) {
                            break 'done;
                        }
                        stage += 10;
                        if repair(&problem, &mut y) && let Some((bound, by)) = problem.lower_bound(&y) && bound > bracket.lower {
                            bracket.lower = bound;
                            (shares, mechanism) = (by, y);
                        }
                    } else if let Some((bound, all)) = problem.upper_bound(&field, None) {
                        bracket.upper = bound;
                        (wrenches, demands) = (field.clone(), all);
                    }
                    if self.question.is_answered_by(&bracket) {
                        break 'done;
                    }
                    for (&link, wrench) in block.links.iter().zip(&mut field) {
                        clip(structure, link, wrench, level);
                    }
                }
            }
            if self.question.is_answered_by(&bracket) {
                break;
            }
        }
        if self.question.is_answered_by(&bracket) {
            STAGES[stage].fetch_add(1, std::sync::atomic::Ordering::Relaxed);
        }
        Some(Part::Stands {
            utilisation: bracket,
            wrenches,
            demands,
            mechanism,
            shares,
            undecided_because: None,
            decided_by: Rung::CarriedOver,
        })
    }

    fn note(&mut self, block: &Block, part: &Part) {
        match part {
            Part::Collapses { mechanism, .. } => self.noted.push((block.clone(), mechanism.clone())),
            Part::Stands { utilisation, wrenches, mechanism, .. } => {
                if utilisation.upper.is_finite() {
                    for (&link, wrench) in block.links.iter().zip(wrenches) {
                        let frame = LinkFrame::new(self.structure, link);
                        self.held_mut(link).wrench =
                            Wrench::new(frame.axes * wrench.force, frame.axes * wrench.torque);
                    }
                }
                if utilisation.lower > 0.0 {
                    self.noted.push((block.clone(), mechanism.clone()));
                } else if let Some(twists) = self.relative(block) {
                    self.noted.push((block.clone(), twists));
                }
            }
        }
    }
}
