//! The elements of a block's program, and what holds for all of them together.
//!
//! ```text
//! A x + a t = -L,    s = c + A'v,    x and s in their cones
//! ```
//!
//! with D balances per body and a dense column `a` for t. The two slacks of a
//! box component with two limits are tied by a row of their own, `p + q = t width`,
//! that is eliminated by hand, so it costs nothing.
//!
//! `direction` finds the steps. Knows the elements, not how their matrix is factorised.

mod direction;

use nalgebra::SMatrix;

use super::element::{Element, Rows};
use super::families::{Families, Family, each};
use super::groups::Cone;
use super::network::Network;
use super::normal::Normal;
use super::parts::{Part, START};
use super::second_order::dot;
use super::series::flexibility_root;

/// What all cones together dissipate at the start, at forces that are typical, in a program of at
/// least so many bodies. In a motion that proves a bound it is 1; more begins farther inside the
/// cones. If it grew with the number of cones, as 1 for each of few does no harm, so would the
/// number of steps.
const OPENING: f64 = 30.0;
const LARGE: usize = 200;

/// The row that ties two single variables, its unknown motion eliminated.
struct Tie {
    /// Indices among the single variables; the second acts on no body.
    pair: [usize; 2],
    /// t's entry of the row.
    preload: f64,
    /// What the row lacks.
    lacking: f64,
    /// The row's motion, and its step.
    motion: f64,
    change: f64,
    /// Sum of both weights, and the first one's share.
    weight: f64,
    share: f64,
    /// Right-hand side of the step, and the first variable's step if no body moved.
    wanted: f64,
    resting: f64,
}

/// A link in a chain, with its elements: index of its cone of six or of a single
/// variable, and the components of the link's wrench along which they act, with the
/// wrench per variable.
struct InChain {
    six: Option<(usize, [(usize, f64); 6])>,
    one: Vec<(usize, (usize, f64))>,
}

/// A block's program, and an iterate.
pub(super) struct System<const D: usize> {
    families: Families<D>,
    t: Element<D, 1>,
    ties: Vec<Tie>,
    /// Per link in a chain.
    in_chains: Vec<InChain>,
    /// Per link: its index among `in_chains`.
    chained: Vec<Option<usize>>,
    /// Loads, negative.
    wanted: Vec<Rows<D>>,
    /// Column of t.
    preload: Vec<Rows<D>>,
    /// The bodies' motion, its step, and what the balances lack.
    v: Vec<Rows<D>>,
    dv: Vec<Rows<D>>,
    lacking: Vec<Rows<D>>,
    /// Number of cones.
    degree: f64,
    normal: Normal<D>,
}

/// What an iterate amounts to.
#[derive(Clone, Copy, Debug)]
pub(super) struct Residuals {
    /// `x's`.
    pub gap: f64,
    /// Largest of what balances and of what openings lack.
    pub imbalance: f64,
    pub opening: f64,
    /// The objective as the forces and as the motion give it, and t itself.
    pub primal: f64,
    pub dual: f64,
    pub t: f64,
}

impl<const D: usize> System<D> {
    /// The start on a program of `parts` with `loads` and the column `preload` of t by
    /// body, and entries `tie_preload` by tie row, the links of which `network` joins.
    /// Opening velocities are inset by `inset` over all cones; forces and t begin at `force`
    /// times those that are typical.
    pub(super) fn new(
        parts: &[Part<D>],
        loads: &[Rows<D>],
        preload: Vec<Rows<D>>,
        tie_preload: impl Fn(usize) -> f64,
        network: Network<D>,
        inset: f64,
        force: f64,
    ) -> Self {
        let heads = parts.iter().filter(|part| part.cone != Cone::Free).count() as f64;
        let links = parts.iter().map(|part| part.link + 1).max().unwrap_or(0);
        let opening = if loads.len() < LARGE { 1.0 } else { (OPENING / heads).min(1.0) };
        let start = [force, opening];
        let mut families = Families {
            one: Family::default(),
            two: Family::default(),
            three: Family::default(),
            six: Family::default(),
        };
        let mut chained = vec![None; links];
        let mut in_chains = Vec::new();
        for link in network.links_in_chains() {
            chained[link] = Some(in_chains.len());
            in_chains.push(InChain { six: None, one: Vec::new() });
        }
        let mut ties = Vec::new();
        let mut first_slack = Vec::new();
        for part in parts {
            let cost = if part.cone == Cone::Free { 0.0 } else { -inset * part.inset / heads };
            let chain = chained[part.link].map(|index: usize| &mut in_chains[index]);
            match part.len {
                1 => {
                    let index = families.one.add(part, cost, start);
                    if let (Some(chain), Some(axes)) = (chain, &part.axes) {
                        chain.one.push((index, axes[0]));
                        families.one.elements[index].in_chain = true;
                    }
                    first_slack.resize(part.first + 1, 0);
                    first_slack[part.first] = index;
                    if let (Some(slack), Some(row)) = (part.ties, part.tie_row) {
                        let one = first_slack[slack];
                        families.one.elements[index].in_chain = families.one.elements[one].in_chain;
                        ties.push(Tie::new([one, index], tie_preload(row)));
                    }
                }
                2 => _ = families.two.add(part, cost, start),
                3 => _ = families.three.add(part, cost, start),
                _ => {
                    let index = families.six.add(part, cost, start);
                    if let (Some(chain), Some(axes)) = (chain, part.axes) {
                        chain.six = Some((index, axes));
                        families.six.elements[index].in_chain = true;
                    }
                }
            }
        }
        families.one.place(&network);
        families.two.place(&network);
        families.three.place(&network);
        families.six.place(&network);
        let nothing = vec![[0.0; D]; loads.len()];
        Self {
            families,
            t: Element::new([None, None], false, 1.0, [force * START, START.recip()]),
            ties,
            in_chains,
            chained,
            wanted: loads.iter().map(|load| load.map(|value| -value)).collect(),
            preload,
            v: nothing.clone(),
            dv: nothing.clone(),
            lacking: nothing,
            degree: heads + 1.0,
            normal: Normal::new(network),
        }
    }

    /// Whether every cone is a half line or a wedge.
    pub(super) fn is_linear(&self) -> bool {
        self.families.three.elements.is_empty() && self.families.six.elements.is_empty()
    }

    /// Number of cones.
    pub(super) fn degree(&self) -> f64 {
        self.degree
    }

    /// Takes the shares x and s of the step, in `steps`, and compares both sides of all equations
    /// there. In one go, as programs with thousands of links do not fit into caches.
    pub(super) fn advance(&mut self, steps: [f64; 2]) -> Residuals {
        self.t.advance(steps);
        for (v, dv) in self.v.iter_mut().zip(&self.dv) {
            for (v, dv) in v.iter_mut().zip(dv) {
                *v += steps[1] * dv;
            }
        }
        for tie in &mut self.ties {
            tie.motion += steps[1] * tie.change;
            for index in tie.pair {
                self.families.one.elements[index].tied = tie.motion;
            }
        }
        let mut forces = vec![[0.0; D]; self.v.len()];
        let (mut gap, mut opening, mut primal) = (0.0, 0.0_f64, 0.0);
        each!(self.families, iter_mut, element => {
            element.advance(steps);
            element.compare(&self.v, &mut forces);
            gap += element.gap();
            primal += element.cost * element.x[0];
            opening = element.opening.iter().fold(opening, |largest, value| largest.max(value.abs()));
        });
        let t = self.t.x[0];
        let mut imbalance = 0.0_f64;
        for (((lacking, wanted), force), preload) in
            self.lacking.iter_mut().zip(&self.wanted).zip(&forces).zip(&self.preload)
        {
            for k in 0..D {
                lacking[k] = wanted[k] - force[k] - preload[k] * t;
                imbalance = imbalance.max(lacking[k].abs());
            }
        }
        self.t.tied = work(&self.preload, &self.v);
        for tie in &mut self.ties {
            let [p, q] = tie.pair.map(|index| self.families.one.elements[index].x[0]);
            tie.lacking = -(p + q + tie.preload * t);
            imbalance = imbalance.max(tie.lacking.abs());
            self.t.tied += tie.preload * tie.motion;
        }
        self.t.compare(&self.v, &mut []);
        gap += self.t.gap();
        opening = opening.max(self.t.opening[0].abs());
        let dual = -work(&self.wanted, &self.v);
        Residuals { gap, imbalance, opening, primal: primal + t, dual, t }
    }

    /// Finds the scaling of every cone and factorises there; whether it could.
    pub(super) fn factorise(&mut self) -> bool {
        let network = self.normal.network();
        network.clear();
        let Families { one, two, three, six } = &mut self.families;
        let rescaled = one.elements.iter_mut().all(Element::rescale)
            && two.stiffen(network)
            && three.stiffen(network)
            && six.stiffen(network)
            && self.t.rescale();
        if !rescaled {
            return false;
        }
        // What ties leave of the stiffness is known with the scaling of both.
        for tie in &mut self.ties {
            let single = &mut self.families.one.elements;
            let [one, other] = tie.pair.map(|index| single[index].stiffness().0);
            tie.weight = one + other;
            tie.share = one / tie.weight;
            single[tie.pair[0]].left = 1.0 - tie.share;
        }
        self.families.one.add_stiffness(network);
        let (one, six) = (&self.families.one.elements, &self.families.six.elements);
        network.factorise_with(|link| {
            let chain = &self.in_chains[self.chained[link].expect("a link in a chain")];
            match chain.six {
                Some((index, axes)) => wrench_flexibility(&six[index], &axes),
                None => {
                    let mut stiffness = SMatrix::zeros();
                    for &(index, (axis, factor)) in &chain.one {
                        stiffness[(axis, axis)] += factor * factor * one[index].stiffness().0 * one[index].left;
                    }
                    flexibility_root(&stiffness)
                }
            }
        });
        let mut border = self.preload.clone();
        let mut give = self.t.stiffness().0.recip();
        for tie in &self.ties {
            give += tie.preload * tie.preload / tie.weight;
            one[tie.pair[0]].push(&[-tie.share * tie.preload], &mut border);
        }
        self.normal.add_border(border.as_flattened(), give);
        true
    }

    /// Largest steps of x and s, at most 1, that stay in the cones, times `shorten`.
    pub(super) fn reach(&self, shorten: f64) -> [f64; 2] {
        let mut reach = self.t.reach(shorten, [1.0; 2]);
        each!(self.families, iter, element => reach = element.reach(shorten, reach));
        reach
    }

    /// The bodies' motion.
    pub(super) fn motion(&self) -> &[Rows<D>] {
        &self.v
    }

    /// The motions of the tie rows, in their order.
    pub(super) fn tie_motions(&self) -> impl Iterator<Item = f64> {
        self.ties.iter().map(|tie| tie.motion)
    }

    /// Calls `each` with every group's first variable and its forces.
    pub(super) fn forces(&self, mut each: impl FnMut(usize, &[f64])) {
        self.families.one.forces(&mut each);
        self.families.two.forces(&mut each);
        self.families.three.forces(&mut each);
        self.families.six.forces(&mut each);
    }
}

impl Tie {
    fn new(pair: [usize; 2], preload: f64) -> Self {
        Self {
            pair,
            preload,
            lacking: 0.0,
            motion: 0.0,
            change: 0.0,
            weight: 1.0,
            share: 0.0,
            wanted: 0.0,
            resting: 0.0,
        }
    }
}

fn work<const D: usize>(rows: &[Rows<D>], v: &[Rows<D>]) -> f64 {
    rows.iter().zip(v).map(|(row, v)| dot(row, v)).sum()
}

/// `C'^-1 W` of a cone of all six components of a wrench.
fn wrench_flexibility<const D: usize>(element: &Element<D, 6>, axes: &[(usize, f64); 6]) -> SMatrix<f64, D, D> {
    let mut root = SMatrix::zeros();
    for (c, column) in element.root().iter().enumerate() {
        for (value, (axis, factor)) in column.iter().zip(axes) {
            root[(*axis, c)] = value / factor;
        }
    }
    root
}
