//! Contact points, overlap and swept collision of convex shapes.
//!
//! The only module that names `parry3d`. Knows shapes and poses; knows no
//! forces and no plans.
