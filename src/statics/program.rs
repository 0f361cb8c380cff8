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

use crate::spatial::{Twist, Vec3, Wrench};

use super::blocks::{Block, Link, Vertex};
use super::connector::Model;
use super::frame::LinkFrame;
use super::groups::{Cone, Form, Group};
use super::loads::BodyLoad;
use super::maps::{Side, Sides};
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
    /// The ends of each link.
    pub sides: Vec<Sides>,
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
    shares: Vec<f64>,
    /// Whether that is so whatever t is.
    held: Vec<bool>,
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
        let scales = Scales::new(structure, block, &frames, loads, floor);
        let mut row_factor = Vec::with_capacity(6 * block.bodies.len());
        for (force, lever) in scales.force.iter().zip(&scales.lever) {
            let (force, torque) = (1.0 / force, 1.0 / (force * lever));
            row_factor.extend([force, force, force, torque, torque, torque]);
        }
        let load = scaled(block, loads, &row_factor);
        let sides = frames
            .iter()
            .map(|frame| {
                frame.sides().map(|(side, sign)| {
                    let i = local_body(block, side)?;
                    let com = &structure.bodies[block.bodies[i]].com;
                    Some(Side::new(frame, i, sign, com, [row_factor[6 * i], row_factor[6 * i + 3]]))
                })
            })
            .collect();
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
            preload: vec![0.0; load.len()],
            preload_local: vec![Wrench::ZERO; block.links.len()],
            held_local: vec![Wrench::ZERO; block.links.len()],
            load,
            row_factor,
            t_scale: 1.0,
            scales,
            frames,
            coms: block.bodies.iter().map(|&body| structure.bodies[body].com).collect(),
            in_series,
            shares: vec![1.0; block.links.len()],
            held: vec![false; block.links.len()],
        }
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

    fn add_link(&mut self, structure: &Structure, index: usize, link: Link) {
        let (force, share) = (self.scales.link[index], self.shares[index]);
        match link {
            Link::Contact(i) => {
                self.add_friction_cone(index, structure.contacts[i].friction, [0.0; 2], force);
            }
            Link::Connection(i) => {
                let connector = &structure.connectors[structure.connections[i].connector];
                let strength = connector.strength * share;
                match &connector.model {
                    Model::Cone { friction: [a, b], radius: [c, d, e] } => {
                        let axes = [(2, 1.0), (0, *a), (1, *b), (3, *c), (4, *d), (5, *e)];
                        self.add_group(index, Cone::Lorentz, Form::Axes(axes), 6, force);
                        self.rest_at(strength);
                        self.add_preload(index, Wrench::new(-Vec3::z() * strength, Vec3::zeros()));
                    }
                    Model::Patch { friction, points } => {
                        for &point in points {
                            self.add_friction_cone(index, *friction, point, force);
                            self.rest_at(strength / points.len() as f64);
                        }
                        self.add_preload(index, Wrench::new(-Vec3::z() * strength, Vec3::zeros()));
                    }
                    Model::Box { shear, tension, compression, bending, torsion } => {
                        let limits = [
                            (shear[0], shear[0]),
                            (shear[1], shear[1]),
                            (*tension, *compression),
                            (bending[0], bending[0]),
                            (bending[1], bending[1]),
                            (*torsion, *torsion),
                        ];
                        self.add_box(index, &limits.map(|(opening, closing)| (opening * share, closing * share)));
                    }
                }
            }
        }
    }

    /// The force of one contact point in the plane z = 0 of the link's frame.
    fn add_friction_cone(&mut self, link: usize, friction: f64, at: [f64; 2], scale: f64) {
        let form = Form::Point { at, friction };
        if friction > 0.0 {
            self.add_group(link, Cone::Lorentz, form, 3, scale);
        } else {
            self.add_group(link, Cone::NonNegative, form, 1, scale);
        }
    }

    fn add_box(&mut self, link: usize, limits: &[(f64, f64); 6]) {
        let lever = self.lever_of(link);
        let mut preload = [0.0; 6];
        for (component, &(negative, positive)) in limits.iter().enumerate() {
            let scale = self.scales.link[link] * if component < 3 { 1.0 } else { lever };
            let along = |factor| Form::Axes([(component, factor); 6]);
            match (negative.is_finite(), positive.is_finite()) {
                (false, false) => {
                    self.add_group(link, Cone::Free, along(1.0), 1, scale);
                }
                (true, false) => {
                    self.add_group(link, Cone::NonNegative, along(1.0), 1, scale);
                    self.rest_at(negative);
                    preload[component] -= negative;
                }
                (false, true) => {
                    self.add_group(link, Cone::NonNegative, along(-1.0), 1, scale);
                    self.rest_at(positive);
                    preload[component] += positive;
                }
                (true, true) if negative == 0.0 && positive == 0.0 => {}
                (true, true) => {
                    let slack = self.add_group(link, Cone::NonNegative, along(1.0), 1, scale);
                    self.rest_at(negative);
                    preload[component] -= negative;
                    self.tie(link, slack, scale, negative + positive);
                    self.rest_at(positive);
                }
            }
        }
        let [a, b, c, d, e, f] = preload;
        self.add_preload(link, Wrench::new(Vec3::new(a, b, c), Vec3::new(d, e, f)));
    }

    /// Adds the row `p + q = t width` that ties a box component's two slacks.
    fn tie(&mut self, link: usize, slack: usize, scale: f64, width: f64) {
        let row = self.rows();
        let width = -width / scale;
        let (fixed, growing) = if self.held[link] { (width, 0.0) } else { (0.0, width * self.t_scale) };
        self.load.push(fixed);
        self.row_factor.push(1.0 / scale);
        self.preload.push(growing);
        let one = self.groups.last_mut().expect("the slack that is tied");
        one.tie_row = Some(row);
        let other = self.add_group(link, Cone::NonNegative, Form::Slack, 1, scale);
        let other = self.groups.last_mut().filter(|group| group.first == other).expect("just added");
        (other.tie_row, other.ties) = (Some(row), Some(slack));
    }

    /// Longest lever of a link's bodies.
    pub(super) fn lever_of(&self, link: usize) -> f64 {
        self.sides[link].iter().flatten().map(|side| self.scales.lever[side.body]).fold(0.0, f64::max)
    }

    /// Adds a group of variables; returns the first one's index.
    fn add_group(&mut self, link: usize, cone: Cone, form: Form, len: usize, scale: f64) -> usize {
        let first = self.variables;
        self.variables += len;
        self.groups.push(Group { cone, first, len, link, form, scale, rest: 0.0, tie_row: None, ties: None });
        first
    }

    /// Says at what `strength` the group just added rests.
    fn rest_at(&mut self, strength: f64) {
        if let (Purpose::Utilisation, Some(group)) = (self.purpose, self.groups.last_mut()) {
            group.rest = strength * self.t_scale / group.scale;
        }
    }

    fn add_preload(&mut self, link: usize, local: Wrench) {
        if local == Wrench::ZERO {
            return;
        }
        match self.purpose {
            Purpose::Utilisation if self.held[link] => {
                let Wrench { force: f, torque: m } = local;
                for side in self.sides[link].iter().flatten() {
                    side.push(&[f.x, f.y, f.z, m.x, m.y, m.z], &mut self.load);
                }
                self.held_local[link] = local;
            }
            Purpose::Utilisation => {
                let Wrench { force: f, torque: m } = local * self.t_scale;
                for side in self.sides[link].iter().flatten() {
                    side.push(&[f.x, f.y, f.z, m.x, m.y, m.z], &mut self.preload);
                }
                self.preload_local[link] = local;
            }
            // A preload of any size, along z as in every model that has one.
            Purpose::Support => {
                let along = Form::Axes([(2, -1.0); 6]);
                self.add_group(link, Cone::NonNegative, along, 1, self.scales.link[link]);
            }
        }
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
