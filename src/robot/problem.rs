//! What can be wrong with a robot, and where.

use std::fmt;

use super::lattice::Cell;
use super::stencil::FARTHEST_CELL;

/// One thing that is wrong, at one place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Problem {
    /// The part that it concerns.
    pub part: Part,
    /// The part's field, by its name in this crate (without unit, e.g.
    /// `mass`); empty when it concerns the part as a whole.
    pub field: &'static str,
    /// What is wrong.
    pub fault: Fault,
}

/// A part of a catalogue or configuration, by index in its own list.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Part {
    /// One of [`Catalogue::connectors`](super::Catalogue::connectors).
    Connector(usize),
    /// One of [`Catalogue::motions`](super::Catalogue::motions).
    MotionType(usize),
    /// A stencil of a motion: the motion, then the stencil.
    Stencil(usize, usize),
    /// One of [`Catalogue::module_types`](super::Catalogue::module_types).
    ModuleType(usize),
    /// A motion of a module type: the type, then the place in its [`LatticeType::motions`](super::LatticeType::motions).
    MotionOfType(usize, usize),
    /// A body of a module type: the type, then the body.
    BodyType(usize, usize),
    /// A joint of a module type: the type, then the joint.
    JointType(usize, usize),
    /// A port of a module type: the type, then the port.
    PortType(usize, usize),
    /// The configuration itself: its gravity, its list of modules.
    Configuration,
    /// The environment, but for its ground and its obstacles.
    Environment,
    /// The ground.
    Ground,
    /// One of the obstacles.
    Obstacle(usize),
    /// One of the modules.
    Module(usize),
    /// One of the connections, in the order in which they stand.
    Connection(usize),
    /// One of the loads.
    Load(usize),
    /// The requirement.
    Requirement,
}

/// What is wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// A number is infinite or not a number.
    NotFinite,
    /// A number that must be above zero is not.
    NotPositive,
    /// A number that must not be below zero is.
    Negative,
    /// An index points beyond its list of `count` entries.
    OutOfRange {
        /// The index.
        index: usize,
        /// Length of the list.
        count: usize,
    },
    /// An earlier entry of the same list has the same name.
    DuplicateName {
        /// Its index.
        first: usize,
    },
    /// There is no module at all.
    NoModules,
    /// The origin is outside the convex hull of a patch's points, so that its preload
    /// would tear itself off.
    OriginOutsidePatch,
    /// A hinge that is not a `box` connector.
    HingeNotBox,
    /// A motion without a single way to make it.
    NoStencils,
    /// The name of a built-in motion, for something else.
    NotTheBuiltIn,
    /// A way that leads nowhere.
    NoDisplacement,
    /// The edge of a rotation lies between two faces that are not perpendicular.
    NoEdge,
    /// A cell of a stencil is beyond [`FARTHEST_CELL`](super::FARTHEST_CELL).
    FarCell {
        /// Index of the cell in its list.
        cell: usize,
    },
    /// A cell of a stencil is the module's own.
    OwnCell {
        /// Index of the cell in its list.
        cell: usize,
    },
    /// A cell must be filled and empty at once.
    OccupiedAndFree {
        /// Index of the cell among those that must be empty.
        cell: usize,
    },
    /// The way leads through a cell that must be filled.
    InTheWay {
        /// Index of the cell among those that must be filled.
        cell: usize,
    },
    /// Somewhere on a translation no module that the stencil needs is beside the moving one.
    NothingAlongside {
        /// The cell that the module is in there, or the first of them.
        at: Cell,
    },
    /// The support of a rotation is not among the cells that must be filled.
    NoSupport {
        /// Its cell.
        support: Cell,
    },
    /// The module that a rotation lands on is not among the cells that must be filled.
    NoLanding {
        /// Its cell.
        landing: Cell,
    },
    /// No way of the motion leads back, though every action must be reversible.
    NoWayBack,
    /// The module type has no hinge to turn about.
    NoHinge,
    /// The solid is not a cube of the pitch's edge length.
    NotACell,
    /// It changes when the module is turned in the lattice, where all 24
    /// orientations must be alike: a centre of mass off the centre, or a face connector that
    /// distinguishes x from y.
    NotSymmetric,
    /// The pitch differs from that of an earlier module.
    DifferentPitch {
        /// Index of the first module.
        first: usize,
    },
    /// An earlier module is in the same cell.
    SameCell {
        /// Its index.
        other: usize,
    },
    /// The module reaches below the ground.
    BelowGround,
    /// The module overlaps an obstacle.
    InsideObstacle {
        /// Index of the obstacle.
        obstacle: usize,
    },
    /// No chain of connections leads to the first module, though one is required.
    Disconnected,
    /// A connection of a module with itself.
    SelfConnection,
    /// A connection of two faces that do not coincide.
    FacesApart,
    /// An earlier connection joins the same two faces.
    DuplicateConnection {
        /// Its index.
        first: usize,
    },
    /// The connectors of the two faces are of different models.
    ConnectorsDoNotFit,
    /// A module type without a body.
    NoBodies,
    /// The joints do not make the bodies one tree: a body that no joint leads to, or a loop.
    NotATree,
    /// A range that leaves out the position zero, in which body frames coincide.
    RangeWithoutZero,
    /// A surface port on a body that is not a ball.
    SurfaceNotABall,
    /// A patch connector without points, which takes the corners of a cube's face, on another module.
    PatchWithoutFace,
    /// There are more or fewer joint positions than the type has joints.
    WrongJointCount {
        /// How many the type has.
        joints: usize,
    },
    /// A joint position beyond the joint's range.
    BeyondRange {
        /// Index of the joint.
        joint: usize,
    },
    /// A connection of two ports that do not meet, or meet at an angle at which they do not engage.
    PortsApart,
    /// A connection of two ports that no connector can hold together.
    PortsDoNotFit,
    /// Two modules overlap.
    OverlapsModule {
        /// Index of the other module.
        other: usize,
    },
}

impl Problem {
    pub(crate) const fn new(part: Part, field: &'static str, fault: Fault) -> Self {
        Self { part, field, fault }
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let dot = if self.field.is_empty() { "" } else { "." };
        write!(f, "{}{dot}{}: {}", self.part, self.field, self.fault)
    }
}

impl fmt::Display for Part {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Connector(i) => write!(f, "connectors[{i}]"),
            Self::MotionType(i) => write!(f, "motions[{i}]"),
            Self::Stencil(i, j) => write!(f, "motions[{i}].stencils[{j}]"),
            Self::ModuleType(i) => write!(f, "module_types[{i}]"),
            Self::MotionOfType(i, j) => write!(f, "module_types[{i}].motions[{j}]"),
            Self::BodyType(i, j) => write!(f, "module_types[{i}].bodies[{j}]"),
            Self::JointType(i, j) => write!(f, "module_types[{i}].joints[{j}]"),
            Self::PortType(i, j) => write!(f, "module_types[{i}].ports[{j}]"),
            Self::Configuration => f.write_str("configuration"),
            Self::Environment => f.write_str("environment"),
            Self::Ground => f.write_str("ground"),
            Self::Obstacle(i) => write!(f, "obstacles[{i}]"),
            Self::Module(i) => write!(f, "modules[{i}]"),
            Self::Connection(i) => write!(f, "connections[{i}]"),
            Self::Load(i) => write!(f, "loads[{i}]"),
            Self::Requirement => f.write_str("require"),
        }
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFinite => f.write_str("must be a finite number"),
            Self::NotPositive => f.write_str("must be greater than 0"),
            Self::Negative => f.write_str("must not be negative"),
            Self::OutOfRange { index, count } => write!(f, "index {index} is beyond the {count} there are"),
            Self::DuplicateName { first } => write!(f, "entry {first} has the same name"),
            Self::NoModules => f.write_str("there are no modules"),
            Self::OriginOutsidePatch => f.write_str("the origin must lie in the convex hull of the points"),
            Self::HingeNotBox => f.write_str("a hinge must be a box connector"),
            Self::NoStencils => f.write_str("there is no way to make this motion"),
            Self::NotTheBuiltIn => f.write_str("has the name of a built-in motion and is another"),
            Self::NoDisplacement => f.write_str("leads nowhere"),
            Self::NoEdge => f.write_str("the support and the side turned to must be perpendicular"),
            Self::FarCell { cell } => write!(f, "entry {cell} is more than {FARTHEST_CELL} cells away"),
            Self::OwnCell { cell } => write!(f, "entry {cell} is the module's own cell"),
            Self::OccupiedAndFree { cell } => write!(f, "entry {cell} must be filled and empty at once"),
            Self::InTheWay { cell } => write!(f, "entry {cell} must be filled and is in the way"),
            Self::NothingAlongside { at } => write!(f, "nothing holds the module in cell {at:?}"),
            Self::NoSupport { support } => write!(f, "the support {support:?} need not be filled"),
            Self::NoLanding { landing } => write!(f, "cell {landing:?}, which the module lands on, need not be filled"),
            Self::NoWayBack => f.write_str("no way of the motion leads back"),
            Self::NoHinge => f.write_str("turns about an edge, and the module type has no hinge"),
            Self::NotACell => f.write_str("a lattice module must be a cube whose edge is the pitch"),
            Self::NotSymmetric => f.write_str("must be the same in all 24 orientations of a cube"),
            Self::DifferentPitch { first } => write!(f, "the pitch differs from that of module {first}"),
            Self::SameCell { other } => write!(f, "module {other} is in the same cell"),
            Self::BelowGround => f.write_str("reaches below the ground"),
            Self::InsideObstacle { obstacle } => write!(f, "overlaps obstacle {obstacle}"),
            Self::Disconnected => f.write_str("is not connected to the first module"),
            Self::SelfConnection => f.write_str("connects a module with itself"),
            Self::FacesApart => f.write_str("the two faces do not coincide"),
            Self::DuplicateConnection { first } => write!(f, "connection {first} joins the same faces"),
            Self::ConnectorsDoNotFit => f.write_str("the connectors of the two faces are of different models"),
            Self::NoBodies => f.write_str("there are no bodies"),
            Self::NotATree => f.write_str("the joints must make the bodies one tree"),
            Self::RangeWithoutZero => f.write_str("the range must contain 0, where the bodies' frames coincide"),
            Self::SurfaceNotABall => f.write_str("a surface port must sit on a ball"),
            Self::PatchWithoutFace => f.write_str("a patch without points needs the face of a lattice module"),
            Self::WrongJointCount { joints } => write!(f, "the type has {joints} joints"),
            Self::BeyondRange { joint } => write!(f, "joint {joint} is beyond its range"),
            Self::PortsApart => f.write_str("the two ports do not meet"),
            Self::PortsDoNotFit => f.write_str("no connector holds the two ports together"),
            Self::OverlapsModule { other } => write!(f, "overlaps module {other}"),
        }
    }
}

/// A growing list of the problems of one thing.
pub(super) struct Findings(pub Vec<Problem>);

impl Findings {
    /// Adds a problem.
    pub fn add(&mut self, part: Part, field: &'static str, fault: Fault) {
        self.0.push(Problem::new(part, field, fault));
    }

    /// Adds one if some value is not finite.
    pub fn finite(&mut self, part: Part, field: &'static str, values: &[f64]) -> bool {
        let finite = values.iter().all(|v| v.is_finite());
        if !finite {
            self.add(part, field, Fault::NotFinite);
        }
        finite
    }

    /// Adds one if some value is not finite or not above zero.
    pub fn positive(&mut self, part: Part, field: &'static str, values: &[f64]) {
        if self.finite(part, field, values) && values.iter().any(|&v| v <= 0.0) {
            self.add(part, field, Fault::NotPositive);
        }
    }

    /// Adds one if some value is not finite or below zero.
    pub fn not_negative(&mut self, part: Part, field: &'static str, values: &[f64]) {
        if self.finite(part, field, values) && values.iter().any(|&v| v < 0.0) {
            self.add(part, field, Fault::Negative);
        }
    }

    /// Adds one if an index is beyond its list; whether it is within.
    pub fn in_range(&mut self, part: Part, field: &'static str, index: usize, count: usize) -> bool {
        if index >= count {
            self.add(part, field, Fault::OutOfRange { index, count });
        }
        index < count
    }

    /// Adds one for each name that an earlier one equals.
    pub fn distinct<'a>(&mut self, part: fn(usize) -> Part, field: &'static str, names: impl Iterator<Item = &'a str>) {
        let mut seen = std::collections::HashMap::new();
        for (index, name) in names.enumerate() {
            let first = *seen.entry(name).or_insert(index);
            if first != index {
                self.add(part(index), field, Fault::DuplicateName { first });
            }
        }
    }
}
