//! A reconfiguration planner for modular robots in which every transient
//! state is proved stable.

pub mod geometry;
pub mod io;
pub mod reconfigure;
pub mod robot;
pub mod spatial;
pub mod statics;
