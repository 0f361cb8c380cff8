//! What contacts do in a collapse mechanism.

use super::assessment::Assessment;
use super::blocks::Link;
use super::frame::LinkFrame;
use super::structure::Structure;

/// What a contact does in a motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ContactMotion {
    /// Its two sides move as one there.
    Rests,
    /// One slides along the other: friction is used up, or there is none.
    Slides,
    /// The two part.
    Opens,
}

/// Speed relative to the fastest contact below which nothing moves.
const AT_REST: f64 = 1e-5;

/// By how much faster than it would have to by sliding a contact opens before it counts as open,
/// relative to the speed.
const PARTS: f64 = 1e-2;

/// What every contact of `structure` does in the mechanism of its `assessment`, in the structure's
/// order: those that do not rest are used up where it gives way. In the mechanisms of the
/// cone program, sliding at friction mu lifts by mu times the way; only what opens faster than that parts.
pub fn contact_motions(structure: &Structure, assessment: &Assessment) -> Vec<ContactMotion> {
    let relative = |i: usize| {
        let frame = LinkFrame::new(structure, Link::Contact(i));
        frame.relative_twist(structure, |body| assessment.mechanism[body]).linear
    };
    let velocities: Vec<_> = (0..structure.contacts.len()).map(relative).collect();
    let fastest = velocities.iter().map(|v| v.norm()).fold(0.0, f64::max);
    let motion = |(v, contact): (&crate::spatial::Vec3, &super::structure::Contact)| {
        let (speed, sliding) = (v.norm(), v.xy().norm());
        if !(speed > AT_REST * fastest) {
            ContactMotion::Rests
        } else if v.z - contact.friction * sliding > PARTS * speed {
            ContactMotion::Opens
        } else {
            ContactMotion::Slides
        }
    };
    velocities.iter().zip(&structure.contacts).map(motion).collect()
}
