//! Lazy search over implicit weighted graphs.
//!
//! The graph is a [`Space`]: a start, goals, and the transitions out of a state.
//! Every transition has an additive **cost**, known at once, and a **width**; the
//! width of a path is its narrowest transition. Widths are expensive to know, so
//! they are bounded cheaply first, and certified only when the order of the search
//! depends on them. Certified widths are intervals, and so every answer
//! comes with what they prove. Nothing here knows what a state is.
//!
//! | engine | asks for | method |
//! | --- | --- | --- |
//! | [`Search::widest`] | largest width | lazy best-first with the max-min algebra |
//! | [`Search::shortest`] | least cost with width at least a floor | lazy A*, re-opening |
//! | [`Search::from_both_ends`] | the same, where goals are known | lazy bidirectional A* |
//! | [`Search::from_both_ends_by_class`] | the same, where the space repeats itself | the same, and exhausting classes of states |
//! | [`Search::margin`] | largest width, then least cost | both, one after the other |
//! | [`Search::anytime_margin`] | the same, with better and better paths before | greedy, then the cheapest for ever higher floors |
//! | [`Search::k_best`] | the K cheapest with width at least a floor | Yen, with places up to the order of independent actions |
//! | [`Search::ranked`] | the K widest, then cheapest | the same, in layers of width |
//! | [`Search::pareto`] | the front of width against cost | shortest, again and again with a rising floor |
//!
//! An [`Outcome`] says which of three things happened: solved and proved,
//! proved impossible, or neither, with the best path and the bounds so far.
//!
//! ```
//! use planners::toy::Toy;
//! use planners::{Options, Outcome, Search};
//!
//! // Over the pass, narrow but short; or through the valley, wide but long.
//! let map = Toy::new(4, 0, &[3])
//!     .arc(0, 3, "pass", 5, 1.0)
//!     .arc(0, 1, "slope", 2, 4.0)
//!     .arc(1, 2, "valley", 4, 3.0)
//!     .arc(2, 3, "bridge", 2, 6.0);
//! let mut search = Search::new(&map, Options::default());
//! let Outcome::Solved { found, proof } = search.margin(0.0) else { panic!("there is a way") };
//! assert_eq!((found.width.lower, found.cost), (3.0, 8));
//! assert!(proof.width_optimal && proof.cost_optimal);
//! assert_eq!(search.shortest(0.5).solved().map(|path| path.cost), Some(5));
//! assert_eq!(search.shortest(3.5), Outcome::Impossible);
//! ```

pub mod algebra;
pub mod toy;

mod anytime;
mod apart;
mod both_ends;
mod brackets;
mod budget;
mod graph;
mod k_best;
mod lattice;
mod margin;
mod outcome;
mod pareto;
mod progress;
mod queue;
mod ranked;
mod registry;
mod search;
mod shortest;
mod space;
mod tree;
mod widest;

pub use anytime::Shortest;
pub use budget::{Budget, Limit, Statistics};
pub use lattice::Displacement;
pub use outcome::{Outcome, Path, Proof, Step};
pub use progress::{Pass, Progress};
pub use search::{Options, PathOf, Search};
pub use space::{Periodic, Reversible, Space, Transition, Width};
