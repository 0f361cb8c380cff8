//! What is remembered of a neighbour, laid out for this structure.

use std::sync::Arc;

use crate::spatial::{Twist, Vec3, Wrench};

use super::super::assess::Knowledge;
use super::super::assessment::{Assessment, Question};
use super::super::blocks::{Block, Link, Vertex, ends};
use super::super::bracket::Problem;
use super::super::frame::LinkFrame;
use super::super::loads::BodyLoad;
use super::super::part::Part;
use super::super::program::Program;
use super::super::structure::Structure;
use super::field::face;
use super::ladder::{Ladder, Sprung};
use super::memory::{Held, Known, Memory, Springs, idle_links};

/// Smallest force scale relative to the largest, as for a solve.
const FLOOR: f64 = 1e-9;

/// Carried fields, replaced by those of the answers as these are found.
pub(super) struct Carried<'s> {
    structure: &'s Structure,
    question: Question,
    /// Whether there is anything to carry.
    any: bool,
    /// Whether the neighbour fell, so that this one is likely to.
    falls: bool,
    /// The neighbour, and its bodies that are those of this structure.
    near: Option<(&'s Memory, &'s [Option<usize>])>,
    links: Vec<Held>,
    /// Which of the neighbour's links each was.
    known_as: Vec<Option<usize>>,
    /// The springs of this structure's blocks.
    springs: Vec<Springs>,
    /// Twists of the neighbour's bodies in W; `None` where a body was not there.
    before: Vec<Option<Twist>>,
    /// Twists relative to the root of each body's block, where they are known.
    relative: Vec<Option<Twist>>,
    twists: Vec<Twist>,
}

impl<'s> Carried<'s> {
    /// For a structure without a known neighbour.
    pub(super) fn nothing(structure: &'s Structure, question: Question) -> Self {
        let bodies = structure.bodies.len();
        Self {
            structure,
            question,
            any: false,
            falls: false,
            near: None,
            links: idle_links(structure),
            known_as: Vec::new(),
            springs: Vec::new(),
            before: vec![None; bodies],
            relative: vec![None; bodies],
            twists: vec![Twist::ZERO; bodies],
        }
    }

    /// `matching` must fit `memory`.
    pub(super) fn new(
        structure: &'s Structure,
        question: Question,
        memory: &'s Memory,
        matching: &'s [Option<usize>],
    ) -> Self {
        let bodies = structure.bodies.len();
        let threshold = match question {
            Question::Decide(threshold) => threshold,
            Question::ToGap(_) | Question::Full => 1.0,
        };
        let (links, known_as) = memory.links(structure, matching);
        Self {
            structure,
            question,
            // Fields of a state that no strength holds say nothing about strength.
            any: memory.utilisation.lower < f64::INFINITY,
            falls: memory.utilisation.lower > threshold,
            near: Some((memory, matching)),
            links,
            known_as,
            springs: Vec::new(),
            before: memory.twists(structure, matching),
            relative: vec![None; bodies],
            twists: vec![Twist::ZERO; bodies],
        }
    }

    /// What a neighbour of this structure can use, now that it is answered.
    pub(super) fn into_memory(mut self, answer: &Assessment) -> Memory {
        self.springs.sort_unstable_by_key(|springs| springs.bodies[0]);
        let bodies = self.structure.bodies.iter().zip(&self.twists);
        let bodies = bodies.map(|(body, twist)| Known { com: body.com, twist: *twist }).collect();
        Memory { utilisation: answer.utilisation, bodies, links: self.links, springs: self.springs }
    }

    fn slot(&self, link: Link) -> usize {
        match link {
            Link::Connection(i) => i,
            Link::Contact(i) => self.structure.connections.len() + i,
        }
    }

    /// Takes note of the forces at the points of a block's faces, which may be unknown.
    fn remember(&mut self, block: &Block, mut points: &[Vec3]) {
        for &link in &block.links {
            if let Some(face) = face(self.structure, link) {
                let own = points.split_off(..face.points.len().min(points.len())).unwrap_or_default();
                let (axes, slot) = (LinkFrame::new(self.structure, link).axes, self.slot(link));
                self.links[slot].points = own.iter().map(|force| axes * force).collect();
            }
        }
    }

    /// The springs that balanced a block of the same bodies, where all of its links are still there.
    fn remembered(&self, block: &Block) -> Option<Springs> {
        let (memory, matching) = self.near?;
        let before: Option<Vec<usize>> = block.bodies.iter().map(|&body| matching[body]).collect();
        let known = memory.springs(&before?)?;
        let mut links = Vec::with_capacity(known.links.len());
        for &link in &block.links {
            let slot = self.slot(link);
            let own = self.known_as[slot].and_then(|was| known.links.binary_search_by_key(&was, |link| link.0).ok());
            links.extend(own.map(|own| (slot, known.links[own].1)));
        }
        let complete = links.len() == known.links.len();
        complete.then(|| Springs { bodies: block.bodies.to_vec(), links, give: known.give.clone() })
    }

    /// The number of each link's spring, if it has one.
    fn numbers(&self, block: &Block, springs: &Springs) -> Vec<Option<usize>> {
        let number = |&link: &Link| {
            let own = springs.links.binary_search_by_key(&self.slot(link), |link| link.0);
            own.ok().map(|own| springs.links[own].1)
        };
        block.links.iter().map(number).collect()
    }

    /// Takes note of a link's wrench in its frame.
    fn keep(&mut self, link: Link, wrench: &Wrench) {
        let (axes, slot) = (LinkFrame::new(self.structure, link).axes, self.slot(link));
        self.links[slot].wrench = Wrench::new(axes * wrench.force, axes * wrench.torque);
    }

    /// The motion of a block's root and where it is.
    fn root(&self, block: &Block, twist: impl Fn(usize) -> Twist) -> (Twist, Vec3) {
        match block.root {
            Vertex::Ground => (Twist::ZERO, Vec3::zeros()),
            Vertex::Body(i) => (twist(i), self.structure.bodies[i].com),
        }
    }

    /// The carried twists of a block's bodies relative to its root; `None` when
    /// nothing moves.
    fn motion(&self, block: &Block) -> Option<Vec<Twist>> {
        let (root, at) = self.root(block, |i| self.before[i].unwrap_or(Twist::ZERO));
        let mut twists: Vec<Option<Twist>> = Vec::with_capacity(block.bodies.len());
        for &body in &block.bodies {
            let with = root.moved(&(self.structure.bodies[body].com - at));
            twists.push(self.before[body].map(|v| Twist::new(v.linear - with.linear, v.angular - with.angular)));
        }
        self.move_with_neighbours(block, &mut twists);
        let twists: Vec<Twist> = twists.into_iter().map(|twist| twist.unwrap_or(Twist::ZERO)).collect();
        twists.iter().any(|twist| *twist != Twist::ZERO).then_some(twists)
    }

    /// Lets a body that was not there move with one that it is linked to.
    fn move_with_neighbours(&self, block: &Block, twists: &mut [Option<Twist>]) {
        let mut unknown = twists.iter().filter(|twist| twist.is_none()).count();
        while unknown > 0 {
            let left = unknown;
            for &link in &block.links {
                let local = ends(self.structure, link).map(|end| match end {
                    Vertex::Body(i) if end != block.root => block.bodies.binary_search(&i).ok(),
                    _ => None,
                });
                for (from, to) in [(local[0], local[1]), (local[1], local[0])] {
                    if let (Some(to), None) = (to, to.and_then(|to| twists[to])) {
                        let arm = |i: usize| {
                            let com = |local: usize| self.structure.bodies[block.bodies[local]].com;
                            com(to) - com(i)
                        };
                        let host = from.map_or(Some(Twist::ZERO), |from| Some(twists[from]?.moved(&arm(from))));
                        if host.is_some() {
                            twists[to] = host;
                            unknown -= 1;
                        }
                    }
                }
            }
            if unknown == left {
                break;
            }
        }
    }
}

impl Knowledge for Carried<'_> {
    fn bound(&mut self, structure: &Structure, block: &Block, loads: &[BodyLoad]) -> Option<Part> {
        if !self.any || block.bodies.iter().all(|&body| loads[body].is_zero()) {
            return None;
        }
        let program = Program::unstated(structure, block, loads, FLOOR);
        let in_frame = |(&link, frame): (&Link, &LinkFrame)| {
            let wrench = &self.links[self.slot(link)].wrench;
            Wrench::new(frame.axes.tr_mul(&wrench.force), frame.axes.tr_mul(&wrench.torque))
        };
        let field = block.links.iter().zip(&program.frames).map(in_frame).collect();
        let problem = Problem { structure, block, loads, program: &program };
        let known = |link: Link| {
            let axes = LinkFrame::new(structure, link).axes;
            self.links[self.slot(link)].points.iter().map(|force| axes.tr_mul(force)).collect()
        };
        let remembered = self.remembered(block);
        if let Some(springs) = &remembered {
            springs.give.lend_pattern(&program);
        }
        let sprung =
            remembered.as_ref().map(|springs| Sprung { give: &springs.give, springs: self.numbers(block, springs) });
        let climbed = Ladder::new(problem, self.question).climb(self.motion(block), field, known, self.falls, sprung);
        let renewed = climbed.give.map(|give| Springs {
            bodies: block.bodies.to_vec(),
            links: block.links.iter().enumerate().map(|(l, &link)| (self.slot(link), l)).collect(),
            give: Arc::new(give),
        });
        self.springs.extend(renewed.or(remembered));
        // A solver's wrenches are shared in another way.
        self.remember(block, if climbed.part.answers(self.question, 0.0) { &climbed.points } else { &[] });
        Some(climbed.part)
    }

    fn note_bridge(&mut self, link: Link, wrench: &Wrench) {
        self.keep(link, wrench);
    }

    fn note(&mut self, block: &Block, part: &Part) {
        let (mechanism, wrenches) = match part {
            Part::Collapses { mechanism, .. } => (Some(mechanism), None),
            Part::Stands { utilisation, mechanism, wrenches, unproved, .. } => {
                let (proposed, moving) = unproved.as_ref().map_or((None, None), |(w, v)| (Some(w), Some(v)));
                (
                    if utilisation.lower > 0.0 { Some(mechanism) } else { moving },
                    if utilisation.upper.is_finite() { Some(wrenches) } else { proposed },
                )
            }
        };
        for (&body, twist) in block.bodies.iter().zip(mechanism.into_iter().flatten()) {
            self.relative[body] = Some(*twist);
        }
        for (&link, wrench) in block.links.iter().zip(wrenches.into_iter().flatten()) {
            self.keep(link, wrench);
        }
    }

    fn close(&mut self, blocks: &[Block]) {
        for block in blocks {
            let silent = block.links.len() > 1 && block.bodies.iter().any(|&body| self.relative[body].is_none());
            let carried = if silent { self.motion(block) } else { None };
            let (root, at) = self.root(block, |i| self.twists[i]);
            for (k, &body) in block.bodies.iter().enumerate() {
                let with = root.moved(&(self.structure.bodies[body].com - at));
                let own = self.relative[body].or_else(|| Some(carried.as_ref()?[k])).unwrap_or(Twist::ZERO);
                self.twists[body] = Twist::new(with.linear + own.linear, with.angular + own.angular);
            }
        }
    }
}
