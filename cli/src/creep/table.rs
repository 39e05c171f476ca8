//! `creep.csv`: the states over time.

use std::fmt::{self, Write as _};
use std::path::{Path, PathBuf};

use asperity_cli::outcome::{self, Failure};

use super::followed::Followed;

pub(super) fn write(followed: &Followed, name: &Path) -> Result<PathBuf, Failure> {
    let text = lines(followed).map_err(|error| Failure::writing(name, error))?;
    outcome::write(name, text)
}

fn lines(followed: &Followed) -> Result<String, fmt::Error> {
    let mut output = String::new();
    writeln!(output, "time,effective_load,load,approach,contact_area_fraction,mean_gap")?;
    for state in &followed.states {
        writeln!(
            output,
            "{:e},{:e},{:e},{:e},{},{:e}",
            state.time,
            state.effective_load,
            state.load,
            state.approach,
            state.contact_area_fraction,
            state.mean_gap
        )?;
    }
    Ok(output)
}
