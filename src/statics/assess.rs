//! The oracle: cuts a structure into blocks, answers for each, and puts the
//! answers together.

use crate::spatial::{Twist, Vec3, Wrench};

use super::assessment::{Assessment, Bracket, ConnectionState, Distribution, LeftOut, Question, Verdict};
use super::blocks::{Block, Blocks, Link, Vertex, cut};
use super::closed_form::{Bridge, assess_bridge};
use super::distribution;
use super::frame::LinkFrame;
use super::loads::{BodyLoad, lump, own_loads};
use super::part::Part;
use super::reductions::Reductions;
use super::rejoin::rejoin;
use super::rigid_links::Merged;
use super::rung::Rung;
use super::side_by_side::side_by_side;
use super::solve_block::assess_block;
use super::structure::Structure;
use super::tolerances::{CRITICAL_SHARE, DATA, TIE};
use super::validate::{InvalidStructure, validate};

/// Bodies in several blocks from which on they are solved at the same time: fewer are
/// solved before other threads have woken.
const WORTH_THREADS: usize = 32;

/// Finds the utilisation of `structure` as a bracket, and all that follows from it.
///
/// The utilisation t is the smallest common factor on all rated strengths with
/// which every free body can be in balance,
///
/// ```text
/// t* = min t  subject to  balance, friction cones, s_l(w_l) <= t S_l,
/// ```
///
/// the internal stability margin is `1 - t*`. Both ends of the bracket are
/// evaluated from wrench and twist fields on the structure's own data, for loads
/// and directions that are meant up to a relative 1e-12. With
/// [`Question::Decide`] the answer may stop at the first block that exceeds the
/// threshold: states of the other blocks stay zero and the upper end is infinite.
///
/// # Errors
/// Non-finite or out-of-range data, or indices that point nowhere; all of them at once.
pub fn assess(structure: &Structure, question: Question) -> Result<Assessment, Vec<InvalidStructure>> {
    assess_reduced(structure, question, Reductions::ALL)
}

/// As [`assess`], with some of what a scene does not need left in.
///
/// # Errors
/// As for [`assess`].
pub fn assess_reduced(
    structure: &Structure,
    question: Question,
    reductions: Reductions,
) -> Result<Assessment, Vec<InvalidStructure>> {
    validate(structure)?;
    if reductions.rigid_links
        && let Some(merged) = Merged::new(structure)
    {
        let answer = assess_with(&merged.structure, question, reductions, &mut Unknown);
        return Ok(merged.undo(structure, answer));
    }
    Ok(assess_with(structure, question, reductions, &mut Unknown))
}

/// What is known about a structure's blocks before and after they are solved.
pub(super) trait Knowledge {
    /// What can be said about a block with cycles without solving it.
    fn bound(&mut self, structure: &Structure, block: &Block, loads: &[BodyLoad]) -> Option<Part>;

    /// Takes note of the answer for a block with cycles.
    fn note(&mut self, block: &Block, part: &Part);

    /// Takes note of all blocks, once all that are answered are noted.
    fn close(&mut self, blocks: &[Block]);
}

/// Nothing, for a structure that is met for the first time.
struct Unknown;

impl Knowledge for Unknown {
    fn bound(&mut self, _: &Structure, _: &Block, _: &[BodyLoad]) -> Option<Part> {
        None
    }

    fn note(&mut self, _: &Block, _: &Part) {}

    fn close(&mut self, _: &[Block]) {}
}

/// Answers for a valid structure. What `knowledge` answers is not solved. Rigid
/// links are none of its business.
pub(super) fn assess_with(
    structure: &Structure,
    question: Question,
    reductions: Reductions,
    knowledge: &mut impl Knowledge,
) -> Assessment {
    let pieces = pieces(structure, reductions);
    let answer = assess_pieces(structure, &pieces, question, reductions, knowledge);
    knowledge.close(&pieces.blocks);
    answer
}

/// The pieces that `structure` is solved in.
pub(super) fn pieces(structure: &Structure, reductions: Reductions) -> Blocks {
    let pieces = cut(structure);
    if reductions.blocks { pieces } else { rejoin(pieces, structure.bodies.len(), reductions.closed_form) }
}

fn assess_pieces(
    structure: &Structure,
    pieces: &Blocks,
    question: Question,
    reductions: Reductions,
    knowledge: &mut impl Knowledge,
) -> Assessment {
    let loads = lump(structure, &pieces.blocks, own_loads(structure));
    let mut answer = Answer::new(structure, &pieces.blocks);
    for &root in &pieces.afloat {
        if let Some(twist) = drift(&loads[root]) {
            answer.collapse_afloat(root, twist);
            return answer.finish();
        }
    }
    let (bridges, cyclic): (Vec<usize>, Vec<usize>) =
        (0..pieces.blocks.len()).partition(|&i| reductions.closed_form && pieces.blocks[i].links.len() == 1);
    for index in bridges {
        answer.add_bridge(index, &assess_bridge(structure, &pieces.blocks[index], &loads));
    }
    let mut open = Vec::new();
    for index in cyclic {
        if answer.settled(question) {
            answer.stop();
            return answer.finish();
        }
        match knowledge.bound(structure, &pieces.blocks[index], &loads) {
            Some(part) if part.answers(question) => {
                knowledge.note(&pieces.blocks[index], &part);
                answer.take(index, part, question);
            }
            _ => open.push(index),
        }
    }
    let solve = |index: &usize| assess_block(structure, &pieces.blocks[*index], &loads, question, reductions);
    // Merged in the order of the blocks, whoever was first.
    let mut ahead = Vec::new();
    let bodies: usize = open.iter().map(|&index| pieces.blocks[index].bodies.len()).sum();
    if reductions.parallel && open.len() > 1 && bodies >= WORTH_THREADS && !answer.settled(question) {
        ahead = side_by_side(&open, solve, |part| part.settles(question));
    }
    let mut ahead = ahead.into_iter();
    for index in open {
        if answer.settled(question) {
            answer.stop();
            break;
        }
        let block = &pieces.blocks[index];
        let part = ahead.next().flatten().unwrap_or_else(|| solve(&index));
        answer.count_solved(block);
        knowledge.note(block, &part);
        answer.take(index, part, question);
    }
    answer.choose(question, &loads);
    answer.finish()
}

/// The motion in which a body without any support is carried off by its load;
/// `None` when it is in balance.
fn drift(load: &BodyLoad) -> Option<Twist> {
    let balanced = load.wrench.force.norm() <= DATA * load.force_size.norm()
        && load.wrench.torque.norm() <= DATA * load.torque_size.norm();
    (!balanced).then_some(Twist::new(load.wrench.force, load.wrench.torque))
}

/// The answers of the blocks, put together.
struct Answer<'s> {
    structure: &'s Structure,
    blocks: &'s [Block],
    utilisation: Bracket,
    collapsed: bool,
    connections: Vec<ConnectionState>,
    contacts: Vec<Vec3>,
    /// The block whose mechanism proves the lower bound, with its motion.
    moving: Option<(usize, Vec<Twist>)>,
    mechanism: Vec<Twist>,
    /// Per block: lower bound, and its links' shares in its mechanism.
    candidates: Vec<(f64, usize, Vec<f64>)>,
    left_out: LeftOut,
    undecided_because: Option<String>,
    decided_by: Rung,
    /// The blocks whose fields are still to be chosen.
    held: Vec<(usize, Part)>,
    distribution: Distribution,
}

impl<'s> Answer<'s> {
    fn new(structure: &'s Structure, blocks: &'s [Block]) -> Self {
        let idle = ConnectionState { wrench: Wrench::ZERO, strength: 0.0, utilisation: 0.0, critical: false };
        Self {
            structure,
            blocks,
            utilisation: Bracket::exact(0.0),
            collapsed: false,
            connections: vec![idle; structure.connections.len()],
            contacts: vec![Vec3::zeros(); structure.contacts.len()],
            moving: None,
            mechanism: vec![Twist::ZERO; structure.bodies.len()],
            candidates: Vec::new(),
            left_out: LeftOut {
                fixed_bodies: structure.bodies.iter().filter(|body| body.fixed).count(),
                ..LeftOut::default()
            },
            undecided_because: None,
            decided_by: Rung::ClosedForm,
            held: Vec::new(),
            distribution: Distribution::Proof,
        }
    }

    fn count_solved(&mut self, block: &Block) {
        self.left_out.solved_blocks += 1;
        self.left_out.largest_block_bodies = self.left_out.largest_block_bodies.max(block.bodies.len());
    }

    /// Whether the blocks so far answer the question for the whole.
    fn settled(&self, question: Question) -> bool {
        self.collapsed
            || match question {
                Question::Decide(threshold) => self.utilisation.lower > threshold,
                Question::ToGap(_) | Question::Full => false,
            }
    }

    /// Leaves the other blocks unanswered: one of them may need more, or fall.
    fn stop(&mut self) {
        self.utilisation.upper = f64::INFINITY;
        self.undecided_because = Some("the threshold is exceeded, the rest was not asked for".to_owned());
    }

    fn collapse_afloat(&mut self, root: usize, twist: Twist) {
        self.collapsed = true;
        self.mechanism[root] = twist;
        self.moving = None;
        self.spread();
    }

    fn add_bridge(&mut self, index: usize, bridge: &Bridge) {
        let block = &self.blocks[index];
        match block.links[0] {
            Link::Connection(i) => {
                self.left_out.closed_form_connections += 1;
                self.record(i, &bridge.wrench, bridge.utilisation.upper);
            }
            Link::Contact(i) => {
                self.left_out.closed_form_contacts += 1;
                self.contacts[i] = bridge.force;
            }
        }
        if self.collapsed {
            return;
        }
        let lower = bridge.utilisation.lower;
        if lower > self.utilisation.lower {
            self.moving = Some((index, vec![bridge.mechanism(self.structure, block)]));
        }
        if lower.is_infinite() {
            self.collapsed = true;
            return;
        }
        if lower > 0.0 && lower >= self.utilisation.lower * (1.0 - TIE) {
            self.candidates.push((lower, index, vec![1.0]));
        }
        self.utilisation = self.utilisation.max(bridge.utilisation);
    }

    /// Adds a block's answer, or keeps it until all are known where `question` is
    /// about more than the utilisation.
    fn take(&mut self, index: usize, part: Part, question: Question) {
        match part {
            Part::Stands { .. } if question == Question::Full => self.held.push((index, part)),
            Part::Stands { .. } | Part::Collapses { .. } => self.add(index, part),
        }
    }

    /// Chooses the fields of the blocks that were kept, and adds them.
    fn choose(&mut self, question: Question, loads: &[BodyLoad]) {
        if question != Question::Full || self.collapsed {
            return;
        }
        let mut held = std::mem::take(&mut self.held);
        self.distribution = distribution::choose(self.structure, self.blocks, loads, self.utilisation, &mut held);
        for (index, part) in held {
            self.add(index, part);
        }
    }

    fn add(&mut self, index: usize, part: Part) {
        if self.collapsed {
            return;
        }
        match part {
            Part::Collapses { mechanism, decided_by } => {
                self.decided_by = self.decided_by.max(decided_by);
                self.collapsed = true;
                self.moving = Some((index, mechanism));
            }
            Part::Stands {
                utilisation,
                wrenches,
                demands,
                mechanism,
                shares,
                undecided_because,
                decided_by,
                unproved: _,
            } => {
                self.decided_by = self.decided_by.max(decided_by);
                for ((&link, wrench), demand) in self.blocks[index].links.iter().zip(&wrenches).zip(demands) {
                    match link {
                        Link::Connection(i) => self.record(i, wrench, demand),
                        Link::Contact(i) => {
                            self.contacts[i] = LinkFrame::new(self.structure, link).axes * wrench.force;
                        }
                    }
                }
                if utilisation.lower > self.utilisation.lower {
                    self.moving = Some((index, mechanism));
                }
                self.candidates.push((utilisation.lower, index, shares));
                self.utilisation = self.utilisation.max(utilisation);
                self.undecided_because = self.undecided_because.take().or(undecided_because);
            }
        }
    }

    fn record(&mut self, connection: usize, wrench: &Wrench, utilisation: f64) {
        let rated = self.structure.connectors[self.structure.connections[connection].connector].strength;
        self.connections[connection] =
            ConnectionState { wrench: *wrench, strength: utilisation * rated, utilisation, critical: false };
    }

    /// Carries the moving block's motion on to what hangs from it: every block
    /// comes after the one that its root belongs to.
    fn spread(&mut self) {
        let moving = self.moving.take();
        for (index, block) in self.blocks.iter().enumerate() {
            if let Some((moved, twists)) = &moving
                && *moved == index
            {
                for (&body, twist) in block.bodies.iter().zip(twists) {
                    self.mechanism[body] = *twist;
                }
            } else if let Vertex::Body(root) = block.root {
                let (twist, com) = (self.mechanism[root], self.structure.bodies[root].com);
                for &body in &block.bodies {
                    self.mechanism[body] = twist.moved(&(self.structure.bodies[body].com - com));
                }
            }
        }
    }

    /// Marks the connections that break in the mechanisms of the largest utilisation.
    fn mark_critical(&mut self) {
        let largest = self.utilisation.lower;
        for (lower, index, shares) in &self.candidates {
            if largest > 0.0 && *lower >= largest * (1.0 - TIE) {
                for (&link, share) in self.blocks[*index].links.iter().zip(shares) {
                    if let Link::Connection(i) = link {
                        self.connections[i].critical = *share > CRITICAL_SHARE;
                    }
                }
            }
        }
    }

    fn finish(mut self) -> Assessment {
        if self.moving.is_some() {
            self.spread();
        }
        let verdict = if self.collapsed {
            self.utilisation = Bracket::exact(f64::INFINITY);
            Verdict::WholeBodyUnstable
        } else if self.utilisation.upper <= 1.0 {
            Verdict::Stable
        } else if self.utilisation.lower > 1.0 {
            Verdict::InternallyUnstable
        } else {
            Verdict::Undecided
        };
        if !self.collapsed {
            self.mark_critical();
        }
        let undecided_because = match verdict {
            Verdict::Undecided => {
                let Bracket { lower, upper } = self.utilisation;
                let cause = self.undecided_because.take();
                Some(cause.unwrap_or_else(|| format!("the bracket [{lower}, {upper}] straddles 1 within rounding")))
            }
            Verdict::Stable | Verdict::InternallyUnstable | Verdict::WholeBodyUnstable => None,
        };
        Assessment {
            verdict,
            utilisation: self.utilisation,
            connections: self.connections,
            contacts: self.contacts,
            distribution: self.distribution,
            mechanism: self.mechanism,
            left_out: self.left_out,
            undecided_because,
            decided_by: self.decided_by,
        }
    }
}
