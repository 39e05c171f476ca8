//! Files that are whole once they have their name.

use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use crate::Error;
use crate::FileError;

/// Lets `work` write a file under another name beside its place, and then gives it its own, in place of what may be
/// there: a full disk or a killed process leaves no part of it that looks like the whole. What is no regular file, a
/// device, is written to as it is.
///
/// All writers of this crate write so. It is there for tables and pictures that go with their files:
///
/// ```
/// # fn main() -> Result<(), asperity_surfaces::Error> {
/// use std::io::Write;
///
/// # let directory = std::env::temp_dir();
/// asperity_surfaces::io::write_whole(directory.join("loads.csv"), |output| {
///     writeln!(output, "load,contact_area_fraction")?;
///     writeln!(output, "1e-3,0.017")
/// })?;
/// # std::fs::remove_file(directory.join("loads.csv")).unwrap();
/// # Ok(())
/// # }
/// ```
///
/// # Errors
///
/// [`FileError::Io`] if `work` fails, or the file cannot be written; what was there before is there still.
pub fn write_whole(
    path: impl AsRef<Path>,
    work: impl FnOnce(&mut BufWriter<File>) -> std::io::Result<()>,
) -> Result<(), Error> {
    let path = path.as_ref();
    let fill = |place: &Path| -> std::io::Result<File> {
        let mut output = BufWriter::new(File::create(place)?);
        work(&mut output)?;
        output.flush()?;
        Ok(output.into_inner()?)
    };
    let named = |source| Error::File(FileError::Io { path: path.to_path_buf(), source });
    if fs::metadata(path).is_ok_and(|place| !place.is_file()) {
        return fill(path).map(drop).map_err(named);
    }
    // A link stays one.
    let place = fs::canonicalize(path).unwrap_or_else(|_| path.to_path_buf());
    let unfinished = unfinished(&place);
    let written = fill(&unfinished)
        .and_then(|file| file.sync_all())
        .and_then(|()| fs::rename(&unfinished, &place));
    if written.is_err() {
        // It may not even be there.
        let _ = fs::remove_file(&unfinished);
    }
    written.map_err(named)
}

/// The name of a file while it is written: another one each time, since several threads may write the same file.
fn unfinished(path: &Path) -> PathBuf {
    static WRITTEN: AtomicU64 = AtomicU64::new(0);
    let count = WRITTEN.fetch_add(1, Ordering::Relaxed);
    let mut name = path.file_name().unwrap_or_default().to_os_string();
    name.push(format!(".{}.{count}.unfinished", std::process::id()));
    path.with_file_name(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whichever of several threads is last, the file is a whole one.
    #[test]
    fn threads_that_write_one_file_do_not_disturb_each_other() -> std::io::Result<()> {
        let path = std::env::temp_dir().join(format!("asperity-whole-{}.txt", std::process::id()));
        let write = |letter: char| {
            let text = letter.to_string().repeat(1 << 16);
            (0..20).try_for_each(|_| write_whole(&path, |output| output.write_all(text.as_bytes())))
        };
        let failures: Vec<String> = std::thread::scope(|scope| {
            let threads: Vec<_> =
                ['a', 'b', 'c', 'd'].map(|letter| scope.spawn(move || write(letter))).into();
            let ends = threads.into_iter().filter_map(|thread| thread.join().ok());
            ends.filter_map(|end| end.err().map(|error| error.to_string())).collect()
        });
        let text = fs::read_to_string(&path)?;
        fs::remove_file(&path)?;
        assert!(failures.is_empty(), "{failures:?}");
        let first = text.chars().next();
        assert!(text.len() == 1 << 16 && text.chars().all(|letter| Some(letter) == first));
        Ok(())
    }
}
