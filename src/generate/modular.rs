//! What random robots outside lattices have in common: attempts at a start, and goals for it.

use crate::geometry::linkage_problems;
use crate::reconfigure::linkage::wander;
use crate::robot::linkage::{Goal, Linkage};
use crate::robot::{Matching, Requirement};

use super::draw::{Draw, Purpose};
use super::setting::Setting;
use super::{ATTEMPTS, Failure, Family, Generated, GoalKind, Pair, Request, Tally, freesn, rofi, stands, walk_length};

/// Draws a problem of struts and nodes or of RoFI modules.
///
/// # Errors
/// What cannot be drawn, or was not found.
pub fn generate(request: &Request) -> Result<Generated, Failure> {
    if request.goal == GoalKind::Grown && request.difficulty.is_some() {
        return Err(Failure::NoDifficulty);
    }
    let mut tally = Tally::default();
    let mut draw = Draw::new(request.seed, Purpose::Start);
    let mut tries = Draw::new(request.seed, Purpose::Goal);
    for _ in 0..ATTEMPTS {
        let Some(start) = shape(request, None, &mut draw, &mut tally) else { continue };
        let (goal, difficulty) = match request.goal {
            GoalKind::Grown => {
                let mut shapes = (0..ATTEMPTS).filter_map(|_| shape(request, Some(&start), &mut tries, &mut tally));
                match shapes.next() {
                    Some(goal) => (goal, None),
                    None => continue,
                }
            }
            GoalKind::Walk => {
                let through = Linkage { require: requirement(request.margin), ..start.clone() };
                let walk = wander(&through, walk_length(request)?, &mut |count| tries.below(count));
                let walk = walk.map_err(Failure::Refused)?;
                if walk.moves == 0 {
                    tally.restarts += 1;
                    continue;
                }
                (Linkage { require: requirement(0.0), ..walk.end }, Some(walk.moves))
            }
        };
        let matching = Matching { labelled: false, free_frame: request.setting == Setting::Space && !request.held };
        let goal = Goal { linkage: goal, matching };
        return Ok(Generated { pair: Pair::Linkage { start, goal }, difficulty, tally });
    }
    Err(Failure::NoneFound(tally))
}

fn requirement(margin: f64) -> Requirement {
    Requirement { margin, ..Requirement::default() }
}

/// One attempt at a shape; a goal's first module is where that of its start is.
fn shape(request: &Request, start: Option<&Linkage>, draw: &mut Draw, tally: &mut Tally) -> Option<Linkage> {
    let grown = match request.family {
        Family::Rofi => rofi::grown(request, start, draw, tally),
        Family::Freesn | Family::Cubes => freesn::grown(request, draw, tally),
    };
    let stands = grown.filter(|shape| shape.problems().is_empty() && stands::modules(shape, request.margin));
    tally.restarts += u64::from(stands.is_none());
    stands
}

/// Adds what has just been added to the tally, and says whether it may stay: whether it hits nothing and, unless it
/// is too early to ask, the robot stands.
pub fn may_stay(shape: &mut Linkage, added: u64, margin: Option<f64>, tally: &mut Tally) -> bool {
    shape.connections = shape.touching();
    tally.drawn += added;
    if !linkage_problems(shape).is_empty() {
        tally.blocked += added;
        return false;
    }
    let falls = margin.is_some_and(|margin| !stands::modules(shape, margin));
    tally.unstable += if falls { added } else { 0 };
    !falls
}
