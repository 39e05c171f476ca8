//! The bytes of a file, read from front to back, and never beyond their end.

use std::fmt;
use std::fs::{self, File};
use std::io::{ErrorKind, Read};
use std::path::Path;

use super::fault::Fault;
use crate::Grid;

/// All bytes of a regular file: opening a pipe would wait for somebody to write into it.
pub(super) fn read_file(path: &Path) -> Result<Vec<u8>, Fault> {
    ensure!(fs::metadata(path)?.is_file(), "it is not a regular file");
    let mut file = File::open(path)?;
    let length = usize::try_from(file.metadata()?.len())
        .map_err(|_| std::io::Error::from(ErrorKind::OutOfMemory))?;
    let mut bytes = reserved(length)?;
    file.read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// All bytes of a source.
pub(super) fn read_all(mut source: impl Read) -> Result<Vec<u8>, Fault> {
    let mut bytes = Vec::new();
    source.read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// An empty vector with room for so many elements.
pub(super) fn reserved<T>(count: usize) -> Result<Vec<T>, Fault> {
    let mut values = Vec::new();
    values.try_reserve_exact(count).map_err(|_| std::io::Error::from(ErrorKind::OutOfMemory))?;
    Ok(values)
}

/// Which byte of a number comes first: the least significant, or the most.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Order {
    Little,
    #[cfg_attr(not(feature = "io"), expect(dead_code, reason = "NumPy's header is little-endian"))]
    Big,
}

/// A place in the bytes of a file.
#[derive(Debug, Clone)]
pub(super) struct Bytes<'a> {
    all: &'a [u8],
    at: usize,
    order: Order,
}

macro_rules! numbers {
    ($($name:ident: $type:ty),*) => {$(
        /// The next number.
        pub(super) fn $name(&mut self) -> Result<$type, Fault> {
            let bytes = self.array()?;
            Ok(match self.order {
                Order::Little => <$type>::from_le_bytes(bytes),
                Order::Big => <$type>::from_be_bytes(bytes),
            })
        }
    )*};
}

#[cfg_attr(not(feature = "io"), expect(dead_code, reason = "NumPy's format needs few of these"))]
impl<'a> Bytes<'a> {
    pub(super) fn new(all: &'a [u8]) -> Self {
        Self { all, at: 0, order: Order::Little }
    }

    /// The same bytes, whose numbers have this order.
    pub(super) fn ordered(self, order: Order) -> Self {
        Self { order, ..self }
    }

    /// The bytes from a place in the file on.
    pub(super) fn from(all: &'a [u8], offset: usize) -> Result<Self, Fault> {
        let mut bytes = Self::new(all);
        bytes.seek(offset)?;
        Ok(bytes)
    }

    /// Bytes from the start of the file to here.
    pub(super) fn offset(&self) -> usize {
        self.at
    }

    /// Bytes from here to the end.
    pub(super) fn left(&self) -> usize {
        self.all.len() - self.at
    }

    /// Goes to a place given from the start of the file.
    pub(super) fn seek(&mut self, offset: usize) -> Result<(), Fault> {
        let length = self.all.len();
        ensure!(
            offset <= length,
            at(self.at),
            "byte {offset} is referred to, but the file has {length} bytes"
        );
        self.at = offset;
        Ok(())
    }

    /// The next `count` bytes.
    pub(super) fn take(&mut self, count: usize) -> Result<&'a [u8], Fault> {
        let rest = &self.all[self.at..];
        let left = rest.len();
        ensure!(
            count <= left,
            at(self.at),
            "expected {count} more bytes, but the file ends after {left}"
        );
        self.at += count;
        Ok(&rest[..count])
    }

    /// The next `count` elements of `size` bytes each, checked against the file before anything is made of them.
    pub(super) fn elements(&mut self, count: usize, size: usize) -> Result<&'a [u8], Fault> {
        self.take(count.saturating_mul(size))
    }

    /// The bytes up to the next `end`, which is skipped.
    pub(super) fn until(&mut self, end: u8) -> Result<&'a [u8], Fault> {
        let rest = &self.all[self.at..];
        let length = rest.iter().position(|byte| *byte == end);
        let length = length
            .ok_or_else(|| fault!(at(self.at), "expected a byte {end:#04x}, but the file ends"))?;
        self.at += length + 1;
        Ok(&rest[..length])
    }

    /// `Ok` if nothing follows the contents, whose name the error says.
    pub(super) fn end(&self, contents: fmt::Arguments<'_>) -> Result<(), Fault> {
        let left = self.left();
        ensure!(left == 0, at(self.at), "{contents} end here, but {left} bytes follow");
        Ok(())
    }

    /// The next `N` bytes.
    pub(super) fn array<const N: usize>(&mut self) -> Result<[u8; N], Fault> {
        let at = self.at;
        self.take(N)?.try_into().map_err(|_| fault!(at(at), "the file ends"))
    }

    numbers!(u8: u8, u16: u16, i16: i16, u32: u32, i32: i32, i64: i64, u64: u64, f32: f32, f64: f64);
}

/// Where a word begins in bytes.
#[cfg(feature = "io")]
pub(super) fn find(bytes: &[u8], word: &[u8]) -> Option<usize> {
    bytes.windows(word.len()).position(|window| window == word)
}

/// A shape that a grid can have.
pub(super) fn shape(
    nx: impl TryInto<usize>,
    ny: impl TryInto<usize>,
) -> Result<(usize, usize), Fault> {
    let (nx, ny) = (nx.try_into().unwrap_or(usize::MAX), ny.try_into().unwrap_or(usize::MAX));
    Grid::check_nodes(nx, ny)?;
    Ok((nx, ny))
}

/// Latin-1 before the first zero: what follows it means nothing.
#[cfg(feature = "io")]
pub(super) fn text_before_zero(bytes: &[u8]) -> String {
    latin1(bytes.split(|byte| *byte == 0).next().unwrap_or_default())
}

/// Latin-1 without the blanks and zeros that pad it: any bytes have a meaning in it.
#[cfg(feature = "io")]
pub(super) fn latin1(bytes: &[u8]) -> String {
    let text: String = bytes.iter().map(|byte| char::from(*byte)).collect();
    text.trim_matches(|c: char| c == '\0' || c.is_whitespace()).to_string()
}

/// Characters of a text that is kept once for each of many maps.
#[cfg(feature = "io")]
const SHARED: usize = 128;

/// A text that many maps of a file may share, without what is beyond [`SHARED`]: a long one does not take its length
/// once for each.
#[cfg(feature = "io")]
pub(super) fn shared(text: &str) -> String {
    text.chars().take(SHARED).collect()
}
