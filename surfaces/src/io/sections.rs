//! Headers of lines with a key and a value, in sections that begin with a line of their own.

use std::collections::HashMap;

use super::fault::Fault;
use super::lines::Lines;
use super::number::parsed;

/// A section of a header: its name, and its lines.
#[derive(Debug, Clone)]
pub(super) struct Section<'a> {
    pub(super) name: &'a [u8],
    lines: &'a [u8],
    /// The first value of each key, in small letters: asked for so often that lines are not searched each time.
    values: HashMap<String, String>,
    /// What is before a key, and what is between key and value.
    mark: &'static str,
    between: char,
}

/// How a line begins, and ends, that begins a section.
pub(super) struct Style {
    pub(super) begins: &'static [u8],
    pub(super) ends: &'static [u8],
    pub(super) mark: &'static str,
    pub(super) between: char,
}

impl<'a> Section<'a> {
    /// All sections of a header.
    pub(super) fn all(header: &'a [u8], style: &Style) -> Vec<Self> {
        let mut sections: Vec<Self> = Vec::new();
        let mut start = 0;
        for line in Lines::new(header, 0) {
            let name = line.bytes.trim_ascii_end().strip_prefix(style.begins);
            let Some(name) = name.and_then(|name| name.strip_suffix(style.ends)) else {
                continue;
            };
            if let Some(last) = sections.last_mut() {
                last.lines = header.get(start..line.offset).unwrap_or_default();
            }
            start = line.offset + line.bytes.len();
            let lines = header.get(start..).unwrap_or_default();
            let (mark, between) = (style.mark, style.between);
            sections.push(Self { name, lines, values: HashMap::new(), mark, between });
        }
        for section in &mut sections {
            let mut values = HashMap::new();
            for (key, value) in section.pairs() {
                values.entry(key.to_ascii_lowercase()).or_insert(value);
            }
            section.values = values;
        }
        sections
    }

    /// Keys and values, line by line.
    fn pairs(&self) -> impl Iterator<Item = (String, String)> {
        Lines::new(self.lines, 0).filter_map(|line| {
            let text = line.text();
            let (key, value) = split(text.strip_prefix(self.mark)?, self.between)?;
            Some((key.trim().to_string(), value.trim().to_string()))
        })
    }

    /// The value of the first line with such a key.
    pub(super) fn find(&self, is_it: impl Fn(&str) -> bool) -> Option<String> {
        self.pairs().find(|(key, _)| is_it(key)).map(|(_, value)| value)
    }

    /// The value of a key, in letters of any size.
    pub(super) fn get(&self, key: &str) -> Option<String> {
        self.values.get(&key.to_ascii_lowercase()).cloned()
    }

    /// The value of a key that has to be there.
    pub(super) fn need(&self, key: &str) -> Result<String, Fault> {
        self.get(key).ok_or_else(|| {
            fault!("section '{}' has no line '{key}'", String::from_utf8_lossy(self.name))
        })
    }

    /// The number that a key has to have.
    pub(super) fn number<T: std::str::FromStr>(&self, key: &str) -> Result<T, Fault> {
        parsed(key, &self.need(key)?, None)
    }
}

/// Key and value: parted by the first sign that is not part of a number of the key, as in `@2:Z scale: V`.
fn split(text: &str, between: char) -> Option<(&str, &str)> {
    let is_numbered = |at: usize| {
        text.get(..at).is_some_and(|before| {
            before.strip_prefix('@').is_some_and(|number| {
                number.bytes().all(|byte| byte.is_ascii_digit()) && !number.is_empty()
            })
        })
    };
    let at = text.char_indices().find(|(at, sign)| *sign == between && !is_numbered(*at))?.0;
    Some((text.get(..at)?, text.get(at + between.len_utf8()..)?))
}
