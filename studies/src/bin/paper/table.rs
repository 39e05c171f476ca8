//! Files of numbers.

use std::path::Path;

use asperity_cli::outcome::Failure;

/// Writes a CSV file.
pub(crate) fn write_csv<R>(
    name: &Path,
    header: &[&str],
    rows: impl Iterator<Item = R>,
) -> Result<(), Failure>
where
    R: IntoIterator<Item = String>,
{
    let write = || -> Result<(), csv::Error> {
        let mut writer = csv::Writer::from_path(name)?;
        writer.write_record(header)?;
        for row in rows {
            writer.write_record(row)?;
        }
        Ok(writer.flush()?)
    };
    write().map_err(|error| Failure::new(format!("cannot write {}", name.display()), error))
}
