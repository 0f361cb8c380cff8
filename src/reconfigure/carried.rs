//! Whether the others carry a module through a whole move: one proof for all its states, where the module hangs on one
//! of them at a time ([`hanging`](super::hanging)), or slides along several that share its weight ([`shares`](super::shares)).
//!
//! What a move needs of those around it is the same wherever they look alike, and what the others carry is the same
//! wherever the module is. So most moves of a search are decided by what was found for those before them.
//!
//! Proves that a margin is large enough; that it is not, it never says.

use std::collections::{HashMap, VecDeque};

use crate::robot::{Cell, Occupancy};

use super::assembly::Engagement;
use super::course::engagement;
use super::domain::Domain;
use super::hanging::{Reach, Rest, Rests};
use super::large::{Ways, shift};
use super::layout::{Layout, displaced};
use super::moves::Move;
use super::shares::Slides;

/// Modules that all rests together may have.
const MODULES: usize = 1 << 12;

/// About what a rest takes for each module, in bytes: its bodies, contacts and connections, and its memory.
const BYTES: usize = 6144;

/// All modules of a layout but one, with the class of that one.
type Others = (Layout, u16);

/// What was found about carrying modules of one robot. What is kept depends on what is asked, never on time: searches ask
/// from one thread.
pub struct Carried<'a> {
    domain: &'a Domain<'a>,
    slides: Slides,
    ways: Ways<'a>,
    rests: Rests<'a>,
    kept: HashMap<Others, (Occupancy, Rest)>,
    /// In the order in which they came.
    order: VecDeque<Others>,
}

impl<'a> Carried<'a> {
    /// Nothing yet, about the modules of a domain.
    pub fn new(domain: &'a Domain<'a>) -> Self {
        let rests = Rests::new(domain.problem.start());
        Self {
            domain,
            slides: Slides::default(),
            ways: Ways::new(domain),
            rests,
            kept: HashMap::new(),
            order: VecDeque::new(),
        }
    }

    /// Proved lower bound, at least `floor`, on the margin of a move out of a layout in which all that touch are connected:
    /// on that of all its samples, of the state at rest that it begins in with the module's other connections released, and of
    /// the one that it ends in. `None` where this proves less.
    ///
    /// The module's own hold is found on samples of its own, the worst of them refined; what the others carry, between
    /// them too.
    pub fn margin(&mut self, layout: &Layout, step: Move, floor: f64) -> Option<f64> {
        let domain = self.domain;
        let margin = domain.oracle.timed(|| self.prove(layout, step, floor));
        domain.oracle.add(&self.rests.take_tally());
        margin
    }

    fn prove(&mut self, layout: &Layout, step: Move, floor: f64) -> Option<f64> {
        let moving = layout.placed()[layout.at(step.from)?];
        let rest = Layout::new(layout.placed().iter().copied().filter(|placed| placed.cell != step.from).collect());
        let (own, reaches) = self.hold(&rest, moving.class, step)?;
        if !(own >= floor) {
            return None;
        }
        let others = (rest, moving.class);
        if !self.kept.contains_key(&others) {
            self.keep(&others, layout, step);
        }
        let (occupancy, rest) = self.kept.get_mut(&others)?;
        let by = shift(step.from, self.domain.problem.start().pitch());
        let mut supports = Vec::with_capacity(reaches.len());
        for (support, reach) in reaches {
            supports.push((occupancy.at(displaced(support, step.from))?, reach.moved(&by)));
        }
        let most = self.rests.utilisations(rest, &supports, 1.0 - floor).ok()?;
        let margin = most.iter().map(|most| 1.0 - most).fold(own, f64::min);
        (margin >= floor).then_some(margin)
    }

    /// Margin of what holds the module of a move over `rest`, and where its weight acts on which modules, from the cell that
    /// the move leaves.
    fn hold(&mut self, rest: &Layout, class: u16, step: Move) -> Option<(f64, Vec<(Cell, Reach)>)> {
        if let Some(slide) = self.slides.of(self.domain.problem, rest, class, step) {
            return Some((slide.margin, slide.reaches.clone()));
        }
        let way = self.ways.of(rest, class, step)?;
        Some((way.margin.lower, way.reaches.clone()))
    }

    /// Keeps all modules but the one that moves; the oldest are forgotten.
    fn keep(&mut self, others: &Others, layout: &Layout, step: Move) {
        let placements = self.domain.problem.placements(layout);
        let occupancy = Occupancy::of_placements(&placements);
        let Some(module) = occupancy.at(step.from) else { return };
        let (rest, _) = others;
        let engaged: Vec<Engagement> =
            rest.touching().into_iter().filter_map(|bond| engagement(&occupancy, bond)).collect();
        let rest = self.rests.without(module, &placements, &engaged);
        self.kept.insert(others.clone(), (occupancy, rest));
        self.order.push_back(others.clone());
        while self.order.len() > 1 && self.order.len() * placements.len() > MODULES {
            if let Some(oldest) = self.order.pop_front() {
                self.kept.remove(&oldest);
            }
        }
    }

    /// Approximate memory, in bytes.
    pub fn bytes(&self) -> usize {
        self.slides.bytes() + self.order.front().map_or(0, |(rest, _)| self.order.len() * rest.placed().len() * BYTES)
    }
}
