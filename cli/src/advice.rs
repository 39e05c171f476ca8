//! Options of the command line that do what the library advises.

use asperity::{Doubt, surface};

/// What looks wrong, with the option that changes it if there is one.
pub(crate) fn told(doubt: &Doubt) -> String {
    match doubt {
        Doubt::Surface(surface::Doubt::Tilted { .. }) => format!("{doubt} (`--level plane`)"),
        _ => doubt.to_string(),
    }
}
