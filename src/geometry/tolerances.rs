//! Every tolerance of this module, with its unit and its reason.

/// Gap or penetration, relative to the size of the solids, up to which they
/// count as touching. A million times the rounding of poses that are derived from
/// integers, and far below any real play.
pub const TOUCH: f64 = 1e-6;

/// Penetration, relative to the size of the solids, up to which they count as
/// free of collision: touching solids that slide along each other penetrate by
/// rounding. Far above [`TOUCH`], so that what touches never collides.
pub const SKIN: f64 = 1e-4;

/// Gap, relative to the size of the moving solid, below which its shrunk
/// copy has arrived at an obstacle: a thousandth of the [`SKIN`] that it was
/// shrunk by.
pub(super) const ARRIVED: f64 = 1e-7;

/// Depth of an inscribed prism's sides below the cylinder that moves in its place, relative to
/// the [`SKIN`]: together they stay below the skin's diagonal.
pub(super) const SAGITTA: f64 = 0.7;

/// Steps after which a solid that still scrapes along an obstacle within
/// [`ARRIVED`] counts as colliding. Cubes among cubes take one or two steps each;
/// of 100 000 random sweeps the longest took 157.
pub(super) const MAX_STEPS: usize = 10_000;

/// Sine of the angle up to which two contact normals count as one: a hundred
/// times the tilt by which two faces can touch in all their corners.
pub(super) const SAME_NORMAL: f64 = 100.0 * TOUCH;

/// Squared sine of the angle below which two edges count as parallel: there
/// their cross product is rounding, and the faces give its direction.
pub(super) const PARALLEL: f64 = 1e-16;
