//! Pages of the documentation whose sections are written by studies.

use std::error::Error;
use std::path::{Path, PathBuf};

use asperity_cli::outcome::{Failure, Outcome};

/// A section of a page, between markers that name the study that writes it.
pub struct Section<'a> {
    /// Name of the study.
    pub study: &'a str,
    /// The text, with pictures as `images/NAME.png`.
    pub text: &'a str,
    /// Files of the pictures, copied into images/ next to the page.
    pub pictures: &'a [PathBuf],
}

impl Section<'_> {
    /// Puts the section into a page that others write as well: in the place of what is between its markers, or at the
    /// end.
    pub fn publish(&self, page: &Path) -> Result<PathBuf, Failure> {
        let publish = || -> Result<(), Box<dyn Error>> {
            let images = page.parent().unwrap_or(Path::new("")).join("images");
            std::fs::create_dir_all(&images)?;
            for picture in self.pictures {
                let name = picture.file_name().ok_or("a picture without a name")?;
                std::fs::copy(picture, images.join(name))?;
            }
            let present = std::fs::read_to_string(page)?;
            Ok(std::fs::write(page, self.merged(&present))?)
        };
        publish()
            .map_err(|error| Failure::new(format!("cannot write {}", page.display()), error))?;
        Ok(page.to_path_buf())
    }

    /// Prints the text, and puts it into a page if there is one.
    pub fn show(&self, page: Option<&Path>) -> Result<(), Failure> {
        println!("{}", self.text);
        let Some(page) = page else {
            return Ok(());
        };
        let mut outcome = Outcome::default();
        outcome.written(self.publish(page));
        outcome.finish()
    }

    fn merged(&self, present: &str) -> String {
        let begin = format!("<!-- written by the study `{}`: begin -->", self.study);
        let end = format!("<!-- written by the study `{}`: end -->", self.study);
        let section = format!("{begin}\n\n{}\n\n{end}", wrapped(self.text.trim()));
        let parts = present.split_once(&begin).and_then(|(before, rest)| {
            let (_, after) = rest.split_once(&end)?;
            Some((before, after))
        });
        match parts {
            Some((before, after)) => format!("{before}{section}{after}"),
            None => format!("{}\n\n{section}\n", present.trim_end()),
        }
    }
}

/// Columns of a line of prose at most.
const COLUMNS: usize = 120;

/// Text of a page whose paragraphs are one line each, with lines that are not too long. Tables, code, headings and
/// pictures stay.
pub fn wrapped(text: &str) -> String {
    let mut fenced = false;
    let lines = text.lines().map(|line| {
        let fence = line.trim_start().starts_with("```");
        fenced ^= fence;
        let whole = fenced || fence || line.starts_with(['|', '#', '<', '!']);
        if whole || line.chars().count() <= COLUMNS { line.to_string() } else { broken(line) }
    });
    lines.collect::<Vec<_>>().join("\n")
}

/// A paragraph, or an item of a list, in several lines.
fn broken(line: &str) -> String {
    let first = line.split(' ').next().unwrap_or_default();
    let number = first.strip_suffix('.').is_some_and(|n| n.parse::<u32>().is_ok());
    let indent = if first == "*" || number { first.chars().count() + 1 } else { 0 };
    let (mut text, mut length) = (String::new(), 0);
    for word in line.split_whitespace() {
        let size = word.chars().count();
        // At the beginning of a line these would be items of a list.
        let sign = ["+", "-", "*"].contains(&word);
        if length > 0 && length + 1 + size > COLUMNS && !sign {
            text.push('\n');
            text.push_str(&" ".repeat(indent));
            length = indent;
        } else if length > 0 {
            text.push(' ');
            length += 1;
        }
        text.push_str(word);
        length += size;
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn section<'a>(study: &'a str, text: &'a str) -> Section<'a> {
        Section { study, text, pictures: &[] }
    }

    #[test]
    fn only_the_own_section_changes() {
        let page = "# Page\n\nBy hand.\n";
        let first = section("one", "First.").merged(page);
        let both = section("two", "Second.").merged(&first);
        assert!(
            first.starts_with("# Page\n\nBy hand.\n\n<!-- written by the study `one`: begin -->")
        );
        assert!(both.starts_with(first.trim_end()));
        let again = section("one", "Changed.").merged(&both);
        assert_eq!(again, both.replace("First.", "Changed."));
        assert_eq!(section("two", "Second.").merged(&both), both);
    }

    #[test]
    fn prose_is_wrapped_and_nothing_else() {
        let words = "word ".repeat(50);
        let long = words.trim_end();
        let item = wrapped(&format!("12. {long}"));
        assert!(item.lines().all(|line| line.chars().count() <= COLUMNS));
        assert!(item.lines().skip(1).all(|line| line.starts_with("    word")));
        let back: Vec<&str> = item.split_whitespace().collect();
        assert_eq!(back.join(" "), format!("12. {long}"));
        for kept in [format!("| {long} |"), format!("```text\n{long}\n```"), format!("## {long}")] {
            assert_eq!(wrapped(&kept), kept);
        }
    }
}
