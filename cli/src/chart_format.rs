//! In which format charts are drawn. Maps are pictures of pixels whatever is chosen.

use std::sync::OnceLock;

/// A format of pictures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ChartFormat {
    /// Pixels.
    Png,
    /// Lines and text, of any size.
    Svg,
}

/// What has been chosen.
static CHOSEN: OnceLock<ChartFormat> = OnceLock::new();

impl ChartFormat {
    /// The format of a name.
    ///
    /// # Errors
    ///
    /// What to do for a format that is not written.
    pub fn parse(name: &str) -> Result<Self, String> {
        match name.to_ascii_lowercase().as_str() {
            "png" => Ok(Self::Png),
            "svg" => Ok(Self::Svg),
            "pdf" => Err(
                "PDF is not written: take svg, which has the same lines and letters, and which browsers print and \
                 `rsvg-convert -f pdf` turns into PDF"
                    .to_string(),
            ),
            _ => Err("png or svg".to_string()),
        }
    }

    /// What names of its files end with.
    pub(crate) fn ending(self) -> &'static str {
        match self {
            Self::Png => "png",
            Self::Svg => "svg",
        }
    }
}

/// From here on charts are drawn in this format.
pub fn choose(format: ChartFormat) {
    // Only the first choice counts: there is one command line.
    let _ = CHOSEN.set(format);
}

/// The format that was chosen, if one was.
pub fn chosen() -> Option<ChartFormat> {
    CHOSEN.get().copied()
}
