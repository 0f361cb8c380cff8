//! The answers of a structure's blocks, put together.

use crate::spatial::{Twist, Vec3, Wrench};

use super::assessment::{Assessment, Bracket, ConnectionState, Distribution, LeftOut, Question, Verdict};
use super::blocks::{Block, Link, Vertex, short};
use super::closed_form::Bridge;
use super::distribution;
use super::frame::LinkFrame;
use super::loads::BodyLoad;
use super::part::Part;
use super::rung::Rung;
use super::structure::{Body, Structure};
use super::tolerances::{CRITICAL_SHARE, TIE};

/// The answers of the blocks, put together.
pub(super) struct Answer<'s> {
    structure: &'s Structure,
    blocks: &'s [Block],
    utilisation: Bracket,
    collapsed: bool,
    connections: Vec<ConnectionState>,
    contacts: Vec<Vec3>,
    /// The bodies of the block whose mechanism proves the lower bound, each with its twist.
    moving: Vec<(usize, Twist)>,
    /// The first block that may hang from them.
    behind: usize,
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
    pub(super) fn new(structure: &'s Structure, blocks: &'s [Block]) -> Self {
        let idle = ConnectionState { wrench: Wrench::ZERO, strength: 0.0, utilisation: 0.0, critical: false };
        Self {
            structure,
            blocks,
            utilisation: Bracket::exact(0.0),
            collapsed: false,
            connections: vec![idle; structure.connections.len()],
            contacts: vec![Vec3::zeros(); structure.contacts.len()],
            moving: Vec::new(),
            behind: 0,
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

    pub(super) fn count_solved(&mut self, block: &Block) {
        self.left_out.solved_blocks += 1;
        self.left_out.largest_block_bodies = self.left_out.largest_block_bodies.max(block.bodies.len());
    }

    /// What the structure needs at least, as far as is known.
    pub(super) fn at_least(&self) -> f64 {
        self.utilisation.lower
    }

    /// Whether the blocks so far answer the question for the whole.
    pub(super) fn settled(&self, question: Question) -> bool {
        self.collapsed
            || match question {
                Question::Decide(threshold) => self.utilisation.lower > threshold,
                Question::ToGap(_) | Question::Full => false,
            }
    }

    /// Leaves the other blocks unanswered: one of them may need more, or fall.
    pub(super) fn stop(&mut self) {
        self.utilisation.upper = f64::INFINITY;
        self.undecided_because = Some("the threshold is exceeded, the rest was not asked for".to_owned());
    }

    pub(super) fn collapse_afloat(&mut self, root: usize, twist: Twist) {
        self.collapsed = true;
        self.moving = vec![(root, twist)];
        self.behind = 0;
    }

    /// Adds what was found out about the only link of block `index`.
    pub(super) fn add_bridge(&mut self, index: usize, bridge: &Bridge) {
        match bridge.link {
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
            self.moving = vec![(bridge.body, bridge.mechanism(self.structure))];
            self.behind = index + 1;
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
    pub(super) fn take(&mut self, index: usize, part: Part, question: Question) {
        match part {
            Part::Stands { .. } if question == Question::Full => self.held.push((index, part)),
            Part::Stands { .. } | Part::Collapses { .. } => self.add(index, part),
        }
    }

    /// Chooses the fields of the blocks that were kept, and adds them.
    pub(super) fn choose(&mut self, question: Question, loads: &[BodyLoad]) {
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
                self.move_block(index, &mechanism);
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
                    self.move_block(index, &mechanism);
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

    /// Notes the motion of a block that proves the most so far, a twist per body.
    fn move_block(&mut self, index: usize, twists: &[Twist]) {
        self.moving = self.blocks[index].bodies.iter().copied().zip(twists.iter().copied()).collect();
        self.behind = index + 1;
    }

    /// The motion of all bodies. What hangs from a body that moves, moves with it as one: every
    /// block comes after the one that its root belongs to.
    fn mechanism(&self) -> Vec<Twist> {
        const AT_REST: u32 = u32::MAX;
        let bodies = &self.structure.bodies;
        if self.moving.is_empty() {
            return vec![Twist::ZERO; bodies.len()];
        }
        // Whom it moves with first, by short numbers, since blocks are in no order of the bodies.
        let mut with = vec![AT_REST; bodies.len()];
        for (number, (body, _)) in self.moving.iter().enumerate() {
            with[*body] = short(number);
        }
        for block in &self.blocks[self.behind..] {
            if let Vertex::Body(root) = block.root
                && with[root] != AT_REST
            {
                for &body in &block.bodies {
                    with[body] = with[root];
                }
            }
        }
        let twist = |(body, with): (&Body, u32)| match self.moving.get(with as usize) {
            Some((mover, twist)) => twist.moved(&(body.com - bodies[*mover].com)),
            None => Twist::ZERO,
        };
        bodies.iter().zip(with).map(twist).collect()
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

    pub(super) fn finish(mut self) -> Assessment {
        let mechanism = self.mechanism();
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
            mechanism,
            left_out: self.left_out,
            undecided_because,
            decided_by: self.decided_by,
        }
    }
}
