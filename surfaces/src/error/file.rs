//! What can be wrong with a file.

use std::path::PathBuf;

use thiserror::Error;

/// What is wrong with a file.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum FileError {
    /// A file could not be read or written.
    #[error("{}: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the operating system says.
        source: std::io::Error,
    },

    /// A file that has none of the formats this crate reads.
    #[error("{}: the format of this file is unknown: it begins with {begins:02x?}{what}", path.display())]
    UnknownFormat {
        /// The file.
        path: PathBuf,
        /// Its first bytes.
        begins: Vec<u8>,
        /// What it is, and what to do, if it is of a known format that is not read.
        what: &'static str,
    },

    /// A file that does not hold what its format asks for.
    #[error("{} is no readable {format} file: {reason}{}", path.display(), at_byte(*offset))]
    BadFile {
        /// The file.
        path: PathBuf,
        /// Its format.
        format: &'static str,
        /// Where, in bytes from its beginning; in an archive, from the beginning of the member that the reason names.
        offset: Option<usize>,
        /// What was found, and what would have been accepted.
        reason: String,
    },

    /// A file with several maps, or without the one asked for.
    #[error("{}: {}; its maps are {channels:?}", path.display(), which(wanted.as_deref()))]
    WhichChannel {
        /// The file.
        path: PathBuf,
        /// The name asked for.
        wanted: Option<String>,
        /// The names of the maps in the file.
        channels: Vec<String>,
    },

    /// A file that does not say, or not in a known unit of length, what its numbers are.
    #[error("{}: the {quantity} have {}; give it with {option}", path.display(), unit(found.as_deref()))]
    NoUnit {
        /// The file.
        path: PathBuf,
        /// Which numbers.
        quantity: &'static str,
        /// What stands in place of a unit of length.
        found: Option<String>,
        /// What supplies it.
        option: &'static str,
    },

    /// A text that names no unit of length.
    #[error("'{unit}' is no unit of length: m, cm, mm, µm, nm, pm, fm, Å and in are")]
    NoLength {
        /// The text.
        unit: String,
    },

    /// A text that names no layout.
    #[error("'{layout}' is no layout of a text: matrix, x-row, y-column, axes and points are")]
    NoLayout {
        /// The text.
        layout: String,
    },

    /// A surface of unknown size.
    #[error("the file does not give the size of the surface; give it with `ReadOptions::side`")]
    NoSide,
}

fn at_byte(offset: Option<usize>) -> String {
    offset.map_or(String::new(), |offset| format!(" (at byte {offset})"))
}

fn which(wanted: Option<&str>) -> String {
    match wanted {
        Some(name) => format!("there is not one map with the name '{name}'"),
        None => "choose one map with `ReadOptions::channel`".to_string(),
    }
}

fn unit(found: Option<&str>) -> String {
    match found {
        Some("A") => "the unit 'A', the ampere, which is no length".to_string(),
        Some(unit) => format!("the unit '{unit}', which is no length"),
        None => "no unit".to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Messages name the file, what was found, and what to do.
    #[test]
    fn messages_say_what_to_do() {
        let path = || PathBuf::from("ground.gwy");
        let which = |wanted: Option<&str>| {
            let channels = vec!["Height".to_string(), "Phase".to_string()];
            FileError::WhichChannel { path: path(), wanted: wanted.map(str::to_string), channels }
        };
        let unit = |found: Option<&str>| {
            let (found, option) = (found.map(str::to_string), "`ReadOptions::height_unit`");
            FileError::NoUnit { path: path(), quantity: "heights", found, option }
        };
        let bad = |offset| {
            let reason = "it ends early".to_string();
            FileError::BadFile { path: path(), format: "GWY", offset, reason }
        };
        for (error, message) in [
            (
                which(None),
                "choose one map with `ReadOptions::channel`; its maps are [\"Height\", \"Phase\"]",
            ),
            (
                which(Some("Depth")),
                "there is not one map with the name 'Depth'; its maps are [\"Height\", \"Phase\"]",
            ),
            (unit(None), "the heights have no unit; give it with `ReadOptions::height_unit`"),
            (
                unit(Some("V")),
                "the heights have the unit 'V', which is no length; give it with `ReadOptions::height_unit`",
            ),
        ] {
            assert_eq!(error.to_string(), format!("ground.gwy: {message}"));
        }
        let message = "ground.gwy is no readable GWY file: it ends early";
        assert_eq!(bad(None).to_string(), message);
        assert_eq!(bad(Some(7)).to_string(), format!("{message} (at byte 7)"));
    }
}
