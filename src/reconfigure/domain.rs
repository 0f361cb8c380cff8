//! What both search spaces of a robot share: moves that are free of collision,
//! connectedness, and margins as widths.

use std::sync::Mutex;
use std::time::Duration;

use planners::Width;

use crate::geometry::{Solid, Surroundings, TOUCH};
use crate::robot::{Cell, Motion, Placement, Shape};
use crate::spatial::{Pose, Rotation, Vec3};
use crate::statics::Bracket;

use super::course::motion;
use super::held::Held;
use super::layout::{Bond, Layout, Placed};
use super::local::{Memo, Neighbourhood, plane};
use super::moves::Move;
use super::oracle::{Oracle, Worst};
use super::problem::Problem;
use super::recollection::Recollection;
use super::ways::{fitting, fitting_of};

/// The worst moment of a move for the module's own hold.
#[derive(Clone, Copy, Debug)]
struct Own {
    /// Upper bound on its margin then, and so on the move's.
    at_most: f64,
    phase: f64,
}

/// A problem with everything that answers questions about its states.
pub struct Domain<'a> {
    /// The problem.
    pub problem: &'a Problem,
    /// The oracle for its states.
    pub oracle: Oracle<'a>,
    /// Whether states must be stable at all.
    pub stability: bool,
    /// Whether nothing is remembered of the oracle's answers, and nothing known without asking: for comparison.
    forgets: bool,
    surroundings: Surroundings,
    off_limits: Surroundings,
    /// Cells of modules that may not move; no other module ever comes there.
    stay: Vec<Cell>,
    pitch: f64,
    /// Whether a module of this type hits neither ground nor obstacles, and passes no forbidden region.
    clear: Memo<(Move, usize), bool>,
    /// Margins at rest.
    at_rest: Memo<(Layout, Vec<Bond>), Worst>,
    /// How modules are held on their way.
    held: Mutex<Held>,
    /// Margins of moves.
    courses: Memo<(Layout, Vec<Bond>, Move), Worst>,
    /// Bounds on margins at rest.
    pub(super) bounds: Memo<(Layout, Vec<Bond>), Worst>,
    /// What states at rest left for their neighbours.
    pub(super) recollection: Recollection,
    /// Bounds on the margins of rotations.
    at_most: Memo<Neighbourhood, f64>,
    /// Where the module of a rotation holds worst, and its margin then.
    own_worst: Memo<Neighbourhood, Own>,
}

impl<'a> Domain<'a> {
    /// Prepares for questions about a problem's states.
    pub fn new(problem: &'a Problem, stability: bool) -> Self {
        let start = problem.start();
        Self {
            problem,
            oracle: Oracle::new(start),
            stability,
            forgets: false,
            surroundings: Surroundings::new(&start.environment),
            off_limits: Surroundings::new(&start.require.off_limits()),
            stay: start.require.stay.iter().map(|&module| start.modules[module].placement.cell).collect(),
            pitch: start.pitch(),
            clear: Memo::new(),
            at_rest: Memo::new(),
            held: Mutex::default(),
            courses: Memo::new(),
            bounds: Memo::new(),
            recollection: Recollection::default(),
            at_most: Memo::new(),
            own_worst: Memo::new(),
        }
    }

    /// With a clock that says what the oracle takes.
    #[must_use]
    pub fn timed_by(mut self, clock: Option<fn() -> Duration>) -> Self {
        self.oracle.clock = clock;
        self
    }

    /// Without memory of what the oracle answered, and without bounds of its own: every margin is asked for.
    #[must_use]
    pub fn forgetting(mut self) -> Self {
        self.forgets = true;
        self
    }

    /// Approximate memory of all answers that are kept, in bytes.
    pub fn memory_bytes(&self) -> usize {
        let modules = self.problem.start().modules.len();
        // Every module of a lattice has about two connections of its own, and a pivot a handful of neighbours.
        let at_rest = modules * (size_of::<Placed>() + 2 * size_of::<Bond>());
        let at_most = 8 * size_of::<(Cell, usize)>();
        let at_rest = self.at_rest.bytes(at_rest) + self.courses.bytes(at_rest) + self.bounds.bytes(at_rest);
        let held = self.held.lock().expect("no thread panics while it asks how modules are held").bytes();
        self.clear.bytes(0)
            + at_rest
            + self.at_most.bytes(at_most)
            + self.own_worst.bytes(at_most)
            + self.recollection.bytes()
            + held
    }

    /// The moves that fit among the modules, hit neither ground nor obstacles and are
    /// not forbidden, in a fixed order, whatever is engaged.
    pub fn moves(&self, layout: &Layout) -> Vec<Move> {
        let mut moves = fitting(layout, |class| self.problem.ability(class));
        moves.retain(|&step| {
            let class = layout.placed()[layout.at(step.from).expect("a fitting move has a module")].class;
            self.is_open(class, step)
        });
        moves
    }

    /// The moves of one module that fit among the others of `layout`, which need not hold it, and
    /// hit neither ground nor obstacles.
    pub fn moves_of(&self, layout: &Layout, placed: &Placed) -> Vec<Move> {
        let mut moves = fitting_of(layout, placed, |class| self.problem.ability(class));
        moves.retain(|&step| self.is_open(placed.class, step));
        moves
    }

    /// Whether a module of some class may take a move, and hits neither ground nor obstacles.
    fn is_open(&self, class: u16, step: Move) -> bool {
        !self.stay.contains(&step.from) && self.is_clear(class, step)
    }

    fn is_clear(&self, class: u16, step: Move) -> bool {
        let module_type = self.problem.class(class).module_type;
        self.clear.get((step, module_type), |_| {
            let shape = self.problem.start().catalogue.module_types[module_type].body().shape.clone();
            // A cube sweeps the same room in every orientation.
            let solid = Solid::new(shape, Placement::new(step.from).pose(self.pitch));
            let motion = motion(step, self.pitch);
            [&self.surroundings, &self.off_limits].iter().all(|part| part.first_collision(&solid, &motion).is_none())
        })
    }

    /// The layout after a move.
    pub fn after(&self, layout: &Layout, step: Move) -> Layout {
        let class = layout.placed()[layout.at(step.from).expect("a fitting move has a module")].class;
        step.applied(layout, self.problem.class(class).turns)
    }

    /// Whether a state at rest is connected, if it has to be.
    pub fn is_connected(&self, layout: &Layout, bonds: &[Bond]) -> bool {
        !self.problem.must_stay_connected() || layout.is_connected_by(bonds.iter().map(|bond| bond.cells()))
    }

    /// Whether a fitting move can begin with these connections engaged.
    pub fn allows(&self, layout: &Layout, bonds: &[Bond], step: Move) -> bool {
        let class = layout.placed()[layout.at(step.from).expect("a fitting move has a module")].class;
        self.problem.ability(class).allows(layout, bonds, step)
    }

    /// Whether the robot stays connected during a move and after it, if it has to.
    ///
    /// Between two stations of a translation more holds than at either, so its stations
    /// decide. In a rotation the module hangs on its hinge until it rests on its landing face.
    pub fn stays_connected(&self, layout: &Layout, bonds: &[Bond], step: Move) -> bool {
        // The moving module goes by the cell that it leaves.
        let others = || bonds.iter().filter(|bond| !bond.touches(step.from)).map(|bond| bond.cells());
        !self.problem.must_stay_connected()
            || step.holders(layout).into_iter().all(|holders| {
                let own = holders.into_iter().map(|holder| [step.from, holder]);
                layout.is_connected_by(others().chain(own))
            })
    }

    /// Margin at rest.
    pub fn of_state(&self, layout: &Layout, bonds: &[Bond]) -> Worst {
        let ask = || self.oracle.of_state(&self.problem.placements(layout), bonds);
        if self.forgets {
            return ask();
        }
        self.at_rest.get((layout.clone(), bonds.to_vec()), |_| ask())
    }

    /// Upper bound on the margin of a move, whatever is engaged, from the
    /// moving module and its neighbours alone: infinite for translations, which many
    /// faces hold, and for rotations along ground or obstacles.
    pub fn at_most(&self, layout: &Layout, step: Move) -> f64 {
        if !self.stability || self.forgets || self.is_along_environment(step) {
            return f64::INFINITY;
        }
        let Some(pivot) = Neighbourhood::new(self.problem, layout, step) else { return f64::INFINITY };
        self.at_most.get(pivot, |_| self.oracle.at_most(self.problem.placements(layout), step))
    }

    /// Like [`at_most`](Self::at_most), of all samples of the module's own hold instead of a few: as tight as the hold alone
    /// can tell. Every margin of a move takes the worst of these samples into account.
    pub fn own_at_most(&self, layout: &Layout, step: Move) -> f64 {
        self.own_worst(layout, step).map_or(f64::INFINITY, |own| own.at_most)
    }

    fn own_worst(&self, layout: &Layout, step: Move) -> Option<Own> {
        if !self.stability || self.forgets || self.is_along_environment(step) {
            return None;
        }
        let pivot = Neighbourhood::new(self.problem, layout, step)?;
        Some(self.own_worst.get(pivot, |_| {
            let worst = self.oracle.own_worst(self.problem.placements(layout), step);
            Own { at_most: worst.margin.upper, phase: worst.instant.phase() }
        }))
    }

    /// Whether the module of a rotation may touch ground or an obstacle strictly between its
    /// ends: one that reaches into the smallest box around all it sweeps, or
    /// touches that box across the axis. Its other sides the module reaches at the ends only.
    fn is_along_environment(&self, step: Move) -> bool {
        let Some((cells, axis)) = plane(step) else { return false };
        let tolerance = TOUCH * self.pitch;
        let mut wider = Vec3::repeat(-tolerance);
        wider[axis.axis()] += 2.0 * tolerance;
        let room = self.around(&cells, wider);
        self.surroundings.may_touch(&room)
    }

    /// Whether the module of a move may touch ground or an obstacle anywhere on its way: one that reaches into the smallest
    /// box around all the cells that it passes through, or touches it.
    pub(super) fn is_beside_environment(&self, step: Move) -> bool {
        let cells: Vec<Cell> = step.room().into_iter().chain([step.from, step.to()]).collect();
        self.surroundings.may_touch(&self.around(&cells, Vec3::repeat(TOUCH * self.pitch)))
    }

    /// The smallest box around some cells, wider by so much on either side.
    fn around(&self, cells: &[Cell], wider: Vec3) -> Solid {
        let corner = |extreme: fn(i32, i32) -> i32| -> Cell {
            std::array::from_fn(|i| cells.iter().map(|cell| cell[i]).reduce(extreme).expect("a module's own cell"))
        };
        let [low, high] = [corner(i32::min), corner(i32::max)].map(|cell| Placement::new(cell).centre(self.pitch));
        let half_extents = (high - low) / 2.0 + Vec3::repeat(self.pitch / 2.0) + wider;
        let centre = Pose::from_parts(((low + high) / 2.0).into(), Rotation::identity());
        Solid::new(Shape::Cuboid { half_extents }, centre)
    }

    /// Margin of a move out of a state with these connections: of all its
    /// transient states and of the state at rest that it ends in.
    ///
    /// Stops as soon as one state's margin is proved to be below `floor`; then
    /// the lower end is minus infinity.
    pub fn of_move(&self, layout: &Layout, bonds: &[Bond], step: Move, floor: f64) -> Worst {
        let ask = || {
            let placements = self.problem.placements(layout);
            let worst = self.oracle.of_move(placements.clone(), bonds, step, floor);
            match self.own_worst(layout, step) {
                // What it hangs on may be worst at a moment that the samples of the whole robot leave out.
                Some(own) if own.at_most < worst.margin.upper && !worst.is_out(floor) => {
                    worst.or_worse(self.oracle.of_phase(placements, bonds, step, own.phase))
                }
                _ => worst,
            }
        };
        let by_its_hold = || {
            let mut held = self.held.lock().expect("no thread panics while it asks how modules are held");
            let is_along = self.is_beside_environment(step);
            self.oracle.timed(|| held.margin((self.problem, &self.oracle), layout, bonds, step, is_along))
        };
        let course = || match floor == f64::NEG_INFINITY && !self.forgets {
            // Whole answers come from the search to the plan.
            true => self.courses.get((layout.clone(), bonds.to_vec(), step), |_| by_its_hold().unwrap_or_else(ask)),
            false => ask(),
        };
        match step.motion {
            // The state at rest after a translation is the one at its last phase.
            Motion::Translation { .. } => course(),
            Motion::Rotation { .. } => {
                let settled = self.of_state(&self.after(layout, step), &bonds_after(layout, bonds, step));
                if settled.is_out(floor) {
                    return settled.cut_short();
                }
                let worst = course();
                if worst.is_out(floor) { worst } else { worst.or_worse(settled) }
            }
        }
    }
}

/// The connections after a move, ascending.
pub fn bonds_after(layout: &Layout, bonds: &[Bond], step: Move) -> Vec<Bond> {
    let others = bonds.iter().copied().filter(|bond| !bond.touches(step.from));
    let mut after: Vec<Bond> = others.chain(step.landing(layout)).collect();
    after.sort_unstable();
    after
}

/// A margin as a width.
pub fn width(margin: Bracket) -> Width {
    Width { lower: margin.lower, upper: margin.upper }
}
