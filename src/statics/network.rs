//! The stiffness of a block's links, assembled over its bodies.
//!
//! `M = sum B K B'` over the links, with K a link's 6 x 6 stiffness in its own
//! frame and B its action on the balances of its two bodies. A chain of bodies
//! that hang between two links each passes one unknown wrench on: such bodies
//! are left out of the matrix, their links act in series, and what is eliminated
//! are flexibilities that add up, however long the chain. They are added as
//! roots, `F = G G'`, by orthogonal transformations: at the limit of a cone a
//! flexibility spans more decades than a sum of squares can hold.
//!
//! Knows where links act and how stiff they are, nothing of cones.

use std::sync::Arc;

use nalgebra::{Matrix6, SMatrix, SVector};

use super::chains::{Between, Chain, End, Passage, incident, walk, within_chains};
use super::elimination::Pattern;
use super::maps::Ends;
use super::program::Program;
use super::series::{Stacked, inverse};
use super::stiffness::{Matrix, Stiffness};

/// Loads with the bodies in chains eliminated.
#[derive(Default)]
pub(super) struct Condensed<const D: usize> {
    /// By junction, D rows each.
    pub junctions: Vec<f64>,
    /// Per chain of several links: the wrench with both ends held.
    held: Vec<SVector<f64, D>>,
    /// Per link of those chains: what the loads before it add.
    added: Vec<SVector<f64, D>>,
}

impl<const D: usize> Condensed<D> {
    /// Takes away `factor` times what `other` adds within chains.
    pub(super) fn subtract_within(&mut self, other: &Self, factor: f64) {
        for (held, other) in self.held.iter_mut().zip(&other.held) {
            *held -= other * factor;
        }
        for (added, other) in self.added.iter_mut().zip(&other.added) {
            *added -= other * factor;
        }
    }
}

/// A link that is no part of a chain.
struct Single {
    link: usize,
    /// Its sides in the order of elimination.
    sides: [usize; 2],
    /// Blocks of the matrix: of the first end, of the second, and the rows of the second
    /// by the columns of the first.
    slots: [Option<usize>; 3],
}

/// The links of a block as springs.
pub(super) struct Network<const D: usize> {
    /// Number of each body among the junctions.
    junction: Vec<Option<usize>>,
    singles: Vec<Single>,
    chains: Vec<Chain<D>>,
    matrix: Stiffness<D>,
}

impl Network<6> {
    /// The network of `program`'s links. With `in_series`, long chains are condensed.
    pub(super) fn new(program: &Program, in_series: bool) -> Self {
        let bodies = program.scales.force.len();
        let incident = if in_series { incident(program) } else { Vec::new() };
        let within = if in_series { within_chains(program, &incident) } else { vec![false; bodies] };
        let mut count = 0;
        let junction: Vec<Option<usize>> = within
            .iter()
            .map(|within| {
                (!within).then(|| {
                    count += 1;
                    count - 1
                })
            })
            .collect();
        let joined = |ends: &Ends| ends.map(|end| end.and_then(|body| junction[body]));
        let mut used = vec![false; program.ends.len()];
        let (mut chains, mut singles) = (Vec::new(), Vec::with_capacity(program.ends.len()));
        for (link, bodies) in program.ends.iter().enumerate() {
            // Begin where a chain begins: at a junction or the ground.
            let ends = bodies.map(|body| body.is_none_or(|body| junction[body].is_some()));
            match ends {
                [true, true] => singles.push(Single { link, sides: [0, 1], slots: [None; 3] }),
                [false, false] => {}
                _ if used[link] => {}
                [start, _] => chains.push(walk(program, &junction, &incident, &mut used, link, usize::from(!start))),
            }
        }
        let pattern = if count == bodies {
            program.pattern().clone()
        } else {
            let by_chains = chains.iter().map(|chain| chain.ends.each_ref().map(|end| end.as_ref().map(|(at, _)| *at)));
            let pairs = singles.iter().map(|single| joined(&program.ends[single.link])).chain(by_chains);
            Arc::new(Pattern::new(count, pairs.filter_map(|[a, b]| Some((a?, b?)))))
        };
        for single in &mut singles {
            single.place(joined(&program.ends[single.link]), &pattern);
        }
        Self { junction, singles, chains, matrix: Stiffness::new(pattern) }
    }

    /// Factorises for the links of `program`, which the network is of: `stiffness` is K, in their own
    /// frames, and `flexibility` the root G of its inverse, `K G G' = 1`.
    pub(super) fn factorise(
        &mut self,
        program: &Program,
        stiffness: &[Matrix6<f64>],
        flexibility: impl Fn(usize) -> Matrix6<f64>,
    ) {
        self.matrix.clear();
        for Single { link, sides: [first, second], slots: [one, other, across] } in &self.singles {
            let (sides, stiffness) = (&program.sides[*link], &stiffness[*link]);
            if let (Some(slot), Some(side)) = (one, &sides[*first]) {
                add_stiffness(self.matrix.block(*slot), &force(&side.map, stiffness), &side.map);
            }
            if let (Some(slot), Some(side)) = (other, &sides[*second]) {
                let force = force(&side.map, stiffness);
                add_stiffness(self.matrix.block(*slot), &force, &side.map);
                if let (Some(slot), Some(side)) = (across, &sides[*first]) {
                    add_stiffness(self.matrix.block(*slot), &force, &side.map);
                }
            }
        }
        self.add_chains(flexibility);
        self.matrix.factorise();
    }
}

impl Single {
    /// Puts its sides, which are at `junctions`, into the order of elimination, and notes its places in
    /// the matrix.
    fn place(&mut self, mut junctions: [Option<usize>; 2], pattern: &Pattern) {
        if let [Some(one), Some(other)] = junctions
            && pattern.precedes(other, one)
        {
            self.sides.swap(0, 1);
            junctions.swap(0, 1);
        }
        let [one, other] = junctions;
        let slot = |row: Option<usize>, column: Option<usize>| Some(pattern.slot(row?, column?));
        self.slots = [slot(one, one), slot(other, other), slot(other, one)];
    }
}

/// `map stiffness`, by columns; torques in the link's frame push no body.
fn force(map: &Matrix6<f64>, stiffness: &Matrix6<f64>) -> Matrix<6> {
    let (map, mut force) = (&map.data.0, [[0.0; 6]; 6]);
    for (column, stiffness) in force.iter_mut().zip(&stiffness.data.0) {
        for k in 0..3 {
            for r in 0..6 {
                column[r] += map[k][r] * stiffness[k];
            }
        }
        for k in 3..6 {
            for r in 3..6 {
                column[r] += map[k][r] * stiffness[k];
            }
        }
    }
    force
}

/// `block += force map'`.
fn add_stiffness(block: &mut Matrix<6>, force: &Matrix<6>, map: &Matrix6<f64>) {
    let map = &map.data.0;
    for (c, column) in block.iter_mut().enumerate() {
        for k in 0..if c < 3 { 3 } else { 6 } {
            for r in 0..6 {
                column[r] += force[k][r] * map[k][c];
            }
        }
    }
}

impl<const D: usize> Network<D> {
    /// A network of bodies that are joined as in `pattern`, without chains.
    pub(super) fn plain(pattern: &Arc<Pattern>) -> Self {
        let junction = (0..pattern.bodies()).map(Some).collect();
        Self { junction, singles: Vec::new(), chains: Vec::new(), matrix: Stiffness::new(pattern.clone()) }
    }

    /// Where the blocks of the matrix over junctions are.
    pub(super) fn pattern(&self) -> &Arc<Pattern> {
        self.matrix.pattern()
    }

    /// The number of a body among the junctions; `None` within a chain.
    pub(super) fn junction(&self, body: usize) -> Option<usize> {
        self.junction[body]
    }

    /// The links of all chains.
    pub(super) fn links_in_chains(&self) -> impl Iterator<Item = usize> {
        self.chains.iter().flat_map(|chain| chain.links.iter().map(|passage| passage.link))
    }

    /// The matrix over junctions, to be filled before [`factorise_with`](Self::factorise_with).
    pub(super) fn matrix_mut(&mut self) -> &mut Stiffness<D> {
        &mut self.matrix
    }

    /// Sets the matrix to zero.
    pub(super) fn clear(&mut self) {
        self.matrix.clear();
    }

    /// Factorises the matrix as it was filled, chains added, of whose links `flexibility`
    /// is the root G of the inverse stiffness, `K G G' = 1`.
    pub(super) fn factorise_with(&mut self, flexibility: impl Fn(usize) -> SMatrix<f64, D, D>) {
        self.add_chains(flexibility);
        self.matrix.factorise();
    }

    fn add_chains(&mut self, flexibility: impl Fn(usize) -> SMatrix<f64, D, D>) {
        for chain in &mut self.chains {
            chain.flexibility.clear();
            chain.stacked.clear();
            let mut triangle = SMatrix::zeros();
            for Passage { link, wrench } in &chain.links {
                let root = wrench.tr_mul(&flexibility(*link));
                chain.stacked.push(Stacked::new(&mut triangle, root.transpose()));
                chain.flexibility.push(root);
            }
            chain.root = inverse(&triangle);
            let root = |end: &End<D>| end.map(|(at, map)| (at, map * chain.root));
            let [one, other] = [root(&chain.ends[0]), root(&chain.ends[1])];
            for (at, root) in [one, other].iter().flatten() {
                self.matrix.add(*at, *at, &(root * root.transpose()).data.0);
            }
            if let (Some((i, a)), Some((j, b))) = (one, other) {
                let across = b * a.transpose();
                self.matrix.add(j, i, &across.data.0);
                if i == j {
                    self.matrix.add(i, i, &across.transpose().data.0);
                }
            }
        }
    }

    /// Number of wrenches that nothing determines: one per link outside chains, and
    /// one per chain.
    pub(super) fn unknown_wrenches(&self) -> usize {
        self.singles.len() + self.chains.len()
    }

    /// Number of chains.
    pub(super) fn chains(&self) -> usize {
        self.chains.len()
    }

    /// Bodies that are not within a chain.
    pub(super) fn junctions(&self) -> usize {
        self.pattern().bodies()
    }

    /// The loads `rows` (D per body) as the junctions feel them.
    pub(super) fn condense(&self, rows: &[f64]) -> Condensed<D> {
        let mut junctions = vec![0.0; D * self.junctions()];
        for (number, body) in self.junction.iter().zip(rows.chunks_exact(D)) {
            if let Some(k) = *number {
                junctions[D * k..D * k + D].copy_from_slice(body);
            }
        }
        let (mut held, mut added) = (Vec::new(), Vec::new());
        for chain in &self.chains {
            let mut sum = SVector::zeros();
            added.push(sum);
            // The wrench with which the chain is stretched least: a least squares
            // problem, since weighing squares would cancel.
            let mut stretch = SVector::zeros();
            let behind = chain.flexibility[1..].iter().zip(&chain.stacked[1..]);
            for (Between { body, load: map }, (flexibility, factor)) in chain.bodies.iter().zip(behind) {
                sum += map * SVector::from_column_slice(&rows[D * body..D * body + D]);
                stretch = factor.reduce(stretch, flexibility.tr_mul(&sum));
                added.push(sum);
            }
            let through = -(chain.root * stretch);
            for (end, wrench) in chain.ends.iter().zip([through, through + sum]) {
                if let Some((at, map)) = end {
                    for (row, value) in junctions[D * at..D * at + D].iter_mut().zip(&(map * wrench)) {
                        *row -= value;
                    }
                }
            }
            held.push(through);
        }
        Condensed { junctions, held, added }
    }

    /// `a_I' M_II^-1 b_I`: the work of the loads within chains, their ends held.
    pub(super) fn work_within(&self, a: &Condensed<D>, b: &Condensed<D>) -> f64 {
        let (mut added_a, mut added_b) = (a.added.iter(), b.added.iter());
        let mut work = 0.0;
        for (chain, (through_a, through_b)) in self.chains.iter().zip(a.held.iter().zip(&b.held)) {
            for ((flexibility, a), b) in chain.flexibility.iter().zip(&mut added_a).zip(&mut added_b) {
                work += flexibility.tr_mul(&(a + through_a)).dot(&flexibility.tr_mul(&(b + through_b)));
            }
        }
        work
    }

    /// `L^-1 x` over junctions, with `L L'` the factored matrix.
    pub(super) fn forward(&self, junctions: &[f64]) -> Vec<f64> {
        self.matrix.forward(junctions)
    }

    /// `L'^-1 y` over junctions.
    pub(super) fn backward(&self, y: Vec<f64>) -> Vec<f64> {
        self.matrix.backward(y)
    }

    /// The motion of all bodies, D rows each, under the loads `loads`, when that
    /// of the junctions is known.
    ///
    /// `wrench` gets the wrench of every link in a chain of several, in its frame.
    pub(super) fn expand(
        &self,
        junctions: &[f64],
        loads: &Condensed<D>,
        mut wrench: impl FnMut(usize, SVector<f64, D>),
    ) -> Vec<f64> {
        let mut rows = vec![0.0; D * self.junction.len()];
        for (number, body) in self.junction.iter().zip(rows.chunks_exact_mut(D)) {
            if let Some(k) = *number {
                body.copy_from_slice(&junctions[D * k..D * k + D]);
            }
        }
        let mut added = &loads.added[..];
        for (chain, held) in self.chains.iter().zip(&loads.held) {
            let (own, others) = added.split_at(chain.links.len());
            added = others;
            let at_end = |end: &End<D>| {
                end.as_ref().map_or_else(SVector::zeros, |(at, map)| {
                    map.tr_mul(&SVector::from_column_slice(&junctions[D * at..D * at + D]))
                })
            };
            let mut motion = at_end(&chain.ends[0]);
            let apart = motion + at_end(&chain.ends[1]);
            let through = chain.root * chain.root.tr_mul(&apart) + held;
            for (link, added) in chain.links.iter().zip(own) {
                wrench(link.link, link.wrench * (through + added));
            }
            for ((Between { body, load }, flexibility), added) in chain.bodies.iter().zip(&chain.flexibility).zip(own) {
                motion -= flexibility * flexibility.tr_mul(&(through + added));
                rows[D * body..D * body + D].copy_from_slice(load.tr_mul(&motion).as_slice());
            }
        }
        rows
    }

    /// `M^-1 rows`; `wrench` as in [`expand`](Self::expand).
    pub(super) fn solve(&self, rows: &[f64], wrench: impl FnMut(usize, SVector<f64, D>)) -> Vec<f64> {
        let condensed = self.condense(rows);
        let junctions = self.backward(self.forward(&condensed.junctions));
        self.expand(&junctions, &condensed, wrench)
    }
}
