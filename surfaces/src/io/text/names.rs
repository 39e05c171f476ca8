//! Names of columns: which of them are x, y and z, and their units.

use super::header::{Header, shown};
use super::table::Table;
use super::words::{Kind, kind, words};
use crate::io::fault::Fault;
use crate::io::unit::LengthUnit;

/// Most names that a message lists.
const LISTED: usize = 12;

/// The columns of a list of points.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Columns {
    pub(super) x: usize,
    pub(super) y: usize,
    pub(super) z: usize,
    /// Units of the three, as the names say.
    pub(super) units: [Option<String>; 3],
    /// How they were found.
    pub(super) how: String,
}

impl Columns {
    /// Three columns, behind so many others.
    pub(super) fn behind(others: usize, how: &str) -> Self {
        Self { x: others, y: others + 1, z: others + 2, how: how.to_string(), ..Self::default() }
    }

    /// The columns of a table below a line of names; `None` if it cannot be one of this table.
    pub(super) fn named(line: &str, table: &Table) -> Result<Option<Self>, Fault> {
        let line = line.trim().trim_start_matches(['#', '%']).trim_matches([' ', '"']);
        let columns = table.columns;
        let ways = ways(line, table);
        if let Some(names) = ways.iter().find(|names| names.len() == columns) {
            return Self::of(names);
        }
        // A data frame has no name for its running numbers.
        let unnamed = |names: &&Vec<String>| names.len() + 1 == columns && table.counts_rows();
        let Some(names) = ways.iter().find(unnamed) else {
            return Ok(None);
        };
        Ok(Self::of(names)?.map(|found| Self {
            x: found.x + 1,
            y: found.y + 1,
            z: found.z + 1,
            how: format!("{} behind the unnamed column of running numbers", found.how),
            ..found
        }))
    }

    fn of(names: &[String]) -> Result<Option<Self>, Fault> {
        // Those of a profile.
        if names.len() < 3 {
            return Ok(None);
        }
        let kinds: Vec<Option<Kind>> = names.iter().map(|name| kind_of(name)).collect();
        let only_one = |is_it: &dyn Fn(usize) -> bool| {
            let mut places = (0..names.len()).filter(|k| is_it(*k));
            places.next().filter(|_| places.next().is_none())
        };
        let only = |wanted| only_one(&|k| kinds.get(k) == Some(&Some(wanted)));
        let (Some(x), Some(y)) = (only(Kind::X), only(Kind::Y)) else {
            return Ok(None);
        };
        let begins_with_z =
            |name: &str| words(name).next().is_some_and(|word| word.eq_ignore_ascii_case("z"));
        // Not z of something: its deviation, or what it was before.
        let is_z = |name: &str| {
            begins_with_z(name)
                && words(name).skip(1).all(|word| LengthUnit::in_file(word).is_some())
        };
        let called = |fits: &dyn Fn(&str) -> bool| {
            only_one(&|k| names.get(k).is_some_and(|name| fits(name)))
        };
        let called_z = called(&is_z).or_else(|| called(&begins_with_z));
        let third = (names.len() == 3).then(|| 3 - x - y);
        let z = called_z.or_else(|| only(Kind::Z)).or(third).ok_or_else(|| {
            let listed: Vec<String> = names.iter().take(LISTED).map(|name| shown(name)).collect();
            fault!(
                "of the columns {}{} it is not clear which has the heights: call one of them z",
                listed.join(", "),
                if names.len() > LISTED { ", ..." } else { "" }
            )
        })?;
        let name = |k: usize| names.get(k).map(String::as_str).unwrap_or_default();
        let units = [x, y, z].map(|k| unit(name(k)));
        let [of_x, of_y, of_z] = [x, y, z].map(|k| shown(name(k)));
        let how = format!("columns {of_x}, {of_y}, {of_z} by name");
        Ok(Some(Self { x, y, z, units, how }))
    }
}

/// What a name says as a whole: `x (value)` is x.
fn kind_of(name: &str) -> Option<Kind> {
    let mut found = words(name).filter_map(kind);
    let first = found.next()?;
    found.all(|kind| kind == first || kind == Kind::Z).then_some(first)
}

/// What names say of the columns of a profile.
#[derive(Debug, Default)]
pub(super) struct OfProfile {
    /// Units of the positions and of the heights.
    pub(super) units: [Option<String>; 2],
    /// Whether the heights stand before the positions.
    pub(super) is_turned: bool,
}

/// What a line of one or two names says; `None` if there is none.
pub(super) fn of_profile(header: &Header, table: &Table) -> Option<OfProfile> {
    let line =
        header.names.as_ref()?.trim().trim_start_matches(['#', '%']).trim_matches([' ', '"']);
    let ways = ways(line, table);
    let names = ways.into_iter().find(|names| names.len() == table.columns)?;
    let (units, is_turned) = match &names[..] {
        [height] => ([None, unit(height)], false),
        [height, position]
            if kind_of(height) == Some(Kind::Z)
                && matches!(kind_of(position), Some(Kind::X | Kind::Y)) =>
        {
            ([unit(position), unit(height)], true)
        }
        [position, height] => ([unit(position), unit(height)], false),
        _ => return None,
    };
    Some(OfProfile { units, is_turned })
}

/// The names in a line, in all ways in which they could be parted.
fn ways(line: &str, table: &Table) -> Vec<Vec<String>> {
    let cells = |separator: &str| -> Vec<String> {
        line.split(separator).map(|name| name.trim().to_string()).collect()
    };
    let own = table.dialect.separator.map(|byte| char::from(byte).to_string());
    let signs = own.as_deref().into_iter().chain([";", "\t", ","]);
    let mut ways: Vec<_> = signs.filter(|sign| line.contains(sign)).map(cells).collect();
    let wide: Vec<String> = cells("  ").into_iter().filter(|name| !name.is_empty()).collect();
    ways.push(wide);
    ways.push(words_with_units(line));
    ways.push(from_letters(line));
    ways
}

/// Names of one word, perhaps with something in brackets behind it.
fn words_with_units(line: &str) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    let mut is_open = false;
    for word in line.split_whitespace() {
        let belongs = is_open || word.starts_with(['(', '[', '{', '<']);
        match names.last_mut().filter(|_| belongs) {
            Some(name) => {
                name.push(' ');
                name.push_str(word);
            }
            None => names.push(word.to_string()),
        }
        let open = word.rfind(['(', '[', '{', '<']);
        let close = word.rfind([')', ']', '}', '>']);
        is_open = match (open, close) {
            (Some(open), close) => close.is_none_or(|close| close < open),
            (None, Some(_)) => false,
            (None, None) => is_open,
        };
    }
    names
}

/// Names of several words that begin with x, y and z.
fn from_letters(line: &str) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for word in line.split_whitespace() {
        let begins = words(word).next().is_some_and(|word| kind(word).is_some());
        match names.last_mut().filter(|_| !begins) {
            Some(name) => {
                name.push(' ');
                name.push_str(word);
            }
            None => names.push(word.to_string()),
        }
    }
    names
}

/// The unit in a name: in brackets, or its last word; with a factor before it, which nobody can read as a unit.
fn unit(name: &str) -> Option<String> {
    let is_length = |word: &str| word.parse::<LengthUnit>().is_ok();
    let has_digit = |word: &str| word.contains(|c: char| c.is_ascii_digit());
    let last_of = |text: &str| {
        let mut words = words(text);
        let last = words.next_back().filter(|word| is_length(word))?;
        let factor = words.next_back().filter(|word| has_digit(word));
        // The first word is what has the unit.
        let factor = factor.filter(|_| words.next().is_some());
        Some(factor.map_or_else(|| last.to_string(), |factor| format!("{factor} {last}")))
    };
    let mut brackets = name.split(['(', '[', '{', '<']).skip(1).map(|rest| {
        let inside = rest.split([')', ']', '}', '>']).next().unwrap_or_default().trim();
        inside.strip_prefix("in ").unwrap_or(inside).trim()
    });
    let of_brackets = brackets.clone().find(|unit| is_length(unit)).or_else(|| {
        brackets.find(|unit| !unit.is_empty() && words(unit).all(|word| kind(word).is_none()))
    });
    let last = || last_of(name).filter(|_| words(name).nth(1).is_some());
    of_brackets.map(str::to_string).or_else(last)
}
