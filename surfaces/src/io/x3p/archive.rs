//! The zip archive of an `.x3p` file: its members, none of which may grow without bound.

use std::io::{Cursor, Read};

use md5::{Digest, Md5};
use zip::ZipArchive;

use crate::io::archive::{MAX_GROWTH, incomplete};
use crate::io::bytes::reserved;
use crate::io::fault::Fault;

/// How many times longer the description may be, whose tree takes many times the memory of its text.
const MAX_GROWTH_OF_DESCRIPTION: usize = 64;

/// What the description is called, somewhere in the archive.
pub(super) const DESCRIPTION: &str = "main.xml";

/// An archive, and the folder in it that holds everything.
#[derive(Debug)]
pub(super) struct Archive<'a> {
    zip: ZipArchive<Cursor<&'a [u8]>>,
    /// Path of the description up to its name.
    folder: String,
    length: usize,
}

impl<'a> Archive<'a> {
    /// Opens an archive that holds a description: of several, the one in the fewest folders.
    pub(super) fn open(file: &'a [u8]) -> Result<Self, Fault> {
        let zip = ZipArchive::new(Cursor::new(file)).map_err(incomplete)?;
        let folder = zip
            .file_names()
            .filter_map(|name| name.ok().map(|name| forward(&name)))
            // A copy of attributes that macOS adds to archives packed by hand.
            .filter(|name| !name.starts_with("__MACOSX/"))
            .filter_map(|name| name.strip_suffix(DESCRIPTION).map(str::to_string))
            .filter(|folder| folder.is_empty() || folder.ends_with('/'))
            .min_by_key(|folder| folder.matches('/').count())
            .ok_or_else(|| {
                fault!("it is a zip archive without a member '{DESCRIPTION}', so no X3P")
            })?;
        Ok(Self { zip, folder, length: file.len() })
    }

    /// The description, as it is.
    pub(super) fn description(&mut self) -> Result<Vec<u8>, Fault> {
        let length = self.length;
        let limit = length.saturating_mul(MAX_GROWTH_OF_DESCRIPTION);
        let bytes = self.member(DESCRIPTION, limit)?;
        ensure!(
            bytes.len() <= limit,
            "'{DESCRIPTION}' is longer than {MAX_GROWTH_OF_DESCRIPTION} times the archive of {length} bytes"
        );
        Ok(bytes)
    }

    /// The member that a link in the description names, which has to be `expected` bytes long.
    pub(super) fn data(&mut self, link: &str, expected: usize) -> Result<Vec<u8>, Fault> {
        let length = self.length;
        ensure!(
            expected <= length.saturating_mul(MAX_GROWTH),
            "'{link}' would have {expected} bytes, more than {MAX_GROWTH} times those of the archive, {length}"
        );
        let bytes = self.member(link, expected)?;
        let found = bytes.len();
        ensure!(found <= expected, "'{link}' has to have {expected} bytes, but it has more");
        ensure!(found == expected, "'{link}' has to have {expected} bytes, but it has {found}");
        Ok(bytes)
    }

    /// The checksum of the description, if the archive has one.
    pub(super) fn checksum(&mut self, link: &str) -> Option<String> {
        // A line of the program md5sum: the digest, and the name of the file.
        let line = self.member(link, 4096).ok()?;
        let digest = line.split(u8::is_ascii_whitespace).next()?;
        Some(String::from_utf8_lossy(digest).into_owned())
    }

    /// The first `limit` + 1 bytes of a member beside the description.
    fn member(&mut self, link: &str, limit: usize) -> Result<Vec<u8>, Fault> {
        let path = forward(link);
        let leaves = path.starts_with('/')
            || path.contains(':')
            || path.split('/').any(|folder| folder == "..");
        ensure!(!leaves, "the link '{link}' leaves the archive");
        let path = format!("{}{}", self.folder, path.trim_start_matches("./"));
        let index = self
            .zip
            .file_names()
            .position(|name| name.is_ok_and(|name| forward(&name) == path))
            .ok_or_else(|| fault!("the archive has no member '{path}'"))?;
        let failed = |error: std::io::Error| fault!("'{path}': {error}");
        let member = self.zip.by_index(index).map_err(|e| failed(e.into()))?;
        let claimed = usize::try_from(member.size()).unwrap_or(usize::MAX);
        let mut bytes = reserved(claimed.min(limit))?;
        member.take((limit as u64).saturating_add(1)).read_to_end(&mut bytes).map_err(failed)?;
        Ok(bytes)
    }
}

/// A path as the format of archives has it: some programs write that of Windows.
fn forward(path: &str) -> String {
    path.replace('\\', "/")
}

/// MD5 in hexadecimal digits.
pub(super) fn md5_of(bytes: &[u8]) -> String {
    hex(&Md5::digest(bytes))
}

/// Bytes in hexadecimal digits.
pub(super) fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}
