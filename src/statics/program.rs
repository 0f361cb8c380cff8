//! A block's critical stable state as a second-order cone program in standard form.
//!
//! ```text
//! minimise t   subject to   A z = -L,   z in K
//! ```
//!
//! One wrench per connection, and it is itself the cone variable, shifted by the
//! preload: with every strength at its common bound `s_l = t S_l` a `cone`
//! connection has `(t S + f_z, f_x/mu_x, .., tau_z/rho_z)` in a Lorentz cone, a
//! `patch` has its points' forces in friction cones and `w = sum - t S e_z`, and
//! a limited component of a `box` has `t F + f >= 0` and `t F - f >= 0`. Rows
//! are six balances per body, and one per doubly limited box component that ties
//! its two slacks. The dual variable of a body's balance is its twist in the
//! collapse mechanism.
//!
//! Rows and columns are scaled to forces and levers of the bodies and links they
//! belong to (see `scales`).

use std::sync::{Arc, OnceLock};

use crate::spatial::{Twist, Vec3, Wrench};

use super::blocks::{Block, Link, Vertex};
use super::connector::Model;
use super::elimination::Pattern;
use super::frame::LinkFrame;
use super::groups::Group;
use super::loads::BodyLoad;
use super::maps::{Ends, Side, Sides};
use super::scales::Scales;
use super::structure::Structure;

/// What is asked of a block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Purpose {
    /// The least common utilisation t.
    Utilisation,
    /// Whether the loads can be held with strength without bound: t becomes the
    /// share of the loads that is left unheld, 0 or 1, and every connection may
    /// have any preload.
    Support,
}

/// The scaled program of one block.
pub(super) struct Program {
    pub purpose: Purpose,
    pub groups: Vec<Group>,
    /// Number of variables, t not among them.
    pub variables: usize,
    /// The ends of each link, and the bodies there.
    pub sides: Vec<Sides>,
    pub ends: Vec<Ends>,
    /// Scaled column of t, by row.
    pub preload: Vec<f64>,
    /// Wrench in each link's frame that t = 1 stands for (minus the preload).
    pub preload_local: Vec<Wrench>,
    /// The same of what links hold whatever t is.
    pub held_local: Vec<Wrench>,
    /// Scaled load per row (right-hand side is its negative).
    pub load: Vec<f64>,
    /// Row factors: scaled row = factor times row in N or N m.
    pub row_factor: Vec<f64>,
    /// The utilisation that a scaled t of 1 stands for.
    pub t_scale: f64,
    pub scales: Scales,
    pub frames: Vec<LinkFrame>,
    /// Centre of mass of each of the block's bodies in W.
    pub coms: Vec<Vec3>,
    /// Whether each link may be part of a chain: if it is strong enough, it holds its
    /// two bodies to each other in every direction, and its flexibility is known to
    /// the last digits (that of a face is the inverse of a sum over its points).
    pub in_series: Vec<bool>,
    /// Share of its strength that each link may use.
    pub shares: Vec<f64>,
    /// Whether that is so whatever t is.
    pub held: Vec<bool>,
    /// Found when it is first asked for.
    pattern: OnceLock<Arc<Pattern>>,
}

/// Smallest force scale of a body, relative to the largest: a body without weight
/// still needs one.
const FLOOR: f64 = 1e-9;

impl Program {
    /// The program scaled to each body's own forces, however small.
    pub(super) fn new(structure: &Structure, block: &Block, loads: &[BodyLoad], purpose: Purpose) -> Self {
        Self::with_floor(structure, block, loads, purpose, FLOOR)
    }

    /// The program with no body's force scale below `floor` times the largest.
    pub(super) fn with_floor(
        structure: &Structure,
        block: &Block,
        loads: &[BodyLoad],
        purpose: Purpose,
        floor: f64,
    ) -> Self {
        Self { purpose, ..Self::unstated(structure, block, loads, floor) }.stated(structure, block)
    }

    /// The program in which each link may use a share of its strength only: what it
    /// proves possible is possible.
    pub(super) fn with_shares(structure: &Structure, block: &Block, loads: &[BodyLoad], shares: Vec<f64>) -> Self {
        Self { shares, ..Self::unstated(structure, block, loads, FLOOR) }.stated(structure, block)
    }

    /// The program of the least utilisation of all connections but those that are held at a
    /// utilisation. Its rows of ties have a right-hand side: only the general solver takes it.
    pub(super) fn with_held(structure: &Structure, block: &Block, loads: &[BodyLoad], levels: &[Option<f64>]) -> Self {
        let unstated = Self::unstated(structure, block, loads, FLOOR);
        let held = levels.iter().map(Option::is_some).collect();
        let shares = levels.iter().map(|level| level.unwrap_or(1.0)).collect();
        Self { held, shares, ..unstated }.stated(structure, block)
    }

    /// The program of the largest factor on `loads` that the block stands beside `base` with
    /// every strength at `limit` times the rated one, measured by `typical` loads.
    ///
    /// Divided by the factor, it is one of the least utilisation: with the scaled t for 1 over
    /// the factor, the block holds `loads` and t times `base` with t times the strengths.
    pub(super) fn of_factor(
        structure: &Structure,
        block: &Block,
        [base, loads, typical]: [&[BodyLoad]; 3],
        limit: f64,
    ) -> Self {
        let unstated = Self::unstated(structure, block, typical, FLOOR);
        let (load, preload) = (scaled(block, loads, &unstated.row_factor), scaled(block, base, &unstated.row_factor));
        let mut program = Self { load, preload, t_scale: limit, ..unstated };
        for (index, &link) in block.links.iter().enumerate() {
            program.add_link(structure, index, link);
        }
        program
    }

    /// With the variables of every link.
    fn stated(self, structure: &Structure, block: &Block) -> Self {
        let mut program = self;
        match program.purpose {
            Purpose::Utilisation => program.t_scale = program.typical_utilisation(structure, block),
            Purpose::Support => program.preload = program.load.iter().map(|load| -load).collect(),
        }
        for (index, &link) in block.links.iter().enumerate() {
            program.add_link(structure, index, link);
        }
        program
    }

    /// Frames, scales and loads without any variable: what evaluating bounds takes.
    pub(super) fn unstated(structure: &Structure, block: &Block, loads: &[BodyLoad], floor: f64) -> Self {
        let frames: Vec<LinkFrame> = block.links.iter().map(|&link| LinkFrame::new(structure, link)).collect();
        let ends: Vec<Ends> =
            frames.iter().map(|frame| [local_body(block, frame.plus), local_body(block, frame.minus)]).collect();
        let coms: Vec<Vec3> = block.bodies.iter().map(|&body| structure.bodies[body].com).collect();
        let scales = Scales::new(block, &coms, &frames, &ends, loads, floor);
        let mut row_factor = Vec::with_capacity(6 * block.bodies.len());
        for (force, lever) in scales.force.iter().zip(&scales.lever) {
            let (force, torque) = (1.0 / force, 1.0 / (force * lever));
            row_factor.extend([force, force, force, torque, torque, torque]);
        }
        let load = scaled(block, loads, &row_factor);
        let mut sides: Vec<Sides> = Vec::with_capacity(frames.len());
        for (frame, &[plus, minus]) in frames.iter().zip(&ends) {
            let side = |end: Option<usize>, sign: f64| {
                end.map(|i| Side::new(frame, i, sign, &coms[i], [row_factor[6 * i], row_factor[6 * i + 3]]))
            };
            sides.push([side(plus, 1.0), side(minus, -1.0)]);
        }
        let in_series = block.links.iter().map(|&link| match link {
            Link::Connection(i) => match &structure.connectors[structure.connections[i].connector].model {
                Model::Patch { .. } => false,
                model @ (Model::Cone { .. } | Model::Box { .. }) => model.is_rigid(),
            },
            Link::Contact(_) => false,
        });
        let in_series = in_series.collect();
        Self {
            purpose: Purpose::Utilisation,
            groups: Vec::new(),
            variables: 0,
            sides,
            ends,
            preload: vec![0.0; load.len()],
            preload_local: vec![Wrench::ZERO; block.links.len()],
            held_local: vec![Wrench::ZERO; block.links.len()],
            load,
            row_factor,
            t_scale: 1.0,
            scales,
            frames,
            coms,
            in_series,
            shares: vec![1.0; block.links.len()],
            held: vec![false; block.links.len()],
            pattern: OnceLock::new(),
        }
    }

    /// Where the blocks of matrices on the bodies are, of which links join two each.
    pub(super) fn pattern(&self) -> &Arc<Pattern> {
        self.pattern.get_or_init(|| Arc::new(Pattern::new(self.coms.len(), self.joined())))
    }

    /// Takes over the pattern of a block of the same bodies, if it has all that this one needs.
    pub(super) fn take_pattern(&self, pattern: &Arc<Pattern>) {
        if pattern.bodies() == self.coms.len() && self.joined().all(|(i, j)| pattern.joins(i, j)) {
            self.pattern.get_or_init(|| pattern.clone());
        }
    }

    /// The pairs of bodies that links join.
    fn joined(&self) -> impl Iterator<Item = (usize, usize)> {
        self.ends.iter().filter_map(|&[one, other]| Some((one?, other?)))
    }

    pub(super) fn rows(&self) -> usize {
        self.load.len()
    }

    /// The twist of every body, of its centre of mass in W, that scaled dual
    /// variables stand for, in units of 1 W of dissipation at t = 1.
    pub(super) fn twists(&self, v: &[f64]) -> Vec<Twist> {
        let bodies = 0..self.scales.force.len();
        let unscaled = |i: usize, k: usize| v[6 * i + k] * self.row_factor[6 * i + k] * self.t_scale;
        let part = |i: usize, from: usize| Vec3::from_fn(|k, _| unscaled(i, from + k));
        bodies.map(|i| Twist::new(part(i, 0), part(i, 3))).collect()
    }

    /// What every body lacks for balance, about its centre of mass in W, under `loads` by the
    /// structure's bodies and with a wrench per link in its frame.
    pub(super) fn residuals(&self, block: &Block, loads: &[BodyLoad], field: &[Wrench]) -> Vec<Wrench> {
        let mut lacking: Vec<Wrench> = block.bodies.iter().map(|&body| loads[body].wrench).collect();
        self.push(field, &mut lacking);
        lacking
    }

    /// Adds what the links push the bodies with, about their centres of mass in W, to `bodies`.
    pub(super) fn push(&self, field: &[Wrench], bodies: &mut [Wrench]) {
        for ((frame, &[plus, minus]), wrench) in self.frames.iter().zip(&self.ends).zip(field) {
            let here = frame.in_world(wrench);
            if let Some(i) = plus {
                bodies[i] += here.moved(&(frame.origin - self.coms[i]));
            }
            if let Some(i) = minus {
                bodies[i] -= here.moved(&(frame.origin - self.coms[i]));
            }
        }
    }

    /// The twist of a link's plus side relative to its minus side, in its frame, of a twist per
    /// body of the block, of its centre of mass in W. What is not in the block rests.
    pub(super) fn relative_twist(&self, link: usize, twists: &[Twist]) -> Twist {
        let frame = &self.frames[link];
        frame.apart(self.ends[link].map(|end| end.map(|i| twists[i].moved(&(frame.origin - self.coms[i])))))
    }

    /// Largest of force over strength: about the utilisation to expect.
    fn typical_utilisation(&self, structure: &Structure, block: &Block) -> f64 {
        let ratios = block.links.iter().zip(&self.scales.link).filter_map(|(link, force)| match link {
            Link::Connection(i) => {
                let connector = &structure.connectors[structure.connections[*i].connector];
                Some(force * leverage(&connector.model) / connector.strength)
            }
            Link::Contact(_) => None,
        });
        let largest = ratios.fold(0.0, f64::max);
        if largest > 0.0 { largest } else { 1.0 }
    }

    /// Longest lever of a link's bodies.
    pub(super) fn lever_of(&self, link: usize) -> f64 {
        self.sides[link].iter().flatten().map(|side| self.scales.lever[side.body]).fold(0.0, f64::max)
    }

    /// The column of A of a group's variable `k`, as `(row, entry)`.
    pub(super) fn entries(&self, group: &Group, k: usize) -> Vec<(usize, f64)> {
        let mut unit = [0.0; 6];
        unit[k] = 1.0;
        let mut wrench = [0.0; 6];
        group.add_wrench(&unit[..group.len], &mut wrench);
        let mut entries = Vec::with_capacity(13);
        for side in self.sides[group.link].iter().flatten() {
            let values = side.map * nalgebra::Vector6::from(wrench);
            entries.extend(values.iter().enumerate().map(|(row, value)| (6 * side.body + row, *value)));
        }
        entries.extend(group.tie_row.map(|row| (row, 1.0)));
        entries.retain(|entry| entry.1 != 0.0);
        entries
    }
}

/// The loads of a block's bodies by row, scaled.
fn scaled(block: &Block, loads: &[BodyLoad], row_factor: &[f64]) -> Vec<f64> {
    let wrenches = block.bodies.iter().map(|&body| loads[body].wrench);
    let rows = wrenches.flat_map(|Wrench { force: f, torque: m }| [f.x, f.y, f.z, m.x, m.y, m.z]);
    rows.zip(row_factor).map(|(load, factor)| load * factor).collect()
}

/// By how much a force sideways demands more of a connector than one along it, where
/// that is far more.
fn leverage(model: &Model) -> f64 {
    const ORDINARY: f64 = 0.1;
    match model {
        Model::Cone { friction: [a, b], .. } => (ORDINARY / a.min(*b)).max(1.0),
        Model::Patch { friction, .. } if *friction > 0.0 => (ORDINARY / friction).max(1.0),
        Model::Box { .. } | Model::Patch { .. } => 1.0,
    }
}

/// Index within the block of a vertex that needs balance there.
pub(super) fn local_body(block: &Block, vertex: Vertex) -> Option<usize> {
    match vertex {
        Vertex::Body(i) if vertex != block.root => block.bodies.binary_search(&i).ok(),
        _ => None,
    }
}
