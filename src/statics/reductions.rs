//! Which parts of a structure the oracle may leave out of the optimisation.

/// What is left out where a scene does not need it. None of it changes the
/// utilisation; each can be switched off, to test that and to measure what it saves.
///
/// Not among them, since leaving them in would be another question or another
/// program: fixed bodies have no balance, frictionless contacts and `box`
/// connectors no cone but inequalities, so that a scene without friction is a linear
/// program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reductions {
    /// Bodies that connections without any finite limit hold together are one body.
    pub rigid_links: bool,
    /// The structure is cut at its articulation bodies; otherwise what hangs together,
    /// save over bridges in closed form, is one program. Where the value is asked for, the
    /// block that is expected to need most is solved first, and the others only until it is proved
    /// that they need no more.
    pub blocks: bool,
    /// The wrench over a bridge follows from balance; otherwise a solver is asked.
    pub closed_form: bool,
    /// A chain of bodies with two connections each has one unknown wrench.
    pub chains: bool,
    /// A block that is its own mirror image in a plane, body by body, has three balances
    /// per body.
    pub planar: bool,
    /// Several blocks with cycles, if they are large, are solved at the same time. The answer is the
    /// same to the last bit, whatever the number of threads.
    pub parallel: bool,
}

impl Reductions {
    /// Everything that a scene does not need is left out.
    pub const ALL: Self =
        Self { rigid_links: true, blocks: true, closed_form: true, chains: true, planar: true, parallel: true };

    /// Nothing is left out.
    pub const NONE: Self =
        Self { rigid_links: false, blocks: false, closed_form: false, chains: false, planar: false, parallel: false };
}

impl Default for Reductions {
    fn default() -> Self {
        Self::ALL
    }
}
