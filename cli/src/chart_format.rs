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

#[cfg(test)]
mod tests {
    use super::*;

    /// Case does not matter, and what is not written is told from what is unknown.
    #[test]
    fn a_format_is_named_as_its_files_end() {
        for format in [ChartFormat::Png, ChartFormat::Svg] {
            let name = format.ending();
            assert_eq!(ChartFormat::parse(name), Ok(format));
            assert_eq!(ChartFormat::parse(&name.to_uppercase()), Ok(format));
        }
        for (name, words) in [
            ("pdf", "PDF is not written: take svg"),
            ("PDF", "PDF is not written: take svg"),
            ("jpg", "png or svg"),
            (" png", "png or svg"),
            ("", "png or svg"),
        ] {
            let told = ChartFormat::parse(name).err().unwrap_or_default();
            assert!(told.starts_with(words), "{name}: {told}");
        }
    }
}
