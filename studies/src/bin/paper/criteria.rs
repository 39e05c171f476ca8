//! Verdicts, claims of the paper, and the criterion of each.

use std::fmt::{self, Display, Write};

use asperity_studies::spread::Spread;

/// Relative differences up to which numbers agree or are near.
const CLOSE: f64 = 0.05;
const NEAR: f64 = 0.2;
/// Ratios up to which loads at the ends of a range agree or are near.
const CLOSE_RATIO: f64 = 1.25;
const NEAR_RATIO: f64 = 1.6;

/// What a comparison says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Verdict {
    Agrees,
    Near,
    InPart,
    Differs,
    /// The surfaces differ too much among themselves for the comparison to decide anything.
    Undecided,
}

impl Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Agrees => "agrees",
            Self::Near => "near",
            Self::InPart => "in part",
            Self::Differs => "differs",
            Self::Undecided => "undecided",
        })
    }
}

impl Verdict {
    /// On a number of the paper.
    pub(crate) fn number(paper: f64, ours: Spread) -> Self {
        let off = (ours.mean / paper - 1.0).abs();
        let spread = 2.0 * ours.deviation / paper.abs();
        if !off.is_finite() {
            Self::Undecided
        } else if off > spread.max(NEAR) {
            Self::Differs
        } else if spread > NEAR {
            Self::Undecided
        } else if off <= spread.max(CLOSE) {
            Self::Agrees
        } else {
            Self::Near
        }
    }

    /// On an end of a range of loads.
    pub(crate) fn end(paper: f64, ours: f64) -> Self {
        let ratio = (ours / paper).max(paper / ours);
        if ratio <= CLOSE_RATIO {
            Self::Agrees
        } else if ratio <= NEAR_RATIO {
            Self::Near
        } else {
            Self::Differs
        }
    }

    /// On a statement with conditions: all met, some, or none.
    pub(crate) fn of(conditions: &[bool]) -> Self {
        let met = conditions.iter().filter(|met| **met).count();
        if met == conditions.len() {
            Self::Agrees
        } else if met > 0 {
            Self::InPart
        } else {
            Self::Differs
        }
    }

    /// On a deviation that should not be above a limit.
    pub(crate) fn within(deviation: f64, limit: f64, near: f64) -> Self {
        if deviation <= limit {
            Self::Agrees
        } else if deviation <= near {
            Self::Near
        } else {
            Self::Differs
        }
    }
}

/// The rule for numbers, by the name that tables call it.
pub(crate) const NUMBER: &str = "number";

/// What was found, and what it says.
pub(crate) struct Found {
    pub(crate) text: String,
    pub(crate) verdict: Verdict,
}

impl Found {
    pub(crate) fn new(text: impl Into<String>, verdict: Verdict) -> Self {
        Self { text: text.into(), verdict }
    }
}

/// A statement of the paper, the criterion, and what was found for each surface, or once for all.
pub(crate) struct Claim {
    /// Short name.
    pub(crate) name: &'static str,
    /// What the paper says.
    pub(crate) paper: &'static str,
    /// [`NUMBER`], or when the verdict is *agrees*, and when it is another.
    pub(crate) criterion: String,
    pub(crate) found: Vec<Found>,
}

impl Claim {
    pub(crate) fn new(
        name: &'static str,
        paper: &'static str,
        criterion: impl Into<String>,
        found: impl IntoIterator<Item = Found>,
    ) -> Self {
        Self { name, paper, criterion: criterion.into(), found: found.into_iter().collect() }
    }

    /// A number of the paper; `show` writes the spread.
    pub(crate) fn number<'a, T: 'a>(
        name: &'static str,
        (value, text): (f64, &'static str),
        of: impl IntoIterator<Item = &'a T>,
        ours: impl Fn(&T) -> Spread,
        show: impl Fn(&Spread) -> String,
    ) -> Self {
        let found = of.into_iter().map(|item| {
            let spread = ours(item);
            Found::new(show(&spread), Verdict::number(value, spread))
        });
        Self::new(name, text, NUMBER, found)
    }
}

/// A table of claims with two columns for each of `columns`.
pub(crate) fn table(columns: &[&str], claims: &[Claim]) -> String {
    let mut text = "| | paper |".to_string();
    for column in columns {
        // Writing to a string does not fail.
        let _ = write!(text, " {column} | |");
    }
    let _ = writeln!(text, "\n|---|---|{}", "---|---|".repeat(columns.len()));
    for claim in claims {
        let _ = write!(text, "| {} | {} |", claim.name, claim.paper);
        for found in &claim.found {
            let _ = write!(text, " {} | {} |", found.text, found.verdict);
        }
        text.push('\n');
    }
    text
}

/// The criteria of all claims.
pub(crate) fn criteria<'a>(claims: impl Iterator<Item = &'a Claim>) -> String {
    let mut text = format!(
        "# Criteria\n\n\
         \"Mean\" is over the seeds, σ their sample standard deviation.\n\n\
         | | verdict |\n|---|---|\n\
         | a {NUMBER} of the paper | *agrees* if the mean is within 2σ or {} % of it; *near* within {} %; else *differs*; \
         *undecided* if it does not differ and 2σ is more than {} % of it |\n\
         | an end of a range of loads | *agrees* within a factor of {CLOSE_RATIO}, *near* within {NEAR_RATIO}, else \
         *differs* |\n",
        100.0 * CLOSE,
        100.0 * NEAR,
        100.0 * NEAR,
    );
    for claim in claims.filter(|claim| claim.criterion != NUMBER) {
        let _ = writeln!(text, "| {} | {} |", claim.name, claim.criterion);
    }
    text
}
