//! What a path with adhesion will take, for `--dry-run`.

use asperity::contact::ContactTarget;
use asperity_cli::outcome::Failure;

use super::super::expected::Expected;
use super::super::job::Job;
use super::super::options::Options;
use super::course::Begun;

/// Of 128² and 256² nodes at 10 % of contact, with w = 10⁻⁴ E* times the side: the time of a branch over that of the
/// path without adhesion to as many nodes, and what it holds over what that holds.
const SLOWER: f64 = 11.0;
const LARGER: f64 = 3.0;

/// What a path will take. At a load or an approach, the contact is that without adhesion, which is less.
///
/// # Errors
///
/// Those of setting up the path, and of going on from a record.
pub(in super::super) fn expected(job: &Job, options: &Options) -> Result<Expected, Failure> {
    job.adhesive_path()?;
    Begun::of(job, options)?;
    let branches = if options.unload { 2.0 } else { 1.0 };
    let is_area = |target: &ContactTarget| matches!(target, ContactTarget::AreaFraction(_));
    let is_least = !job.targets().iter().all(is_area);
    Ok(Expected::of(job, false)?.scaled(branches * SLOWER, LARGER, is_least))
}
