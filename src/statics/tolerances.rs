//! Every tolerance of the oracle, with its unit and its reason.

/// Relative accuracy to which data are taken to be meant (dimensionless).
///
/// Decimal input is rounded to binary and rotations to unit quaternions, so a
/// load that should act exactly along a frictionless floor does so only up to
/// rounding. A force or torque below this fraction of the loads that flow
/// through its body counts as none. It is four orders above the rounding of one
/// operation and three below the closest call the oracle is asked to settle.
pub(super) const DATA: f64 = 1e-12;

/// Largest accepted imbalance of a body in a wrench field that serves as upper
/// bound, as a fraction of the loads that flow through the body (dimensionless).
/// What is left is charged to the bound, see `bracket`.
pub(super) const BALANCE: f64 = 1e-11;

/// Relative rounding error of one evaluated sum of products (dimensionless):
/// a few units in the last place.
pub(super) const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Share of a mechanism's dissipation from which a connection counts as
/// critical (dimensionless): above the solver's noise, below any true share.
pub(super) const CRITICAL_SHARE: f64 = 1e-5;

/// Relative distance to the largest utilisation within which connections whose
/// wrench is known in closed form share the role of the weakest.
pub(super) const TIE: f64 = 1e-9;

/// How far a unit vector or quaternion may be from unit length.
pub(super) const UNIT: f64 = 1e-6;

/// Relative distance to the largest utilisation within which a connection counts as
/// at its limit: ten times what a utilisation may be off.
pub(super) const AT_LIMIT: f64 = 1e-6;
