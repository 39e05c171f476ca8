//! Compound documents (OLE): files in a file. Source: Microsoft's [MS-CFB].
//!
//! Sectors of one size follow the header; a table has the next sector of each, a directory the first one of each
//! stream. Streams shorter than a limit are in sectors of 64 bytes of a stream of their own, with such a table too.

use super::bytes::Bytes;
use super::fault::Fault;

pub(super) const BEGINS: &[u8] = b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1";

/// From here on the number of a sector is none, but the end of a chain or a sector that is free.
const NONE: u32 = 0xffff_fffa;
/// Numbers of sectors of the table that the header has.
const IN_HEADER: usize = 109;
/// Bytes of an entry of the directory.
const ENTRY: usize = 128;

/// The stream of this name, `None` if there is none.
pub(super) fn stream(file: &[u8], name: &str) -> Result<Option<Vec<u8>>, Fault> {
    let number = |place: usize| Bytes::from(file, place)?.u32();
    let shift = |place: usize| Bytes::from(file, place)?.u16();
    let (sector, short) = (shift(30)?, shift(32)?);
    ensure!(
        [9, 12].contains(&sector) && short == 6,
        at(30),
        "sectors of 2^{sector} and 2^{short} bytes, but 2^9 or 2^12 and 2^6 were expected"
    );
    let whole = Sectors { bytes: file, size: 1 << sector, begin: 1 << sector };
    let table = table(&whole, number(68)?, number(44)?)?;
    let directory = whole.chain(&table, number(48)?)?;
    let text: Vec<u8> = name.encode_utf16().flat_map(u16::to_le_bytes).collect();
    let mut container = None;
    let mut found = None;
    for entry in directory.chunks_exact(ENTRY) {
        let mut bytes = Bytes::from(entry, 116)?;
        // Half of it counts where sectors have 512 bytes: the other half may be anything.
        let (first, length) = (bytes.u32()?, bytes.u64()?);
        let length = if sector == 9 { length & u64::from(u32::MAX) } else { length };
        let is_named = entry.starts_with(&text) && entry[text.len()..].starts_with(&[0, 0]);
        match entry[66] {
            5 => container = Some(first),
            2 if is_named => {
                ensure!(found.is_none(), "there are several streams '{name}'");
                found = Some((first, usize::try_from(length).unwrap_or(usize::MAX)));
            }
            _ => {}
        }
    }
    let Some((first, length)) = found else {
        return Ok(None);
    };
    let mut bytes = if length < number(56)? as usize {
        let first_of_all = container.ok_or_else(|| fault!("the directory has no root"))?;
        let bytes = whole.chain(&table, first_of_all)?;
        let short = Sectors { bytes: &bytes, size: 64, begin: 0 };
        short.chain(&numbers(&whole.chain(&table, number(60)?)?), first)?
    } else {
        whole.chain(&table, first)?
    };
    ensure!(
        length <= bytes.len(),
        "the stream '{name}' has {length} bytes, but its sectors have {}",
        bytes.len()
    );
    bytes.truncate(length);
    Ok(Some(bytes))
}

/// The next sector of each: in sectors whose numbers are in the header, and in a chain of further ones.
fn table(whole: &Sectors, mut further: u32, count: u32) -> Result<Vec<u32>, Fault> {
    let mut begin = Bytes::from(whole.bytes, 76)?;
    let mut places = numbers(begin.take(4 * IN_HEADER)?);
    let mut chained = 0;
    while further < NONE {
        chained += 1;
        ensure!(chained <= whole.count(), "the table of sectors runs in a circle");
        let mut more = numbers(whole.sector(further)?);
        further = more.pop().unwrap_or(NONE);
        places.append(&mut more);
    }
    let mut table = Vec::new();
    for place in places.into_iter().filter(|place| *place < NONE).take(count as usize) {
        ensure!(table.len() <= whole.bytes.len(), "the table of sectors is longer than the file");
        table.append(&mut numbers(whole.sector(place)?));
    }
    Ok(table)
}

fn numbers(bytes: &[u8]) -> Vec<u32> {
    let words = bytes.chunks_exact(4);
    words
        .map(|word| word.iter().rev().fold(0, |number, byte| number << 8 | u32::from(*byte)))
        .collect()
}

/// Sectors of one size, from a place on.
struct Sectors<'a> {
    bytes: &'a [u8],
    size: usize,
    begin: usize,
}

impl<'a> Sectors<'a> {
    fn count(&self) -> usize {
        self.bytes.len().div_ceil(self.size)
    }

    fn sector(&self, number: u32) -> Result<&'a [u8], Fault> {
        let begin = (number as usize).saturating_mul(self.size).saturating_add(self.begin);
        let end = begin.saturating_add(self.size).min(self.bytes.len());
        self.bytes
            .get(begin..end)
            .filter(|sector| !sector.is_empty())
            .ok_or_else(|| fault!("sector {number} is beyond the end"))
    }

    /// All bytes of the chain that begins with a sector.
    fn chain(&self, table: &[u32], first: u32) -> Result<Vec<u8>, Fault> {
        let mut bytes = Vec::new();
        let mut sector = first;
        while sector < NONE {
            bytes.extend_from_slice(self.sector(sector)?);
            ensure!(bytes.len() <= self.bytes.len(), "a chain of sectors runs in a circle");
            sector = *table
                .get(sector as usize)
                .ok_or_else(|| fault!("the table of sectors has no sector {sector}"))?;
        }
        Ok(bytes)
    }
}

#[cfg(test)]
mod tests;
