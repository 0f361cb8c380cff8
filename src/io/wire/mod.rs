//! The files' own types: key for key what the formats say, and nothing more.
//!
//! The JSON Schemas, which also check every file that is read, are made from
//! these types. Knows no core type; [`super::read`] and [`super::write`] convert.

mod action;
mod catalogue;
mod certificate;
mod check;
mod configuration;
mod connector;
mod errors;
mod gives_way;
mod in_the_way;
mod load_range;
mod motion;
mod number;
mod outcome;
mod partial_order;
mod plan;
mod result;
mod rofi;
mod structure;
mod suite;
mod terrain;

pub(super) use action::{Action, Axis, CellTarget, Half, JointOf, SpotTarget, TurnAbout};
pub(super) use catalogue::{BodyType, Catalogue, CatalogueFormat, Faces, Joint, ModuleType, PortType, Ports, Shape};
pub(super) use certificate::{
    Carried, CarriedPoints, CarriedWrench, Certificate, CertificateFormat, Mechanism, Stress, Twist,
};
pub(super) use check::{
    Check, CheckFormat, CheckedConnection, CheckedContact, Distribution, Explanation, LeftOut, Level, Order,
    RemainingBlock, Verdict, Wrench,
};
pub(super) use configuration::{
    CatalogueRef, Configuration, ConfigurationFormat, Connections, Environment, FrameMatch, Ground, Match, Module,
    ModuleLoad, ModuleMatch, Obstacle, PairConnection, Region, Require, RolledConnection,
};
pub(super) use connector::Connector;
pub(super) use errors::{Errors, ErrorsFormat, FileError};
pub(super) use gives_way::{ContactMotion, GivesWay, MovingContact};
pub(super) use in_the_way::{InTheWay, Nearest, TooWeak};
pub(super) use load_range::{Failure, LoadRange, LoadRangeFormat, RangeEnd, RangeOutcome};
pub(super) use motion::{Edge, Stencil};
pub(super) use number::{AngleRange, Bound, Limit, NonNegative, Positive, Real, reals};
pub(super) use outcome::{Impossible, Outcome, StoppedBy, Which};
pub(super) use partial_order::{CheckedMoments, OrderedAction, PartialOrder, PartialOrderFormat, Wait};
pub(super) use plan::{
    Alternative, Answers, Bottleneck, Bracket, IfStronger, Moment, Objective, Plan, PlanFormat, Proof, Statistics,
};
pub(super) use result::{Asked, FoundPlan, JobEnding, JobResult, PlanFlaw, ReplayOf, ResultFormat, TracePoint};
pub(super) use rofi::{
    ComponentOf, CoordinateAxis, Direction, DockOf, IdentityTransform, ModuleJoint, NameOrNumber, PlacingJoint,
    PlacingKind, RofiModule, RofiWorld, SpaceJoint, Transform, Voxel, VoxelWorld,
};
pub(super) use structure::{Body, Connection, Contact, Load, Structure, StructureFormat};
pub(super) use suite::{GoalOrigin, PlannerName, RobotFamily, Seeds, Suite, SuiteCase, TerrainKind};
pub(super) use terrain::{Mesh, Terrain};
