//! Documents that are written here as [MS-CFB] says, and read.

use super::*;
use crate::io::bytes::find;
use crate::io::testing::TestResult;

const END: u32 = 0xffff_fffe;
const FREE: u32 = 0xffff_ffff;
const OF_TABLE: u32 = 0xffff_fffd;
const OF_FURTHER: u32 = 0xffff_fffc;

/// Sectors, and which one follows each.
struct Writer {
    size: usize,
    sectors: Vec<u8>,
    table: Vec<u32>,
}

impl Writer {
    fn add(&mut self, bytes: &[u8], next: u32) -> u32 {
        self.sectors.extend_from_slice(bytes);
        self.table.push(next);
        self.sectors.resize(self.table.len() * self.size, 0);
        self.table.len() as u32 - 1
    }

    /// The first sector of bytes that lie from their end on.
    fn chain(&mut self, bytes: &[u8]) -> u32 {
        bytes.chunks(self.size).rev().fold(END, |next, chunk| self.add(chunk, next))
    }
}

fn words(numbers: &[u32]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
}

fn entry(name: &str, kind: u8, child: u32, first: u32, length: u64) -> Vec<u8> {
    let mut entry: Vec<u8> = name.encode_utf16().flat_map(u16::to_le_bytes).collect();
    let end = entry.len() as u16 + 2;
    entry.resize(64, 0);
    entry.extend(end.to_le_bytes());
    entry.extend([kind, 1]);
    entry.extend(words(&[FREE, FREE, child]));
    entry.resize(116, 0);
    entry.extend(first.to_le_bytes());
    entry.extend(length.to_le_bytes());
    entry
}

/// A document with the stream `Heights`, in sectors of 2^`shift` bytes, behind so many free ones.
fn document(stream: &[u8], shift: u16, free: usize) -> Vec<u8> {
    let size = 1 << shift;
    let mut whole = Writer { size, sectors: Vec::new(), table: vec![FREE; free] };
    whole.sectors.resize(free * size, 0);
    let (first, container, short_table) = if stream.len() < 4096 {
        let mut short = Writer { size: 64, sectors: Vec::new(), table: Vec::new() };
        let first = short.chain(stream);
        (first, whole.chain(&short.sectors), whole.chain(&words(&short.table)))
    } else {
        (whole.chain(stream), END, END)
    };
    let root = entry("Root Entry", 5, 1, container, 0);
    let directory = [root, entry("Heights", 2, FREE, first, stream.len() as u64)].concat();
    let directory = whole.chain(&directory);
    // The table has to hold itself, and the sectors with the numbers of its own that the header has no room for.
    let (mut tables, mut further) = (0, 0);
    while 4 * (whole.table.len() + tables + further) > tables * size {
        tables += 1;
        further = tables.saturating_sub(IN_HEADER).div_ceil(size / 4 - 1);
    }
    let begin = (whole.table.len() + further) as u32;
    let mut places: Vec<u32> = (begin..begin + tables as u32).collect();
    let beyond = places.split_off(tables.min(IN_HEADER));
    places.resize(IN_HEADER, FREE);
    let first_further = if further > 0 { begin - further as u32 } else { END };
    for (k, numbers) in beyond.chunks(size / 4 - 1).enumerate() {
        let mut numbers = numbers.to_vec();
        numbers.resize(size / 4 - 1, FREE);
        numbers.push(if k + 1 < further { first_further + k as u32 + 1 } else { END });
        whole.add(&words(&numbers), OF_FURTHER);
    }
    let mut table = whole.table.clone();
    table.resize(table.len() + tables, OF_TABLE);
    table.resize(tables * size / 4, FREE);
    whole.sectors.extend(words(&table));

    let mut file = BEGINS.to_vec();
    file.resize(24, 0);
    file.extend(
        [0x3e, if shift == 9 { 3 } else { 4 }, 0xfffe, shift, 6].map(u16::to_le_bytes).concat(),
    );
    file.resize(44, 0);
    file.extend(words(&[tables as u32, directory, 0, 4096, short_table, 1, first_further]));
    file.extend(words(&[further as u32]));
    file.extend(words(&places));
    file.resize(size, 0);
    file.extend(whole.sectors);
    file
}

fn content(length: usize) -> Vec<u8> {
    (0..length).map(|k| (k * k / 7) as u8).collect()
}

#[test]
fn streams_of_any_length_are_found_in_sectors_of_both_sizes() -> TestResult {
    for shift in [9, 12] {
        for length in [0, 1, 64, 65, 512, 4095, 4096, 4097, 20_000] {
            let file = document(&content(length), shift, 3);
            let found = stream(&file, "Heights")?;
            assert!(found == Some(content(length)), "{length} bytes in sectors of 2^{shift}");
            assert!(stream(&file, "Height")?.is_none());
        }
    }
    Ok(())
}

/// 110 sectors of the table and more: the header has room for the numbers of 109.
#[test]
fn the_table_may_be_longer_than_the_header_says() -> TestResult {
    for (length, free) in [(300, 14_000), (9000, 14_000), (9000, 33_000)] {
        let file = document(&content(length), 9, free);
        assert!(numbers(&file[44..48])[0] as usize > IN_HEADER);
        assert!(stream(&file, "Heights")? == Some(content(length)), "{free}");
        // The numbers of further sectors follow each other in a circle, are elsewhere, or not counted.
        let first = numbers(&file[68..72])[0];
        let next = 512 * (first as usize + 2) - 4;
        for (place, number, reason) in [
            (next, first, "runs in a circle"),
            (next, 1_000_000, "is beyond the end"),
            (68, 1_000_000, "is beyond the end"),
            (44, 109, "has no sector"),
        ] {
            let mut damaged = file.clone();
            damaged[place..place + 4].copy_from_slice(&number.to_le_bytes());
            let refused = stream(&damaged, "Heights").map_err(|fault| fault.to_string());
            assert!(refused.is_err_and(|text| text.contains(reason)), "{reason}");
        }
    }
    Ok(())
}

/// Any word of header, directory and tables is wrong: there is an answer, never longer than the file.
#[test]
fn damaged_chains_and_lengths_end() {
    for (shift, length) in [(9, 700), (9, 5000), (12, 700), (12, 5000)] {
        let file = document(&content(length), shift, 1);
        for place in (24..file.len()).step_by(4) {
            for number in [0_u32, 1, 2, 77, 1 << 20, END, FREE] {
                let mut damaged = file.clone();
                damaged[place..place + 4].copy_from_slice(&number.to_le_bytes());
                if let Ok(Some(found)) = stream(&damaged, "Heights") {
                    assert!(found.len() <= file.len(), "{number} at {place}");
                }
            }
        }
    }
}

/// A length takes eight bytes where sectors have 4096, and four of them where they have 512.
#[test]
fn long_lengths_are_not_cut() -> TestResult {
    for (shift, is_read) in [(9, true), (12, false)] {
        let mut file = document(&content(5000), shift, 0);
        let place = find(&file, &5000_u64.to_le_bytes()).ok_or("no length")?;
        file[place + 4] = 1;
        assert_eq!(stream(&file, "Heights").is_ok(), is_read, "2^{shift}");
    }
    Ok(())
}

#[test]
fn one_of_two_streams_of_a_name_is_not_chosen() -> TestResult {
    let mut file = document(&content(5000), 9, 0);
    let place = find(&file, b"H\0e\0i\0g").ok_or("no entry")?;
    let copy = file[place..place + ENTRY].to_vec();
    file[place + ENTRY..place + 2 * ENTRY].copy_from_slice(&copy);
    assert!(stream(&file, "Heights").is_err_and(|fault| fault.to_string().contains("several")));
    Ok(())
}
