//! To be written.

use std::path::Path;

use super::fault::Fault;
use super::raw::Parsed;

pub(super) fn looks_like(_bytes: &[u8]) -> bool {
    true
}

pub(super) fn parse(_file: &[u8], _path: &Path) -> Parsed {
    Err(Fault::malformed("to be written"))
}
