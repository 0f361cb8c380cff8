//! Words and numbers of the RoFI platform's files, for readers and writers.

/// The docks of a universal module, in the order of their numbers.
pub(super) const DOCKS: [&str; 6] = ["A-X", "A+X", "A-Z", "B-X", "B+X", "B-Z"];

/// How many components a universal module has: its docks, then shoe A, body A, body B, shoe B.
pub(super) const COMPONENTS: usize = 10;

/// Names of the orientations at which docks are joined, in the order of their numbers.
pub(super) const ORIENTATIONS: [&str; 4] = ["North", "East", "South", "West"];

/// The quarter turns between two ports that an orientation stands for, by its number; this is its own inverse. The
/// platform turns the second dock by 180, -90, 0 and 90 degrees about the axis from the first one's face backwards, after
/// half a turn: 180 degrees less that, between the ports.
pub(super) const QUARTERS: [u8; 4] = [0, 3, 2, 1];

/// Words of the text format, where names of X docks are swapped against those of [`DOCKS`]: there the
/// names stand for numbers, and the numbers for the components `-X`, `+X`, `-Z` of a shoe. That is what the
/// platform's own parser does, and files rely on it.
pub(super) mod text {
    /// Names of a shoe's docks in the order of their numbers.
    pub(in crate::io) const DOCKS: [&str; 3] = ["+X", "-X", "-Z"];

    /// Names of a module's halves, in the order of their numbers.
    pub(in crate::io) const SIDES: [&str; 2] = ["A", "B"];

    /// Names of orientations, in the order of their numbers.
    pub(in crate::io) const ORIENTATIONS: [&str; 4] = ["N", "E", "S", "W"];
}
