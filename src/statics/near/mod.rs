//! States near one that was assessed before: bounds before solving.
//!
//! Limit-analysis duality does not ask where a field comes from. *Any* wrench
//! field that balances and stays in the friction cones bounds the utilisation
//! from above by its largest demand; *any* twist field that every link admits
//! bounds it from below by power over dissipation. So the two fields of a
//! neighbouring state, carried over and repaired, bound this one, and where their
//! bracket answers the question nothing is solved:
//!
//! - `memory` keeps the fields of an answer and finds them again by the bodies
//!   that the caller matches; what is not found carries nothing and moves with
//!   its neighbours.
//! - *Lower bound* (`opening`). Links that are gone only free the motion. What a
//!   new link does not admit is repaired by the least share of a field that opens
//!   every link: expansion from a point behind the supports, or the twists that push
//!   all wrenches towards the middles of their cones.
//! - *Upper bound* (`give`, `room`). What a link that is gone leaves unbalanced is
//!   spread over all others by the change that is least in the metric of the
//!   cones' barriers at the carried field, strengths at the threshold: one
//!   factorisation of 6 x 6 blocks on the body graph. Where that overloads a link,
//!   its wrench is put back into its cone (`put_back`) and the next round begins there.
//!   Faces are carried by the forces at their points (`field`), which prove what the faces
//!   hold without an optimisation of their own.
//! - The same factorisation yields twists: if the loads win, the way in which they do. It is
//!   remembered too: where only loads changed, or a link came, it mostly balances again.
//!
//! Wrong or useless fields cost tightness, never soundness: `bracket` evaluates
//! all bounds on this structure's own data, exactly as it does for solvers. A
//! block that the bracket leaves open is solved as always.
//!
//! Knows nothing of how a caller finds neighbours, and keeps no state of its own.

mod carry;
mod field;
mod give;
mod ladder;
mod memory;
mod opening;
mod put_back;
mod room;

pub use memory::{Memory, NotNear};

use super::assess::assess_with;
use super::assessment::{Assessment, Question};
use super::reductions::Reductions;
use super::structure::Structure;
use super::validate::{InvalidStructure, validate};
use carry::Carried;

/// As [`assess`](super::assess), with what [`assess_near`] can use for neighbouring states.
///
/// # Errors
/// As for [`assess`](super::assess).
pub fn assess_keeping(
    structure: &Structure,
    question: Question,
) -> Result<(Assessment, Memory), Vec<InvalidStructure>> {
    validate(structure)?;
    let mut carried = Carried::nothing(structure, question);
    let answer = assess_with(structure, question, Reductions::ALL, &mut carried);
    let memory = carried.into_memory(&answer);
    Ok((answer, memory))
}

/// As [`assess`](super::assess), for a structure that differs little from the one that `memory`
/// is of: a connection more or less, a module elsewhere, another load.
///
/// `matching` says for every body of `structure` which body of the remembered structure it
/// is, `None` for a new one. Connections and contacts are matched by their ends, connector and
/// position. The bracket is as sound as that of `assess` whatever the memory and the
/// matching; what does not fit only makes it more likely that blocks have to be solved.
/// [`Assessment::decided_by`] says what it took. Most is gained with
/// [`Question::Decide`]; with [`Question::ToGap`] only blocks that did not change are
/// answered from memory.
///
/// The result depends on the arguments alone, to the last bit.
///
/// # Errors
/// As for [`assess`](super::assess), or when `matching` has not one entry per body or names
/// a body that was not there.
///
/// ```
/// use steadfast::spatial::{Pose, Rotation, Vec3};
/// use steadfast::statics::{
///     Anchor, Body, Connection, Connector, Model, Question, Rung, Structure, Tally, Verdict, assess_keeping,
///     assess_near,
/// };
///
/// // A plate of 2 kg that hangs from the ceiling by four magnets of 25 N.
/// let model = Model::Cone { friction: [0.5, 0.5], radius: [0.02, 0.02, 0.02] };
/// let mut plate = Structure { gravity: Vec3::new(0.0, 0.0, -9.81), ..Structure::default() };
/// plate.bodies.push(Body { mass: 2.0, com: Vec3::zeros(), fixed: false });
/// plate.connectors.push(Connector { name: "magnet".to_owned(), strength: 25.0, model });
/// let down = Rotation::from_axis_angle(&Vec3::x_axis(), std::f64::consts::PI);
/// for at in [[0.1, 0.1], [-0.1, 0.1], [-0.1, -0.1], [0.1, -0.1]] {
///     let frame = Pose::from_parts(Vec3::new(at[0], at[1], 0.05).into(), down);
///     plate.connections.push(Connection { parent: Anchor::World, child: Anchor::Body(0), connector: 0, frame });
/// }
/// let question = Question::Decide(1.0);
/// let (answer, memory) = assess_keeping(&plate, question).expect("the data is sound");
/// let mut tally = Tally::default();
/// tally.count(&answer);
///
/// // Without one of them the other three hold it: no need to solve again.
/// plate.connections.pop();
/// let (answer, _memory) = assess_near(&plate, question, &memory, &[Some(0)]).expect("the same plate");
/// tally.count(&answer);
/// assert_eq!(answer.verdict, Verdict::Stable);
/// assert_eq!(tally.of(Rung::CarriedOver), 1);
/// ```
pub fn assess_near(
    structure: &Structure,
    question: Question,
    memory: &Memory,
    matching: &[Option<usize>],
) -> Result<(Assessment, Memory), NotNear> {
    validate(structure).map_err(NotNear::Structure)?;
    memory.check(structure, matching)?;
    let mut carried = Carried::new(structure, question, memory, matching);
    let answer = assess_with(structure, question, Reductions::ALL, &mut carried);
    let memory = carried.into_memory(&answer);
    Ok((answer, memory))
}
