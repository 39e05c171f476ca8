//! Archives of arrays, `.npz`.

use std::io::{Cursor, Read, Seek, Write};
use std::path::{Path, PathBuf};

use nalgebra::DMatrix;
use zip::result::ZipError;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipArchive, ZipWriter};

use super::bytes::read_file;
use super::fault::Fault;
use super::npy::{self, header_of};
use super::output::Output;
use crate::Error;

/// How many times the size of its archive a member may take: arrays of one number compress a thousand times.
const MOST: usize = 1 << 11;
/// Members from which on the archive needs longer numbers.
const LARGE: usize = u32::MAX as usize / 2;

/// What is wrong with a zip file, for people who do not know how one is made.
pub(super) fn incomplete(error: ZipError) -> Fault {
    match error {
        ZipError::InvalidArchive(_) | ZipError::Io(_) => fault!(
            "it is no complete zip archive, which this format is; was it cut off, or is it of another kind?"
        ),
        ZipError::FileNotFound => fault!("it is not there"),
        other => fault!("{other}"),
    }
}

/// How many times longer than the whole archive a member of an instrument's file may be.
///
/// Measured heights hardly shrink to a hundredth; even an image with a few grey levels does not to 1/256. Deflate could
/// reach 1/1032, which is what archives are made of that only want to fill a memory. Heights of 16 bits take four times
/// as much again as double numbers.
pub(super) const MAX_GROWTH: usize = 256;

/// The member of an archive whose path is, or ends with, this name; anything may stand before the archive.
pub(super) fn inflated(file: &[u8], name: &str) -> Result<Vec<u8>, Fault> {
    let mut zip = ZipArchive::new(Cursor::new(file)).map_err(incomplete)?;
    let is_it = |path: &str| path.rsplit(['/', '\\']).next() == Some(name);
    let paths = zip.file_names().filter_map(|path| Some(path.ok()?.to_string()));
    let mut paths = paths.filter(|path| is_it(path));
    let path = paths.next().ok_or_else(|| fault!("the archive has no member '{name}'"))?;
    let another = paths.next();
    drop(paths);
    if let Some(another) = another {
        bail!("the archive has two members '{name}', at '{path}' and '{another}'");
    }
    let most = file.len().saturating_mul(MAX_GROWTH);
    let mut bytes = Vec::new();
    let member = zip.by_name(&path).map_err(incomplete)?;
    let read = member.take(most as u64 + 1).read_to_end(&mut bytes);
    read.map_err(|error| fault!("'{name}' is damaged: {error}"))?;
    ensure!(bytes.len() <= most, "'{name}' is more than {MAX_GROWTH} times as large as the file");
    Ok(bytes)
}

/// Writes one array after the other, uncompressed and without a date: the same arrays make the same file.
pub struct ArchiveWriter<W: Write + Seek> {
    zip: ZipWriter<Output<W>>,
}

impl<W: Write + Seek> ArchiveWriter<W> {
    pub fn new(output: W) -> Self {
        Self { zip: ZipWriter::new(Output::new(output)) }
    }

    fn begin(
        &mut self,
        name: &str,
        descr: &str,
        shape: &[usize],
        bytes: usize,
    ) -> std::io::Result<()> {
        let options = SimpleFileOptions::default()
            .compression_method(CompressionMethod::Stored)
            .large_file(bytes > LARGE);
        self.zip.start_file(format!("{name}.npy"), options)?;
        self.zip.write_all(&header_of(descr, shape))
    }

    /// An array of elements of some type, all of whose bytes these are.
    fn array(
        &mut self,
        name: &str,
        descr: &str,
        shape: &[usize],
        bytes: Vec<u8>,
    ) -> std::io::Result<()> {
        self.begin(name, descr, shape, bytes.len())?;
        self.zip.write_all(&bytes)
    }

    /// An array of no dimension that holds a text.
    pub fn text(&mut self, name: &str, text: &str) -> std::io::Result<()> {
        let bytes: Vec<u8> =
            text.chars().flat_map(|letter| u32::from(letter).to_le_bytes()).collect();
        self.array(name, &format!("<U{}", bytes.len() / 4), &[], bytes)
    }

    /// An array of one dimension.
    pub fn numbers(
        &mut self,
        name: &str,
        length: usize,
        values: impl Iterator<Item = f64>,
    ) -> std::io::Result<()> {
        self.array(name, "<f8", &[length], values.flat_map(f64::to_le_bytes).collect())
    }

    /// The same of whole numbers.
    pub fn integers(
        &mut self,
        name: &str,
        length: usize,
        values: impl Iterator<Item = i64>,
    ) -> std::io::Result<()> {
        self.array(name, "<i8", &[length], values.flat_map(i64::to_le_bytes).collect())
    }

    /// An array `[ix, iy]`.
    pub fn matrix(&mut self, name: &str, matrix: &DMatrix<f64>) -> std::io::Result<()> {
        let (nx, ny) = matrix.shape();
        self.begin(name, "<f8", &[nx, ny], 8 * nx * ny)?;
        for row in matrix.row_iter() {
            let bytes: Vec<u8> = row.iter().flat_map(|value| value.to_le_bytes()).collect();
            self.zip.write_all(&bytes)?;
        }
        Ok(())
    }

    pub fn finish(self) -> std::io::Result<()> {
        self.zip.finish()?.finish()
    }
}

/// An archive whose members are read by name.
pub struct Archive {
    path: PathBuf,
    /// What errors call it.
    format: &'static str,
    bytes: Vec<u8>,
}

impl Archive {
    pub fn open(path: &Path, format: &'static str) -> Result<Self, Error> {
        let read = || {
            let bytes = read_file(path)?;
            ZipArchive::new(Cursor::new(&bytes[..])).map_err(incomplete)?;
            Ok(bytes)
        };
        let bytes = read().map_err(|fault: Fault| fault.in_file(path, format))?;
        Ok(Self { path: path.to_path_buf(), format, bytes })
    }

    /// What `parse` makes of a member.
    fn member<T>(&self, name: &str, parse: impl Fn(&[u8]) -> Result<T, Fault>) -> Result<T, Error> {
        let parsed = self.bytes_of(name).and_then(|bytes| parse(&bytes));
        let prefix = format!("member '{name}': ");
        parsed.map_err(|fault| fault.prefixed(&prefix).in_file(&self.path, self.format))
    }

    fn bytes_of(&self, name: &str) -> Result<Vec<u8>, Fault> {
        let mut zip = ZipArchive::new(Cursor::new(&self.bytes[..])).map_err(incomplete)?;
        let member = zip.by_name(&format!("{name}.npy")).map_err(incomplete)?;
        let most = self.bytes.len().saturating_mul(MOST);
        let mut bytes = Vec::new();
        let read = member.take(most as u64 + 1).read_to_end(&mut bytes);
        read.map_err(|error| fault!("{error}"))?;
        ensure!(bytes.len() <= most, "it is more than {MOST} times as large as the file");
        Ok(bytes)
    }

    /// The text of a member.
    pub fn text(&self, name: &str) -> Result<String, Error> {
        self.member(name, npy::text)
    }

    /// An array of one dimension, of a length if one is given.
    pub fn vector(&self, name: &str, length: Option<usize>) -> Result<Vec<f64>, Error> {
        self.member(name, |bytes| {
            let values = npy::vector(bytes)?;
            let (found, expected) = (values.len(), length.unwrap_or(values.len()));
            ensure!(found == expected, "it has {found} numbers, and {expected} were expected");
            Ok(values)
        })
    }

    /// An array `[ix, iy]`.
    pub fn matrix(&self, name: &str) -> Result<DMatrix<f64>, Error> {
        self.member(name, npy::matrix)
    }
}
