//! What goes wrong, for the page: of what kind it is, and in words.

use asperity::{Error, FileError, SurfaceError};
use serde_json::json;

/// What the page does about it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Kind {
    /// It asks for the unit of heights.
    HeightUnit,
    /// It asks for the unit along x and y.
    LateralUnit,
    /// It asks how the numbers of a text are arranged.
    Layout,
    /// It asks which of these maps.
    Channel(Vec<String>),
    /// It says what there is room for.
    Memory,
    /// It says so.
    Other,
}

/// A failure.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Fault {
    pub(crate) kind: Kind,
    pub(crate) message: String,
}

impl Fault {
    /// Of another kind than the page can do something about.
    pub(crate) fn new(message: impl Into<String>) -> Self {
        Self { kind: Kind::Other, message: message.into() }
    }

    /// As the page reads it.
    pub(crate) fn json(&self) -> String {
        let (kind, channels) = match &self.kind {
            Kind::HeightUnit => ("height-unit", None),
            Kind::LateralUnit => ("lateral-unit", None),
            Kind::Channel(channels) => ("channel", Some(channels)),
            Kind::Layout => ("layout", None),
            Kind::Memory => ("memory", None),
            Kind::Other => ("other", None),
        };
        json!({"kind": kind, "channels": channels, "message": self.message}).to_string()
    }
}

impl From<Error> for Fault {
    fn from(error: Error) -> Self {
        let file = match &error {
            Error::File(file) | Error::Surface(SurfaceError::File(file)) => Some(file),
            _ => None,
        };
        let kind = match (file, &error) {
            (Some(FileError::NoUnit { quantity: "heights", .. }), _) => Kind::HeightUnit,
            (Some(FileError::NoUnit { .. }), _) => Kind::LateralUnit,
            (Some(FileError::WhichChannel { channels, .. }), _) => Kind::Channel(channels.clone()),
            (Some(FileError::BadFile { reason, .. }), _) if reason.contains(LAYOUT) => Kind::Layout,
            (_, Error::MemoryBudget { .. }) => Kind::Memory,
            _ => Kind::Other,
        };
        Self { kind, message: of_page(&error.to_string()) }
    }
}

impl From<SurfaceError> for Fault {
    fn from(error: SurfaceError) -> Self {
        Error::from(error).into()
    }
}

/// What a reader of texts asks for, in its error.
const LAYOUT: &str = "`ReadOptions::layout`";

/// Words of the library in those of the page.
pub(crate) fn of_page(text: &str) -> String {
    const WORDS: [(&str, &str); 8] = [
        ("`surface::fill_missing`", "“fill missing nodes”"),
        ("`ReadOptions::height_unit`", "“unit of heights”"),
        ("`ReadOptions::lateral_unit`", "“unit along x and y”"),
        ("`ReadOptions::side`", "“side along x”"),
        ("`ReadOptions::channel`", "“map”"),
        (LAYOUT, "“layout of a text”"),
        ("`ReadOptions::rows_are_y`", "“rows are y”"),
        ("`Topography::level`", "“level: plane”"),
    ];
    WORDS.iter().fold(text.to_string(), |text, (rust, page)| text.replace(rust, page))
}

#[cfg(test)]
mod tests {
    use asperity::io::{ReadOptions, TextLayout};

    use super::*;

    fn fault_of(text: &str, options: ReadOptions) -> Option<Fault> {
        options.read_bytes(text, "a.txt").err().map(|error| Error::from(error).into())
    }

    /// What the page has to ask for is told apart from what nobody can read.
    #[test]
    fn kinds_are_told_apart() {
        let options = ReadOptions::new;
        let text = "1 2 3\n4 5 6\n7 8 9\n";
        let unit = fault_of(text, options().layout(TextLayout::Matrix));
        assert_eq!(unit.map(|fault| fault.kind), Some(Kind::HeightUnit));
        let several = fault_of(text, options());
        assert_eq!(several.map(|fault| fault.kind), Some(Kind::Layout));
        let nothing = fault_of("no numbers at all", options());
        assert_eq!(nothing.map(|fault| fault.kind), Some(Kind::Other));
        let memory = Error::MemoryBudget { needed: 2, budget: 1, nodes_that_fit: 0 };
        assert_eq!(Fault::from(memory).kind, Kind::Memory);
        let which = FileError::WhichChannel {
            path: "a.gwy".into(),
            wanted: None,
            channels: vec!["A".to_string(), "B".to_string()],
        };
        let fault = Fault::from(SurfaceError::File(which));
        assert_eq!(fault.kind, Kind::Channel(vec!["A".to_string(), "B".to_string()]));
        assert!(fault.json().contains(r#""channels":["A","B"]"#));
    }

    #[test]
    fn words_are_those_of_the_page() {
        assert_eq!(of_page("give `ReadOptions::side`"), "give “side along x”");
    }
}
