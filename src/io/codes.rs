//! Every kind of problem that a file can have.

/// What kind of problem it is. The number never changes once released.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Code {
    /// Number as shown, e.g. `E012`.
    pub number: &'static str,
    /// Name as shown, e.g. `unknown-key`.
    pub name: &'static str,
}

macro_rules! codes {
    ($($(#[$doc:meta])* $constant:ident = $number:literal $name:literal;)*) => {
        $($(#[$doc])* pub(super) const $constant: Code = Code { number: $number, name: $name };)*

        /// All codes, in the order of their numbers.
        pub const CODES: &[Code] = &[$($constant),*];
    };
}

codes! {
    // The text.
    UNREADABLE = "E001" "unreadable";
    NOT_UTF8 = "E002" "not-utf8";
    EMPTY = "E003" "empty-file";
    SYNTAX = "E004" "syntax";
    TOO_DEEP = "E005" "too-deep";
    TOO_LARGE = "E006" "too-large";
    DUPLICATE_KEY = "E007" "duplicate-key";
    NOT_FINITE = "E008" "not-finite";

    // The form of one value.
    FORMAT = "E010" "wrong-format";
    MISSING_KEY = "E011" "missing-key";
    UNKNOWN_KEY = "E012" "unknown-key";
    WRONG_TYPE = "E013" "wrong-type";
    WRONG_LENGTH = "E014" "wrong-length";
    OUT_OF_RANGE = "E015" "out-of-range";
    UNKNOWN_VALUE = "E016" "unknown-value";

    // Names, and values on their own.
    UNKNOWN_NAME = "E020" "unknown-name";
    DUPLICATE_ID = "E021" "duplicate-id";
    NOT_UNIT = "E022" "not-unit";
    BAD_PORT = "E023" "bad-port";
    BAD_ID = "E024" "bad-id";
    OFF_CENTRE = "E025" "off-centre";
    UNSUPPORTED = "E026" "unsupported";
    NO_SHAPE = "E027" "no-shape";

    // Values against each other.
    SELF_CONNECTION = "E030" "self-connection";
    DUPLICATE_CONNECTION = "E031" "duplicate-connection";
    APART = "E032" "apart";
    OVERLAP = "E033" "overlap";
    DISCONNECTED = "E034" "disconnected";
    MIXED = "E035" "mixed";

    // A goal against its start, a plan against its problem.
    MODULE_COUNT = "E040" "module-count";
    MODULE_TYPES = "E041" "module-types";
    FIXED_MODULES = "E042" "fixed-modules";
    START_AND_GOAL = "E043" "start-and-goal";
    PLAN = "E044" "plan";

    // A certificate against its checksum.
    CHECKSUM = "E045" "checksum";

    // What is well said, but not what the planner or the oracle takes.
    REFUSED = "E050" "refused";
}

#[cfg(test)]
mod tests {
    use super::CODES;

    #[test]
    fn numbers_ascend_and_names_differ() {
        assert!(CODES.windows(2).all(|pair| pair[0].number < pair[1].number));
        let mut names: Vec<_> = CODES.iter().map(|code| code.name).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), CODES.len());
    }
}
