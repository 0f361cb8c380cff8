//! What the core finds wrong with a robot, as problems of the file it came from.

use super::super::codes::{self, Code};
use super::super::findings::{Findings, Place};
use super::super::json::clipped;
use crate::robot::{Fault, Part, Problem};

/// Reports the problems of a catalogue that stands at `place` and has so many built-in motions before its own.
pub(super) fn of_catalogue(problems: &[Problem], built_in: usize, place: &Place<'_>, findings: &mut Findings) {
    let motion = |index: usize| place.key("motions").entry(index.saturating_sub(built_in));
    for problem in problems {
        let part = match problem.part {
            Part::Connector(index) => place.key("connectors").entry(index),
            Part::MotionType(index) => motion(index),
            Part::Stencil(index, stencil) => stencil_place(&motion(index).index(stencil), problem),
            Part::MotionOfType(index, i) => place.key("module_types").entry(index).key("motions").index(i),
            Part::ModuleType(index) => place.key("module_types").entry(index),
            Part::BodyType(index, body) => place.key("module_types").entry(index).key("bodies").index(body),
            Part::JointType(index, joint) => place.key("module_types").entry(index).key("joints").index(joint),
            Part::PortType(index, port) => place.key("module_types").entry(index).key("ports").index(port),
            _ => place.clone(),
        };
        report(problem, &field(&part, problem.field), &[], findings);
    }
}

/// The key of the stencil at `place` that a problem is about.
fn stencil_place<'a>(place: &Place<'a>, problem: &Problem) -> Place<'a> {
    let list = match problem.field {
        "by" => return place.key("to"),
        "towards" => return place.key("about").key("towards"),
        "" => return place.clone(),
        list => place.key(list),
    };
    match problem.fault {
        Fault::FarCell { cell }
        | Fault::OwnCell { cell }
        | Fault::OccupiedAndFree { cell }
        | Fault::InTheWay { cell } => list.index(cell),
        _ => list,
    }
}

/// Reports the problems of a robot that stands at `place`, with modules of these ids.
pub(super) fn of_robot(problems: &[Problem], ids: &[&str], place: &Place<'_>, findings: &mut Findings) {
    for problem in problems {
        let part = match problem.part {
            Part::Module(index) => place.key("modules").index(index),
            Part::Connection(index) => place.key("connections").index(index),
            Part::Obstacle(index) => place.key("environment").key("obstacles").index(index),
            Part::Load(index) => place.key("loads").index(index),
            _ => place.clone(),
        };
        report(problem, &field(&part, problem.field), ids, findings);
    }
}

/// Reports one fault of what is at `place`, of a robot with modules of these ids.
pub(super) fn of_place(fault: Fault, ids: &[&str], place: &Place<'_>, findings: &mut Findings) {
    report(&Problem::new(Part::Configuration, "", fault), place, ids, findings);
}

/// The key that holds a field of the core's.
fn field<'a>(part: &Place<'a>, name: &str) -> Place<'a> {
    let keys: &[&str] = match name {
        "points" => &["points_m"],
        "face" => &["connector"],
        "hinge" => &["hinge"],
        "module_type" => &["type"],
        "placement" => &["cell"],
        "half_extents" if part.key("bodies").node().is_some() => {
            return measures(&part.key("bodies").index(0).key("shape"));
        }
        "surface" => &["surface"],
        "range" => &["range_deg"],
        "joints" => &["joints"],
        "com" => return part.key("bodies").index(0).key("com_m"),
        _ => &[],
    };
    keys.iter().fold(part.clone(), |place, key| place.key(key))
}

/// Where the measures of a shape are.
fn measures<'a>(shape: &Place<'a>) -> Place<'a> {
    let cuboid = shape.key("cuboid");
    if cuboid.node().is_some() { cuboid.key("half_extents_m") } else { shape.clone() }
}

fn report(problem: &Problem, place: &Place<'_>, ids: &[&str], findings: &mut Findings) {
    if let Some((code, message, hint)) = describe(problem, ids) {
        let hint = (!hint.is_empty()).then(|| hint.to_string());
        findings.add(place, code, message, hint);
    }
}

/// Code, message and hint; `None` for what was said already when the file's
/// form and names were checked.
pub(super) fn describe(problem: &Problem, ids: &[&str]) -> Option<(Code, String, &'static str)> {
    let module = |index: usize| match ids.get(index) {
        Some(id) => format!("module `{}`", clipped(id)),
        None => format!("module {index}"),
    };
    let owned = str::to_string;
    Some(match problem.fault {
        Fault::NotFinite
        | Fault::NotPositive
        | Fault::Negative
        | Fault::OutOfRange { .. }
        | Fault::DuplicateName { .. }
        | Fault::FarCell { .. }
        | Fault::NoBodies
        | Fault::NoModules => return None,
        Fault::OriginOutsidePatch => (
            codes::OFF_CENTRE,
            owned("the origin is not in the convex hull of the points"),
            "the preload acts at the origin and must press on the points: move the points, or the connection's frame",
        ),
        Fault::HingeNotBox => (
            codes::UNSUPPORTED,
            owned("a hinge must be a `box` connector"),
            "its z axis lies along the edge, its torsion is the drive",
        ),
        Fault::NoStencils => {
            (codes::MISSING_KEY, owned("there is no way to make this motion"), "list at least one way")
        }
        Fault::NotTheBuiltIn => {
            (codes::DUPLICATE_ID, owned("has the name of a built-in motion"), "give it a name of its own")
        }
        Fault::NoDisplacement => (
            codes::OUT_OF_RANGE,
            owned("the module would stay where it is"),
            "`to` is the cell that it arrives in, counted from its own",
        ),
        Fault::NoEdge => (
            codes::MIXED,
            owned("the faces towards the support and in this direction share no edge"),
            "the edge lies between two faces that are perpendicular to each other",
        ),
        Fault::OwnCell { .. } => {
            (codes::MIXED, owned("this is the module's own cell"), "leave it out: cells are counted from the module's")
        }
        Fault::OccupiedAndFree { .. } => {
            (codes::MIXED, owned("this cell must be `occupied` as well"), "leave it out of one of the two lists")
        }
        Fault::InTheWay { .. } => (
            codes::OVERLAP,
            owned("the module would pass through this cell, which must hold another"),
            "a translation sweeps all cells on its line; a turn also those that its far corner bulges into",
        ),
        Fault::NothingAlongside { at } => (
            codes::DISCONNECTED,
            format!("nothing holds the module where it is in cell {at:?}"),
            "list a module beside it (across its direction) there: faces hold as far as they overlap",
        ),
        Fault::NoSupport { support } => (
            codes::DISCONNECTED,
            format!("the support {support:?} is missing"),
            "the module that carries the hinge must be there: list its cell",
        ),
        Fault::NoLanding { landing } => (
            codes::DISCONNECTED,
            format!("the module lands on cell {landing:?}, which need not hold another"),
            "after a quarter turn it docks to the neighbour of its support: list that cell",
        ),
        Fault::NoWayBack => (
            codes::MIXED,
            owned("no way of this motion leads back, and every action must be reversible"),
            "add the reverse, which may need no more than is there on arrival; or say \"mirrored\": true if a mirror image does",
        ),
        Fault::NoHinge => (
            codes::MIXED,
            owned("this motion turns about an edge, and the module type has no hinge"),
            "give the module type a `hinge`: the connector that holds it at the edge",
        ),
        Fault::NotACell => (
            codes::MIXED,
            owned("a lattice module is a cube whose edge is the pitch"),
            "each half extent is half of `pitch_m`",
        ),
        Fault::NotSymmetric => (
            codes::UNSUPPORTED,
            owned("a lattice module must be the same in all 24 orientations of a cube"),
            "put the centre of mass at the centre, and give the face connector equal values along x and y",
        ),
        Fault::DifferentPitch { first } => {
            let message = format!("the pitch of its type is not that of {}", module(first));
            (codes::MIXED, message, "all lattice modules of a configuration share one pitch")
        }
        Fault::SameCell { other } => {
            (codes::OVERLAP, format!("{} is in this cell already", module(other)), "two modules cannot be in one place")
        }
        Fault::BelowGround => (
            codes::OVERLAP,
            owned("the module reaches below the ground"),
            "raise the module, or lower `environment.ground.height_m`",
        ),
        Fault::InsideObstacle { obstacle } => {
            let message = format!("the module overlaps obstacle {obstacle}");
            (
                codes::OVERLAP,
                message,
                "obstacles are counted from 0; `position_m` is the centre of an obstacle, half extents reach to both sides",
            )
        }
        Fault::Disconnected => {
            let message = format!("no chain of connections leads to {}", module(0));
            (codes::DISCONNECTED, message, "connect it, or say \"require\": {\"connected\": false} in the start")
        }
        Fault::SelfConnection => {
            (codes::SELF_CONNECTION, owned("connects a module with itself"), "a connection joins ports of two modules")
        }
        Fault::FacesApart => (
            codes::APART,
            owned("the two faces do not lie on each other"),
            "ports are the modules' own faces: check the cells, and the rotations if there are any",
        ),
        Fault::DuplicateConnection { first } => (
            codes::DUPLICATE_CONNECTION,
            format!("joins the same two ports as connections[{first}]"),
            "remove one of the two",
        ),
        Fault::ConnectorsDoNotFit => (
            codes::MIXED,
            owned("the connectors of the two faces are of different models"),
            "only connectors of one model engage: leave this connection out",
        ),
        Fault::NotATree => (
            codes::MIXED,
            owned("the joints do not make the bodies one tree"),
            "n bodies need n - 1 joints, each leading to a body that no other joint leads to",
        ),
        Fault::RangeWithoutZero => (
            codes::OUT_OF_RANGE,
            owned("the range leaves out 0"),
            "at 0 the frames of all bodies coincide: count angles from a position within the range",
        ),
        Fault::SurfaceNotABall => (
            codes::UNSUPPORTED,
            owned("connectors engage anywhere on the surface of a ball only"),
            "make the body's shape a \"ball\", or give the port a position and an axis",
        ),
        Fault::PatchWithoutFace => (
            codes::MIXED,
            owned("a `patch` without points takes the corners of a cube's face, and this port has none"),
            "give the connector `points_m`",
        ),
        Fault::WrongJointCount { joints } => {
            (codes::MIXED, format!("its type has {joints} joints"), "give each joint one position")
        }
        Fault::BeyondRange { joint } => {
            (codes::OUT_OF_RANGE, format!("joint number {} is beyond its range", joint + 1), "see its `range_deg`")
        }
        Fault::PortsApart => (
            codes::APART,
            owned("the two ports do not meet"),
            "ports meet at one point, looking at each other, at an angle at which they engage; a port meets a surface where it lies on it and looks at its centre",
        ),
        Fault::PortsDoNotFit => (
            codes::MIXED,
            owned("no connector holds these two ports together"),
            "two ports at points need connectors of one model, a port on a surface needs a connector",
        ),
        Fault::OverlapsModule { other } => {
            (codes::OVERLAP, format!("overlaps {}", module(other)), "two modules cannot be in one place")
        }
    })
}
