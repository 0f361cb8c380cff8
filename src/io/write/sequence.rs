//! One plan to its actions in `plan/1`, whatever the robot.

use super::super::wire::{self, Real};
use super::{Unwritable, bracket};
use crate::reconfigure::{Bottleneck, Moment, Plan, PlannedAction, Which};

/// What is written of an action besides itself: its margin, and the phase where that is.
pub(super) type Worth = (Option<wire::Bracket>, Option<Real>);

/// What holds, as files name it: a connection, or a joint.
pub(super) type Named = (Option<[String; 2]>, Option<wire::JointOf>);

/// What writing a plan has to know of a family of robots.
pub(super) trait Family {
    /// What its modules do.
    type Action;
    /// What names one of its connections.
    type Connection: Copy;

    /// Begins the plan with this number of its file.
    fn begin(&mut self, plan: usize);

    /// The action with this index of the plan.
    fn action(&mut self, index: usize, action: &Self::Action, worth: Worth) -> Result<wire::Action, Unwritable>;

    /// What holds between the modules of the start or the goal.
    fn held(&self, which: Which, held: Self::Connection) -> Result<Named, Unwritable>;
}

/// A plan, which is number `number` of its file.
pub(super) fn sequence<F: Family>(
    family: &mut F,
    number: usize,
    plan: &Plan<F::Action, F::Connection>,
) -> Result<wire::Alternative, Unwritable> {
    family.begin(number);
    let mut actions = Vec::with_capacity(plan.actions.len());
    for (index, PlannedAction { action, margin, phase }) in plan.actions.iter().enumerate() {
        actions.push(family.action(index, action, (margin.map(bracket), phase.map(Real)))?);
    }
    Ok(wire::Alternative {
        actions,
        margin: plan.margin.map(bracket),
        moves: plan.moves,
        bottleneck: plan.bottleneck.as_ref().map(|found| bottleneck(family, found)).transpose()?,
        profile: plan.profile.iter().map(moment).collect(),
        if_stronger: plan
            .if_stronger
            .map(|gain| wire::IfStronger { factor: wire::Positive(gain.factor), margin: bracket(gain.margin) }),
    })
}

fn moment(moment: &Moment) -> wire::Moment {
    wire::Moment {
        action: moment.action.map(|action| u32::try_from(action).unwrap_or(u32::MAX)),
        phase: Real(moment.phase),
        margin: bracket(moment.margin),
    }
}

fn bottleneck<F: Family>(family: &F, bottleneck: &Bottleneck<F::Connection>) -> Result<wire::Bottleneck, Unwritable> {
    let held = bottleneck.connection.map(|held| family.held(Which::Start, held)).transpose()?;
    let (connection, joint) = held.unwrap_or_default();
    Ok(wire::Bottleneck {
        action: bottleneck.action.map(|action| u32::try_from(action).unwrap_or(u32::MAX)),
        phase: Real(bottleneck.phase),
        connection,
        joint,
    })
}
