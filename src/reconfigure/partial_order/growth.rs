//! How the order grows: group by group in the plan's order, each let go as early as all that this allows is checked.

use std::collections::{BTreeMap, HashMap, HashSet, VecDeque};
use std::sync::atomic::AtomicU64;

use petgraph::graph::{DiGraph, NodeIndex};

use crate::geometry::{Solid, Surrounding, Surroundings, first_collision};
use crate::reconfigure::assembly::{Assembler, Touched};
use crate::reconfigure::engines::MARGIN_TOLERANCE;
use crate::reconfigure::plan::Plan;
use crate::reconfigure::replay::Fault;
use crate::reconfigure::replay::legality::{Path, transition};
use crate::robot::{Configuration, FaceConnection, Placement};
use crate::statics::Bracket;

use super::groups::{Group, Kind};
use super::overlap::{Ways, are_apart};
use super::{Because, Checked, OrderError, OrderOptions, PartialOrder};

/// A set of groups, one flag for each.
type Set = Vec<bool>;

/// Groups by where the modules are and which groups are under way.
type Key = (Vec<Placement>, Vec<usize>);

/// What was asked about states that differ in their connections only.
#[derive(Default)]
struct Known {
    stood: Vec<(Vec<FaceConnection>, Bracket)>,
    failed: Vec<(Vec<FaceConnection>, Because)>,
}

/// What speaks against letting a group go.
enum Objection {
    /// It must wait for this earlier one.
    Waits(usize, Because),
    /// There is no time to look.
    Over,
}

/// What looking at one group has come to.
struct Attempt {
    checked: Checked,
    margin: Bracket,
}

/// An order in the making.
pub struct Growth<'a> {
    start: &'a Configuration,
    options: &'a OrderOptions,
    ways: Ways<'a>,
    actions: usize,
    groups: Vec<Group>,
    /// For each group all that must have ended before it.
    before: Vec<Set>,
    reasons: BTreeMap<(usize, usize), Because>,
    /// Where sets of done groups lead.
    states: HashMap<Set, Configuration>,
    known: HashMap<Key, Known>,
    margin: Bracket,
    checked: Checked,
    is_complete: bool,
}

impl<'a> Growth<'a> {
    pub fn new(start: &'a Configuration, plan: &Plan, options: &'a OrderOptions) -> Self {
        let groups = Group::of(plan);
        let none = vec![false; groups.len()];
        let required = options.required;
        // The same state assessed twice may differ by the width of a bracket; below 0 nothing stands.
        let least = if required > 0.0 { (required - MARGIN_TOLERANCE).max(0.0) } else { required };
        Self {
            start,
            options,
            ways: Ways { assembler: Assembler::new(start), least, solves: AtomicU64::new(0) },
            actions: plan.actions.len(),
            before: vec![none; groups.len()],
            groups,
            reasons: BTreeMap::new(),
            states: HashMap::new(),
            known: HashMap::new(),
            margin: Bracket::new(f64::INFINITY, f64::INFINITY),
            checked: Checked { states: 1, ..Checked::default() },
            is_complete: true,
        }
    }

    /// The order once all groups are in it.
    pub fn grown(mut self) -> Result<PartialOrder, OrderError> {
        self.check_plan()?;
        for group in 0..self.groups.len() {
            for other in 0..group {
                if self.groups[other].shares_module(&self.groups[group]) {
                    self.wait(group, other, Because::SameModule);
                }
            }
            loop {
                match self.let_go(group)? {
                    None => break,
                    Some(Objection::Waits(other, because)) => self.wait(group, other, because),
                    Some(Objection::Over) => {
                        self.is_complete = false;
                        (0..group).rev().for_each(|other| self.wait(group, other, Because::NotChecked));
                    }
                }
            }
        }
        let graph = self.graph();
        let checked = Checked { oracle_solves: self.ways.solves.into_inner(), ..self.checked };
        Ok(PartialOrder { graph, margin: self.margin, checked, is_complete: self.is_complete })
    }

    /// Goes through the plan in its own order.
    fn check_plan(&mut self) -> Result<(), OrderError> {
        let mut state = self.start.clone();
        state.connections.sort_unstable();
        let mut attempt = Attempt::new();
        let at_start = self.ask(&state, &[], &mut attempt)?;
        at_start.map_err(|because| OrderError::Broken { action: None, because })?;
        self.margin = attempt.margin;
        self.states.insert(vec![false; self.groups.len()], state.clone());
        let around = [&self.start.environment, &self.start.require.off_limits()].map(Surroundings::new);
        for group in 0..self.groups.len() {
            let broken = |because| OrderError::Broken { action: Some(self.groups[group].indices.start), because };
            if let Some(path) = self.paths(&state, &[group]).map_err(broken)?.pop() {
                hits(&state, &path, &around).map_err(|fault| broken(Because::NotLegal(fault)))?;
            }
            self.before[group][..group].fill(true);
            self.let_go(group)?;
            state = self.states[&self.prefix(group + 1)].clone();
        }
        self.before.iter_mut().for_each(|before| before.fill(false));
        self.margin = attempt.margin;
        self.checked = Checked { states: 1, ..Checked::default() };
        Ok(())
    }

    /// The groups before one in the plan.
    fn prefix(&self, group: usize) -> Set {
        (0..self.groups.len()).map(|other| other < group).collect()
    }

    fn wait(&mut self, group: usize, other: usize, because: Because) {
        if self.before[group][other] {
            return;
        }
        for earlier in 0..other {
            self.before[group][earlier] |= self.before[other][earlier];
        }
        self.before[group][other] = true;
        self.reasons.insert((other, group), because);
    }

    /// Looks at everything that a group may meet by what it waits for now, states with little missing first, and
    /// counts it if nothing speaks against it.
    fn let_go(&mut self, group: usize) -> Result<Option<Objection>, OrderError> {
        let mut attempt = Attempt::new();
        let all = self.prefix(group);
        let mut seen = HashSet::from([all.clone()]);
        let mut queue = VecDeque::from([all]);
        while let Some(done) = queue.pop_front() {
            let open = self.open(group, &done);
            if !open.is_empty() && self.options.is_over() {
                return Ok(Some(Objection::Over));
            }
            if let Err((other, because)) = self.meet(group, &done, &open, &mut attempt)? {
                return match other {
                    Some(other) => Ok(Some(Objection::Waits(other, because))),
                    None => Err(OrderError::Broken { action: Some(self.groups[group].indices.start), because }),
                };
            }
            for last in (0..group).filter(|&last| !self.before[group][last] && self.is_last(last, &done)) {
                let mut fewer = done.clone();
                fewer[last] = false;
                if seen.insert(fewer.clone()) {
                    queue.push_back(fewer);
                }
            }
            if seen.len() > 1 && self.checked.states + seen.len() as u64 > self.options.max_states as u64 {
                let latest = (0..group).rev().find(|&other| !self.before[group][other]);
                return Ok(latest.map(|other| Objection::Waits(other, Because::NotChecked)));
            }
        }
        self.checked.states += seen.len() as u64;
        self.checked.overlaps += attempt.checked.overlaps;
        self.checked.by_monotony += attempt.checked.by_monotony;
        self.margin = self.margin.min(attempt.margin);
        Ok(None)
    }

    /// Of the groups before `group` in the plan, those that may begin once `done` are.
    fn open(&self, group: usize, done: &Set) -> Vec<usize> {
        let may_begin = |&other: &usize| !done[other] && (0..other).all(|b| !self.before[other][b] || done[b]);
        (0..group).filter(may_begin).collect()
    }

    /// Whether a done group comes before no other one that is done.
    fn is_last(&self, group: usize, done: &Set) -> bool {
        done[group] && (group + 1..done.len()).all(|later| !done[later] || !self.before[later][group])
    }

    /// Checks what a group may do once `done` are, while `open` are still to come. `Err` with the group to wait for
    /// and the reason; with no group where all earlier ones are done.
    fn meet(
        &mut self,
        group: usize,
        done: &Set,
        open: &[usize],
        attempt: &mut Attempt,
    ) -> Result<Result<(), (Option<usize>, Because)>, OrderError> {
        let from = self.states[done].clone();
        let after = match self.apply(group, &from) {
            Ok(after) => after,
            Err(because) => return Ok(Err((open.last().copied(), because))),
        };
        let mut with = done.clone();
        with[group] = true;
        for &other in open {
            let mut both = with.clone();
            both[other] = true;
            match self.apply(other, &after) {
                Err(because) => return Ok(Err((Some(other), because))),
                Ok(state) if !is_same(&state, &self.states[&both]) => {
                    return Ok(Err((Some(other), Because::OtherState)));
                }
                Ok(_) => {}
            }
        }
        self.states.insert(with.clone(), after.clone());

        // What is being released is worst when all of it is open, what is being attached when nothing is.
        let kind = self.groups[group].kind;
        let releases = open.iter().any(|&other| self.groups[other].kind == Kind::Detach);
        let moves: Vec<usize> = open.iter().copied().filter(|&other| self.groups[other].moving().is_some()).collect();
        for under_way in subsets(&moves, self.options.most_at_once) {
            let latest = under_way.last().copied();
            if kind == Kind::Attach || releases || self.has_attached(&with, &under_way) {
                attempt.checked.by_monotony += 1;
            } else if let Err(because) = self.ask(&after, &under_way, attempt)? {
                return Ok(Err((latest.or(open.last().copied()), because)));
            }
            if self.groups[group].moving().is_none() {
                continue;
            }
            if under_way.len() == self.options.most_at_once.max(1) {
                return Ok(Err((latest, Because::NotChecked)));
            }
            let together: Vec<usize> = under_way.iter().copied().chain([group]).collect();
            if releases || self.has_attached(done, &together) {
                attempt.checked.by_monotony += 1;
            } else if let Err(because) = self.ask(&from, &together, attempt)? {
                return Ok(Err((latest.or(open.last().copied()), because)));
            }
        }
        Ok(Ok(()))
    }

    /// Whether something was attached that need not have been while `under_way` are.
    fn has_attached(&self, done: &Set, under_way: &[usize]) -> bool {
        (0..done.len()).any(|group| {
            self.groups[group].kind == Kind::Attach
                && self.is_last(group, done)
                && under_way.iter().all(|&moving| !self.before[moving][group])
        })
    }

    /// The state after a group, if it is legal and what it moves hits nothing that rests.
    fn apply(&self, group: usize, from: &Configuration) -> Result<Configuration, Because> {
        let mut state = from.clone();
        for action in &self.groups[group].actions {
            let next = transition(&state, action).map_err(Because::NotLegal)?;
            if let Some(path) = &next.path {
                let solid = |m: usize| Solid::new(state.module_type(m).body().shape.clone(), state.pose(m));
                let moving = solid(path.module);
                let mut others = (0..state.modules.len()).filter(|&m| m != path.module);
                let hit = others.find(|&m| first_collision(&moving, &path.motion, &solid(m)).is_some());
                if let Some(module) = hit {
                    return Err(Because::NotLegal(Fault::Collision { with: Touched::Module(module) }));
                }
            }
            state = next.after;
        }
        Ok(state)
    }

    /// The ways of what these groups move out of a state.
    fn paths(&self, state: &Configuration, groups: &[usize]) -> Result<Vec<Path>, Because> {
        let moves = groups.iter().filter(|&&group| self.groups[group].moving().is_some());
        let path = |&group: &usize| transition(state, &self.groups[group].actions[0]).map(|next| next.path);
        let paths: Vec<Option<Path>> = moves.map(path).collect::<Result<_, _>>().map_err(Because::NotLegal)?;
        Ok(paths.into_iter().flatten().collect())
    }

    /// Whether the robot stands while these moves are under way, or at rest without any.
    fn ask(
        &mut self,
        state: &Configuration,
        under_way: &[usize],
        attempt: &mut Attempt,
    ) -> Result<Result<(), Because>, OrderError> {
        attempt.checked.overlaps += u64::from(under_way.len() > 1);
        let key: Key = (state.modules.iter().map(|module| module.placement).collect(), under_way.to_vec());
        let known = self.known.entry(key.clone()).or_default();
        let holds_more = |more: &[FaceConnection], less: &[FaceConnection]| {
            less.iter().all(|connection| more.binary_search(connection).is_ok())
        };
        if let Some((_, because)) = known.failed.iter().find(|(failed, _)| holds_more(failed, &state.connections)) {
            return Ok(Err(because.clone()));
        }
        if let Some((stood, margin)) = known.stood.iter().find(|(stood, _)| holds_more(&state.connections, stood)) {
            let is_exact = *stood == state.connections;
            let upper = if is_exact { margin.upper } else { f64::INFINITY };
            attempt.margin = attempt.margin.min(Bracket::new(margin.lower, upper));
            attempt.checked.by_monotony += u64::from(!is_exact);
            return Ok(Ok(()));
        }
        let found = self.find(state, under_way)?;
        let known = self.known.entry(key).or_default();
        Ok(match found {
            Ok(margin) => {
                known.stood.push((state.connections.clone(), margin));
                attempt.margin = attempt.margin.min(margin);
                Ok(())
            }
            Err(because) => {
                known.failed.push((state.connections.clone(), because.clone()));
                Err(because)
            }
        })
    }

    /// The worst margin of a state while these moves are under way.
    fn find(&self, state: &Configuration, under_way: &[usize]) -> Result<Result<Bracket, Because>, OrderError> {
        let paths = match self.paths(state, under_way) {
            Ok(paths) => paths,
            Err(because) => return Ok(Err(because)),
        };
        for (index, path) in paths.iter().enumerate() {
            if !paths[..index].iter().all(|other| are_apart(state, path, other)) {
                return Ok(Err(Because::WaysCross));
            }
        }
        Ok(self.ways.worst(state, &paths)?)
    }

    /// The arrows between actions that do not follow from others.
    fn graph(&self) -> DiGraph<(), Because> {
        let mut graph = DiGraph::with_capacity(self.actions, self.actions);
        for _ in 0..self.actions {
            graph.add_node(());
        }
        for (&(from, to), because) in &self.reasons {
            let follows = (from + 1..to).any(|between| self.before[to][between] && self.before[between][from]);
            if follows {
                continue;
            }
            for a in self.groups[from].indices.clone() {
                for b in self.groups[to].indices.clone() {
                    graph.add_edge(NodeIndex::new(a), NodeIndex::new(b), because.clone());
                }
            }
        }
        graph
    }
}

impl Attempt {
    fn new() -> Self {
        Self { checked: Checked::default(), margin: Bracket::new(f64::INFINITY, f64::INFINITY) }
    }
}

/// What a module hits on its way besides other modules.
fn hits(state: &Configuration, path: &Path, [around, off_limits]: &[Surroundings; 2]) -> Result<(), Fault> {
    let moving = Solid::new(state.module_type(path.module).body().shape.clone(), state.pose(path.module));
    if let Some((_, what)) = around.first_collision(&moving, &path.motion) {
        return Err(Fault::Collision { with: what.into() });
    }
    match off_limits.first_collision(&moving, &path.motion) {
        Some((_, Surrounding::Obstacle(region))) => Err(Fault::KeepOut { region }),
        Some((_, Surrounding::Ground)) | None => Ok(()),
    }
}

/// Whether two states of one robot are the same.
fn is_same(a: &Configuration, b: &Configuration) -> bool {
    let placements = |state: &Configuration| -> Vec<Placement> { state.modules.iter().map(|m| m.placement).collect() };
    a.connections == b.connections && placements(a) == placements(b)
}

/// All subsets of at most so many of some numbers, each in their order, smaller ones first.
fn subsets(numbers: &[usize], most: usize) -> Vec<Vec<usize>> {
    let mut found = vec![Vec::new()];
    let mut from = 0;
    for _ in 0..most {
        let until = found.len();
        for at in from..until {
            let larger = numbers.iter().filter(|&&number| found[at].last().is_none_or(|&last| last < number));
            let larger: Vec<Vec<usize>> =
                larger.map(|&number| found[at].iter().copied().chain([number]).collect()).collect();
            found.extend(larger);
        }
        from = until;
    }
    found
}
