//! One plan of `plan/1` to a plan of the planner, whatever the robot.

use super::super::codes;
use super::super::findings::{Findings, Place};
use super::super::wire;
use crate::reconfigure::{Bottleneck, IfStronger, Moment, Plan, PlannedAction, Which};
use crate::statics::Bracket;

/// What reading a plan has to know of a family of robots.
pub(super) trait Family {
    /// What its modules do.
    type Action;
    /// What names one of its connections.
    type Connection;

    /// Begins the plan with this number of its file.
    fn begin(&mut self, plan: usize);

    /// The action with this index of the plan, at `place`.
    fn action(
        &mut self,
        index: usize,
        wire: &wire::Action,
        place: &Place<'_>,
        findings: &mut Findings,
    ) -> Option<Self::Action>;

    /// What holds between two ports, or in a joint, of the start's or the goal's modules; `place` has the
    /// keys `connection` and `joint`. `None` where that is not understood.
    fn connection(
        &self,
        which: Which,
        held: Held<'_>,
        place: &Place<'_>,
        findings: &mut Findings,
    ) -> Option<Self::Connection>;
}

/// What a file says that holds.
#[derive(Clone, Copy)]
pub(super) enum Held<'w> {
    /// A connection of two ports.
    Ports(&'w [String; 2]),
    /// A joint.
    Joint(&'w wire::JointOf),
}

impl<'w> Held<'w> {
    /// What two keys say, of which at most one may be there.
    pub(super) fn of(
        connection: Option<&'w [String; 2]>,
        joint: Option<&'w wire::JointOf>,
        place: &Place<'_>,
        findings: &mut Findings,
    ) -> Option<Self> {
        match (connection, joint) {
            (Some(_), Some(_)) => {
                let message = "the margin hangs on a connection already";
                findings.add(&place.key("joint"), codes::PLAN, message, "name one of the two".to_string());
                None
            }
            (ports, joint) => ports.map(Self::Ports).or(joint.map(Self::Joint)),
        }
    }
}

/// What a file says of one plan.
pub(super) struct Parts<'w> {
    pub(super) margin: Option<wire::Bracket>,
    pub(super) moves: Option<u32>,
    pub(super) bottleneck: Option<&'w wire::Bottleneck>,
    pub(super) actions: &'w [wire::Action],
    pub(super) profile: &'w [wire::Moment],
    pub(super) if_stronger: Option<wire::IfStronger>,
}

impl<'w> Parts<'w> {
    /// Those of a plan that is not the best.
    pub(super) fn of(wire: &'w wire::Alternative) -> Self {
        let wire::Alternative { margin, moves, bottleneck, actions, profile, if_stronger } = wire;
        let (moves, bottleneck, if_stronger) = (Some(*moves), bottleneck.as_ref(), *if_stronger);
        Self { margin: *margin, moves, bottleneck, actions, profile, if_stronger }
    }
}

/// The plan at `place`, which is number `plan` of its file. What it claims is
/// taken as it stands: a replay tells whether it holds.
pub(super) fn sequence<F: Family>(
    family: &mut F,
    plan: usize,
    parts: Parts<'_>,
    place: &Place<'_>,
    findings: &mut Findings,
) -> Option<Plan<F::Action, F::Connection>> {
    family.begin(plan);
    let actions_place = place.key("actions");
    let mut actions = Vec::with_capacity(parts.actions.len());
    for (index, wire) in parts.actions.iter().enumerate() {
        let (margin, phase) = wire.worth();
        let action = family.action(index, wire, &actions_place.index(index), findings);
        actions.push(action.map(|action| PlannedAction {
            action,
            margin: margin.map(bracket),
            phase: phase.map(|phase| phase.0),
        }));
    }
    let bottleneck = parts.bottleneck.map(|wire| {
        let place = place.key("bottleneck");
        let held = Held::of(wire.connection.as_ref(), wire.joint.as_ref(), &place, findings);
        let connection = held.and_then(|held| family.connection(Which::Start, held, &place, findings));
        Bottleneck { action: wire.action.map(|action| action as usize), phase: wire.phase.0, connection }
    });
    let actions = actions.into_iter().collect::<Option<Vec<_>>>()?;
    let moment = |wire: &wire::Moment| Moment {
        action: wire.action.map(|action| action as usize),
        phase: wire.phase.0,
        margin: bracket(wire.margin),
    };
    let gain = |wire: wire::IfStronger| IfStronger { factor: wire.factor.0, margin: bracket(wire.margin) };
    Some(Plan {
        margin: parts.margin.map(bracket),
        moves: parts.moves.unwrap_or_default(),
        bottleneck,
        actions,
        profile: parts.profile.iter().map(moment).collect(),
        if_stronger: parts.if_stronger.map(gain),
    })
}

/// An end where nothing was proved is infinite.
pub(super) fn bracket(wire: wire::Bracket) -> Bracket {
    Bracket::new(wire.lower.0.unwrap_or(f64::NEG_INFINITY), wire.upper.0.unwrap_or(f64::INFINITY))
}
