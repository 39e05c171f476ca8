//! To be written.

use super::fault::Fault;
use super::raw::Parsed;

pub(super) fn parse(_file: &[u8]) -> Parsed {
    Err(Fault::malformed("to be written"))
}
