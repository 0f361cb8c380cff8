//! Random polycubes.
//!
//! A shape grows cube by cube, each in a place drawn from all empty cells beside the shape that are free of
//! obstacles (the Eden model). It is asked about in batches of an eighth of its size; a batch after which it does not
//! stand is taken back and tried again by halves, down to the single cube that may not be there.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use crate::geometry::{SKIN, Solid, Surroundings};
use crate::reconfigure::wander;
use crate::robot::{Catalogue, Cell, Configuration, Face, Goal, Matching, Module, Placement, Requirement, neighbour};

use super::draw::{Draw, Purpose};
use super::setting::{Setting, World};
use super::{ATTEMPTS, Failure, Generated, GoalKind, Pair, Request, Tally, stands, walk_length};

/// A shape changes by this share of its size between two questions to the oracle.
const BATCH: usize = 8;

/// Draws a problem of cubes.
///
/// # Errors
/// What cannot be drawn, or was not found.
pub fn generate(request: &Request) -> Result<Generated, Failure> {
    let moved = match request.goal {
        GoalKind::Grown => Some(modules_to_move(request)?),
        GoalKind::Walk => None,
    };
    let mut site = Site::new(request);
    let mut draw = Draw::new(request.seed, Purpose::Start);
    let mut tries = Draw::new(request.seed, Purpose::Goal);
    for _ in 0..ATTEMPTS {
        let Some(start) = site.start(&mut draw) else {
            site.tally.restarts += 1;
            continue;
        };
        let from = site.configuration(&start);
        match moved {
            Some(moved) => {
                for _ in 0..ATTEMPTS {
                    if let Some(goal) = site.goal(&start, moved, &mut tries) {
                        let goal = site.configuration(&goal);
                        return Ok(site.done(from, goal, moved));
                    }
                    site.tally.restarts += 1;
                }
            }
            None => {
                let through = Configuration { require: requirement(request.margin), ..from.clone() };
                let walk = wander(&through, walk_length(request)?, &mut |count| tries.below(count));
                let walk = walk.map_err(Failure::Refused)?;
                if walk.moves > 0 {
                    let goal = Configuration { require: requirement(0.0), ..walk.end };
                    return Ok(site.done(from, goal, walk.moves));
                }
                site.tally.restarts += 1;
            }
        }
    }
    Err(Failure::NoneFound(site.tally))
}

/// How many modules of a grown goal are to be elsewhere: one stays, for the goal to grow from.
fn modules_to_move(request: &Request) -> Result<usize, Failure> {
    let most = request.modules - 1;
    match request.difficulty.unwrap_or(most) {
        moved if (1..=most).contains(&moved) => Ok(moved),
        _ => Err(Failure::Difficulty { least: 1, most }),
    }
}

fn requirement(margin: f64) -> Requirement {
    Requirement { margin, ..Requirement::default() }
}

/// Where cubes grow.
struct Site {
    catalogue: Arc<Catalogue>,
    request: Request,
    world: World,
    surroundings: Surroundings,
    /// Whether there is room in a cell, of those asked about.
    room: BTreeMap<Cell, bool>,
    tally: Tally,
}

impl Site {
    fn new(request: &Request) -> Self {
        let catalogue = Arc::new(Catalogue::cube());
        let pitch = catalogue.module_types[0].cell().pitch;
        let reach = (request.modules as f64).sqrt().ceil() as i32 + 2;
        let mut draw = Draw::new(request.seed, Purpose::Surroundings);
        let world = World::draw(request.setting, pitch, 0.0, reach, &mut draw);
        let surroundings = Surroundings::new(&world.environment);
        Self { catalogue, request: *request, world, surroundings, room: BTreeMap::new(), tally: Tally::default() }
    }

    fn done(self, start: Configuration, goal: Configuration, difficulty: usize) -> Generated {
        let matching = Matching { labelled: false, free_frame: self.request.setting == Setting::Space };
        let goal = Goal { configuration: goal, matching };
        Generated { pair: Pair::Lattice { start, goal }, difficulty: Some(difficulty), tally: self.tally }
    }

    /// A shape from a single cube near the origin.
    fn start(&mut self, draw: &mut Draw) -> Option<Vec<Cell>> {
        let [x, y] = [0, 1].map(|_| draw.below(3) as i32 - 1);
        let first = [x, y, self.world.level(x, y)];
        self.tally.drawn += 1;
        self.grown(vec![first], &BTreeSet::new(), draw)
    }

    /// A shape that has all but `moved` modules where `start` has them, and the others elsewhere. The first one,
    /// which may be held, stays.
    fn goal(&mut self, start: &[Cell], moved: usize, draw: &mut Draw) -> Option<Vec<Cell>> {
        let kept = self.thinned(start, moved, draw)?;
        self.grown(kept, &start.iter().copied().collect(), draw)
    }

    /// The shape with more cubes, up to the size asked for, none of them in a forbidden cell.
    fn grown(&mut self, mut cells: Vec<Cell>, forbidden: &BTreeSet<Cell>, draw: &mut Draw) -> Option<Vec<Cell>> {
        let mut rejected = BTreeSet::new();
        let mut batch = usize::MAX;
        while cells.len() < self.request.modules {
            let before = cells.len();
            batch = batch.min((before / BATCH).max(1)).min(self.request.modules - before);
            for _ in 0..batch {
                let mut open = self.frontier(&cells);
                open.retain(|cell| !forbidden.contains(cell) && !rejected.contains(cell));
                if open.is_empty() {
                    break;
                }
                cells.push(*draw.choose(&open));
                self.tally.drawn += 1;
            }
            let added = cells.len() - before;
            if added == 0 {
                return None;
            }
            if self.stands(&cells) {
                rejected.clear();
                batch = usize::MAX;
                continue;
            }
            self.tally.unstable += added as u64;
            if added == 1 {
                rejected.insert(cells[before]);
            }
            cells.truncate(before);
            batch = (added / 2).max(1);
        }
        Some(cells)
    }

    /// The shape without so many of its cubes, in one piece; it need not stand until others are added.
    fn thinned(&mut self, start: &[Cell], fewer: usize, draw: &mut Draw) -> Option<Vec<Cell>> {
        let mut cells = start.to_vec();
        let held = usize::from(self.request.held);
        let mut left = fewer;
        while left > 0 {
            let mut candidates: Vec<usize> = (held..cells.len()).collect();
            let removed = loop {
                if candidates.is_empty() {
                    return None;
                }
                let candidate = candidates.swap_remove(draw.below(candidates.len()));
                let mut others = cells.clone();
                others.remove(candidate);
                if is_connected(&others) {
                    break others;
                }
            };
            cells = removed;
            left -= 1;
        }
        Some(cells)
    }

    /// The empty cells beside a shape that there is room in, ascending.
    fn frontier(&mut self, cells: &[Cell]) -> Vec<Cell> {
        let filled: BTreeSet<Cell> = cells.iter().copied().collect();
        let beside = cells.iter().flat_map(|&cell| Face::ALL.into_iter().filter_map(move |face| neighbour(cell, face)));
        let open: BTreeSet<Cell> = beside.filter(|cell| !filled.contains(cell)).collect();
        open.into_iter().filter(|&cell| self.has_room(cell)).collect()
    }

    fn has_room(&mut self, cell: Cell) -> bool {
        let within = |c: i32| c.abs() <= self.world.reach;
        if !(within(cell[0]) && within(cell[1])) {
            return false;
        }
        if let Some(&known) = self.room.get(&cell) {
            return known;
        }
        let kind = &self.catalogue.module_types[0];
        let solid = Solid::new(kind.body().shape.clone(), Placement::new(cell).pose(kind.cell().pitch));
        let has_room = self.surroundings.overlaps(&solid, SKIN * solid.size()).is_empty();
        self.room.insert(cell, has_room);
        has_room
    }

    fn stands(&self, cells: &[Cell]) -> bool {
        stands::cubes(&self.configuration(cells), self.request.margin)
    }

    /// Cubes in these cells, everything connected.
    fn configuration(&self, cells: &[Cell]) -> Configuration {
        let module = |(index, &cell): (usize, &Cell)| Module {
            id: format!("m{}", index + 1),
            module_type: 0,
            placement: Placement::new(cell),
            fixed: self.request.held && index == 0,
        };
        let mut configuration = Configuration {
            catalogue: Arc::clone(&self.catalogue),
            gravity: self.world.gravity,
            environment: self.world.environment.clone(),
            modules: cells.iter().enumerate().map(module).collect(),
            connections: Vec::new(),
            loads: Vec::new(),
            require: Requirement::default(),
        };
        configuration.connections = configuration.touching_connections();
        configuration
    }
}

/// Whether cubes in these cells hang together by their faces. True of none.
fn is_connected(cells: &[Cell]) -> bool {
    let mut left: BTreeSet<Cell> = cells.iter().copied().collect();
    let mut reached: Vec<Cell> = left.pop_first().into_iter().collect();
    while let Some(cell) = reached.pop() {
        reached.extend(Face::ALL.into_iter().filter_map(|face| neighbour(cell, face)).filter(|next| left.remove(next)));
    }
    left.is_empty()
}
