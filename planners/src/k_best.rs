//! The cheapest simple paths of a required width, one after the other.

use std::collections::{HashMap, HashSet};
use std::hash::Hash;

use crate::algebra::Additive;
use crate::budget::Limit;
use crate::graph::{Arrow, START};
use crate::outcome::{Outcome, Proof};
use crate::progress::Pass;
use crate::queue::Queue;
use crate::registry::StateId;
use crate::search::{PathOf, Search};
use crate::shortest::Task;
use crate::space::Space;

/// Where paths part from those that were looked at: after `way`, or the same in another order.
struct Root {
    way: Vec<Arrow>,
    /// How those that were looked at go on.
    known: Vec<Arrow>,
}

/// A part of the paths that are left.
enum Part {
    /// The cheapest of those that go on from a root in another way.
    Path(Vec<Arrow>),
    /// Those of this root, looked for when it knew so many ways on: none is as cheap as what has been taken up so far.
    Rest { root: usize, known: usize },
}

/// What is still to be searched through.
struct Roots<K> {
    floor: f64,
    /// The numbers of the roots by what they have in common with other orders, and the state that they lead to;
    /// never iterated over.
    places: HashMap<(StateId, K), usize>,
    roots: Vec<Root>,
    /// The parts by the least that a path of theirs may cost, found ones first.
    open: Queue<(Additive, bool), Part>,
    /// Memory of all transitions.
    bytes: usize,
    /// Least cost at which an interval too wide to decide may hide a path.
    undecided: u32,
}

impl<S: Space> Search<'_, S> {
    /// The `k` cheapest simple paths from the start to a goal whose width is at
    /// least `floor`, cheapest first, ties in order of discovery; `k` counts
    /// as at least 1. Of paths whose actions have the same `same_plan` key only
    /// the first is kept. Keys that are equal for two ways to one state have to be equal for whatever follows on both: the
    /// actions up to the order of independent ones have such a key. A path visits no state twice and ends at its first goal.
    ///
    /// After [`Search::margin`], the `floor` of its proof gives the alternatives
    /// to its path.
    ///
    /// Method: J. Y. Yen, "Finding the k shortest loopless paths in a network",
    /// Management Science 17(11), 1971. Every path that is looked at splits those that are left by the place where they part
    /// from it; the cheapest of each part is found by the lazy A* of [`Search::shortest`], which goes no further than
    /// the cheapest of all parts asks for: a part without any path need not be finite. Here a place is a
    /// state *with the key* of the way to it: `n` independent actions have `n!` orders, but only
    /// `2^n` places (two runs of `n` moves 4^n / sqrt(n) and n^2), and other orders are gone through no further
    /// than the first place at which everything has been looked at.
    ///
    /// # Guarantees
    ///
    /// - `Solved`: every path found is certified, and no path with a key that is
    ///   not among those found costs less than the last, unless another order of it visits a state twice. Fewer than `k` are
    ///   all that there are; then `cost_at_least` is `u32::MAX`.
    /// - `Impossible`: as for [`Search::shortest`].
    /// - `OutOfBudget`: those found come in order; no path with another key
    ///   whose true width is at least `floor` costs less than `cost_at_least`, with the same exception.
    pub fn k_best<K: Eq + Hash>(
        &mut self,
        k: usize,
        floor: f64,
        same_plan: impl Fn(&[S::Action]) -> K,
    ) -> Outcome<Vec<PathOf<S>>> {
        self.begin();
        self.monitor.progress.pass = Pass::KBest;
        let mut roots = Roots {
            floor,
            places: HashMap::from([((START, same_plan(&[])), 0)]),
            roots: vec![Root { way: Vec::new(), known: Vec::new() }],
            open: Queue::new(),
            bytes: 0,
            undecided: u32::MAX,
        };
        let (mut found, mut keys) = (Vec::new(), HashSet::new());

        if let Err((limit, cost_at_least)) = self.go_on(&mut roots, 0, u32::MAX) {
            return self.conclude_list(found, Some(limit), floor, cost_at_least.min(roots.undecided));
        }
        while let Some(head) = roots.open.pop() {
            let (Additive(cost), _) = head.priority;
            self.monitor.progress.cost_at_least = cost.min(roots.undecided);
            let searched = match head.item {
                // Whoever has learned another way on since has looked for the rest, too.
                Part::Rest { root, known } if roots.roots[root].known.len() > known => Ok(()),
                Part::Rest { root, .. } => self.go_on(&mut roots, root, cost.saturating_add(1)),
                Part::Path(way) => {
                    roots.bytes -= size_of_val(&*way);
                    let path = self.path(&way);
                    let actions: Vec<S::Action> = path.steps.iter().map(|step| step.action.clone()).collect();
                    if keys.insert(same_plan(&actions)) {
                        self.monitor.progress.best_cost.get_or_insert(cost);
                        found.push(path);
                        if found.len() >= k {
                            let limit = (roots.undecided < cost).then_some(Limit::Precision);
                            return self.conclude_list(found, limit, floor, cost.min(roots.undecided));
                        }
                    }
                    self.split(&mut roots, &way, &actions, &same_plan)
                }
            };
            if let Err((limit, _)) = searched {
                return self.conclude_list(found, Some(limit), floor, cost.min(roots.undecided));
            }
        }
        let limit = (roots.undecided < u32::MAX).then_some(Limit::Precision);
        self.conclude_list(found, limit, floor, roots.undecided)
    }

    /// Looks for the cheapest paths that part from this one, from each of its places where it goes on in a new way.
    fn split<K: Eq + Hash>(
        &mut self,
        roots: &mut Roots<K>,
        way: &[Arrow],
        actions: &[S::Action],
        same_plan: &impl Fn(&[S::Action]) -> K,
    ) -> Result<(), (Limit, u32)> {
        let cost = self.cost(way);
        for (at, &next) in way.iter().enumerate() {
            let place = (next.from, same_plan(&actions[..at]));
            let root = *roots.places.entry(place).or_insert(roots.roots.len());
            if root == roots.roots.len() {
                roots.roots.push(Root { way: way[..at].to_vec(), known: Vec::new() });
                roots.bytes += size_of_val(&way[..at]) + size_of::<Root>();
            }
            if roots.roots[root].known.contains(&next) {
                continue;
            }
            roots.roots[root].known.push(next);
            roots.bytes += size_of::<Arrow>();
            self.go_on(roots, root, cost.saturating_add(1))?;
        }
        Ok(())
    }

    /// Finds the cheapest path below this cost that goes on from a root in a way that it does not know, or what the others
    /// may cost at least. Out of budget it says what no such path can cost less than.
    fn go_on<K>(&mut self, roots: &mut Roots<K>, root: usize, below: u32) -> Result<(), (Limit, u32)> {
        let Root { way, known } = &roots.roots[root];
        let mut visited = vec![START];
        visited.extend(way.iter().map(|&arrow| self.graph.edge(arrow).to));
        let task = Task {
            from: visited.pop().expect("the start at least"),
            spent: self.cost(way),
            avoid: &visited,
            forbid: known,
            held_bytes: roots.bytes + roots.open.bytes(),
            ..Task::whole(roots.floor, below)
        };
        let run = self.run_shortest(&task);
        match run.limit {
            Some(Limit::Precision) => roots.undecided = roots.undecided.min(run.cost_at_least),
            Some(limit) => return Err((limit, run.cost_at_least)),
            None => {}
        }
        if let Some(rest) = run.best {
            let way = [way.as_slice(), &rest].concat();
            roots.bytes += size_of_val(&*way);
            roots.open.push((Additive(self.cost(&way)), true), Part::Path(way));
        } else if run.beyond < u32::MAX {
            roots.open.push((Additive(run.beyond), false), Part::Rest { root, known: known.len() });
        }
        Ok(())
    }

    fn cost(&self, way: &[Arrow]) -> u32 {
        way.iter().fold(0, |sum: u32, &arrow| sum.saturating_add(self.graph.edge(arrow).cost))
    }

    /// Reads how the search ended. `cost_at_least` is for paths not found.
    fn conclude_list(
        &mut self,
        found: Vec<PathOf<S>>,
        limit: Option<Limit>,
        floor: f64,
        cost_at_least: u32,
    ) -> Outcome<Vec<PathOf<S>>> {
        self.monitor.progress.cost_at_least = cost_at_least;
        self.monitor.report();
        let narrowest = found.iter().map(|path| path.width.lower).reduce(f64::min);
        let proof = Proof {
            width_at_most: self.graph.cap().max(narrowest.unwrap_or(f64::NEG_INFINITY)),
            width_optimal: narrowest.is_some_and(|width| width >= self.tie(self.graph.cap())),
            floor,
            cost_at_least,
            cost_optimal: found.last().is_some_and(|path| path.cost <= cost_at_least),
        };
        match limit {
            Some(limit) => Outcome::OutOfBudget { limit, best: (!found.is_empty()).then_some(found), proof },
            None if found.is_empty() => Outcome::Impossible,
            None => Outcome::Solved { found, proof },
        }
    }
}
