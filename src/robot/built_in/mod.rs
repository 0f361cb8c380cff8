//! The built-in catalogues, one family of robots a file.
//!
//! Every number says where it comes from, or that it is an estimate.

mod cube;
mod freesn;
mod motions;
pub mod rofi;

use super::catalogue::Catalogue;
pub use motions::BUILT_IN_MOTIONS;

/// Names of the built-in catalogues.
pub const BUILT_IN: [&str; 3] = ["cube", "freesn", "rofi"];

impl Catalogue {
    /// The built-in catalogue of this name, if there is one.
    pub fn built_in(name: &str) -> Option<Self> {
        match name {
            "cube" => Some(Self::cube()),
            "freesn" => Some(Self::freesn()),
            "rofi" => Some(Self::rofi()),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{BUILT_IN, Catalogue};

    #[test]
    fn every_built_in_catalogue_is_sound_and_called_by_its_name() {
        for name in BUILT_IN {
            let catalogue = Catalogue::built_in(name).unwrap();
            assert_eq!(catalogue.name, name);
            assert_eq!(catalogue.problems(), []);
        }
    }
}
