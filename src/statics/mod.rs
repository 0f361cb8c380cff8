//! The stability oracle: structure in, verdict and bracket out.
//!
//! Read in this order: [`Structure`] and [`Connector`] are the question,
//! [`Assessment`] is the answer, [`assess`] the way from one to the other:
//!
//! 1. `blocks` cuts the structure where a wrench is known from balance, after `leaves` has
//!    peeled off what hangs by one link, and `loads` lumps what hangs there;
//! 2. `closed_form` answers for bridges, with the connectors' `demand`;
//! 3. `program` states every other block as a second-order cone program, `planar` finds
//!    those that lie in a plane, and `interior_point` solves it, with `conic` behind it, a
//!    general solver; `solve_block` asks them in turn;
//! 4. `bracket` proves bounds from the fields that come back, after `balance`
//!    has made the wrenches balance; `collapse` proves that no strength helps;
//! 5. `distribution`, only where it is asked for, chooses among the fields that hold.
//!
//! The only module that names `clarabel`. It knows nothing of robots, shapes,
//! files or plans.

mod answer;
mod as_one;
mod assess;
mod assessment;
mod attempts;
mod balance;
mod best;
mod biconnected;
mod blocks;
mod bracket;
mod chains;
mod closed_form;
mod clusters;
mod collapse;
mod conic;
mod connector;
mod contact_motion;
mod demand;
mod distribution;
mod element;
mod elimination;
mod explain;
mod face_program;
mod families;
mod frame;
mod groups;
mod hull;
mod interior_point;
mod leaves;
mod load_range;
mod loads;
mod locked;
mod lowered;
mod maps;
mod near;
mod network;
mod normal;
mod order;
mod part;
mod parts;
mod patch;
mod planar;
mod program;
mod reductions;
mod rejoin;
mod respect;
mod rigid_links;
mod rung;
mod scales;
mod second_order;
mod self_stress;
mod series;
mod side_by_side;
mod solve_block;
mod spread;
mod stiffness;
mod structure;
mod system;
mod tolerances;
mod validate;
mod variables;

pub use assess::{assess, assess_reduced};
pub use assessment::{Assessment, Bracket, ConnectionState, Distribution, LeftOut, Question, Verdict};
pub use connector::{Connector, Model};
pub use contact_motion::{ContactMotion, contact_motions};
pub use explain::{Explanation, InSpace, Remaining, explain};
pub use load_range::{LoadRange, RANGE_GAP, RangeEnd, UnitForce, load_range};
pub use near::{Memory, NotNear, assess_keeping, assess_near};
pub use order::{FailureLevel, FailureOrder, failure_order};
pub use patch::face_forces;
pub use reductions::Reductions;
pub use rung::{Rung, Tally};
pub use self_stress::{SelfStress, contact_self_stress};
pub use structure::{Anchor, Body, Connection, Contact, Load, Structure};
pub use validate::{InvalidStructure, validate};
