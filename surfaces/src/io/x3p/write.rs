//! Writing `.x3p` files.

use std::io::{self, Seek, Write};
use std::path::Path;

use md5::{Digest, Md5};
use nalgebra::DMatrix;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, System, ZipWriter};

use super::archive::{DESCRIPTION, hex, md5_of};
use crate::io::output::Output;
use crate::io::whole_file::write_whole;
use crate::{Error, Grid};

/// What the member with the checksum of the description is called.
pub(super) const CHECKSUM: &str = "md5checksum.hex";

const DATA: &str = "bindata/data.bin";

/// Writes heights \[m\] on their grid as ISO 25178-72, in double precision; what is not finite is written as NaN, which
/// means that it was not measured.
///
/// Nothing is compressed: the digits of measured heights hardly can be, and a plane could to less than readers accept
/// that beware of archives made to fill a memory. No time is written, so that the same heights give the same file.
/// An existing file is replaced, once the new one is whole.
///
/// # Errors
///
/// [`Error::GridMismatch`] if the grid has another shape, and [`FileError::Io`](crate::FileError::Io) if the file
/// cannot be written.
pub fn write_x3p(path: impl AsRef<Path>, grid: &Grid, heights: &DMatrix<f64>) -> Result<(), Error> {
    grid.check_shape(heights.shape())?;
    write_whole(path, |output| write(output, grid, heights))
}

pub(in crate::io) fn write(
    output: impl Write + Seek,
    grid: &Grid,
    heights: &DMatrix<f64>,
) -> io::Result<()> {
    let options = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Stored)
        .last_modified_time(DateTime::default())
        .system(System::Unix);
    let mut archive = ZipWriter::new(Output::new(output));
    // Members of 4 GiB and more need longer fields from the start.
    let long = heights.len() >= (u32::MAX / 8) as usize;
    archive.start_file(DATA, options.large_file(long))?;
    let mut md5 = Md5::new();
    for row in heights.column_iter() {
        let bytes: Vec<u8> = row.iter().flat_map(|z| stored(*z)).collect();
        md5.update(&bytes);
        archive.write_all(&bytes)?;
    }
    let description = description(grid, &hex(&md5.finalize()));
    archive.start_file(DESCRIPTION, options)?;
    archive.write_all(description.as_bytes())?;
    archive.start_file(CHECKSUM, options)?;
    writeln!(archive, "{} *{DESCRIPTION}", md5_of(description.as_bytes()))?;
    archive.finish()?.finish()
}

/// The bytes of a height: of all numbers that are not finite, the one that the standard knows.
fn stored(height: f64) -> [u8; 8] {
    let height = if height.is_finite() { height } else { f64::NAN };
    height.to_le_bytes()
}

/// The description of a map whose data have this checksum.
fn description(grid: &Grid, md5: &str) -> String {
    let (nx, ny) = grid.shape();
    let version = env!("CARGO_PKG_VERSION");
    let axis = |(name, kind, increment)| {
        format!(
            r#"      <{name}>
        <AxisType>{kind}</AxisType>
        <DataType>D</DataType>
        <Increment>{increment}</Increment>
        <Offset>0</Offset>
      </{name}>
"#
        )
    };
    let (dx, dy) = (format!("{:e}", grid.dx()), format!("{:e}", grid.dy()));
    let axes = [("CX", "I", &dx[..]), ("CY", "I", &dy), ("CZ", "A", "1")].map(axis).concat();
    // The standard asks for dates; this one says that none is known, as in files of other programs.
    format!(
        r#"<?xml version="1.0" encoding="UTF-8"?>
<p:ISO5436_2 xmlns:p="http://www.opengps.eu/2008/ISO5436_2">
  <Record1>
    <Revision>ISO5436 - 2000</Revision>
    <FeatureType>SUR</FeatureType>
    <Axes>
{axes}    </Axes>
  </Record1>
  <Record2>
    <Date>1970-01-01T00:00:00</Date>
    <Instrument>
      <Manufacturer>not available</Manufacturer>
      <Model>asperity</Model>
      <Serial>not available</Serial>
      <Version>{version}</Version>
    </Instrument>
    <CalibrationDate>1970-01-01T00:00:00</CalibrationDate>
    <ProbingSystem>
      <Type>Software</Type>
      <Identification>not available</Identification>
    </ProbingSystem>
  </Record2>
  <Record3>
    <MatrixDimension>
      <SizeX>{nx}</SizeX>
      <SizeY>{ny}</SizeY>
      <SizeZ>1</SizeZ>
    </MatrixDimension>
    <DataLink>
      <PointDataLink>{DATA}</PointDataLink>
      <MD5ChecksumPointData>{md5}</MD5ChecksumPointData>
    </DataLink>
  </Record3>
  <Record4>
    <ChecksumFile>{CHECKSUM}</ChecksumFile>
  </Record4>
</p:ISO5436_2>
"#
    )
}
