//! The header of a `.npy` file: the text of a Python dictionary.
//!
//! A matrix of floating-point numbers needs very little of that language. The parser therefore never
//! recurses, and it believes no length before it has compared it with the file.

use std::io::Read;

use super::fault::Fault;

/// Longest header text accepted. NumPy's own limit is 10 000, and a matrix needs about 100.
const MAX_TEXT: usize = 1 << 16;

/// Type of the elements, with their byte order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Element {
    LittleF64,
    BigF64,
    LittleF32,
    BigF32,
}

impl Element {
    fn from_descr(descr: &str) -> Result<Self, Fault> {
        match descr {
            "<f8" => Ok(Self::LittleF64),
            ">f8" => Ok(Self::BigF64),
            "<f4" => Ok(Self::LittleF32),
            ">f4" => Ok(Self::BigF32),
            other => Err(Fault::malformed(format!(
                "the elements are of type '{other}', but only float64 and float32 are read"
            ))),
        }
    }

    /// Bytes an element takes.
    pub(super) fn size(self) -> usize {
        match self {
            Self::LittleF64 | Self::BigF64 => 8,
            Self::LittleF32 | Self::BigF32 => 4,
        }
    }

    /// The value of [`Element::size`] bytes, NaN for another number of bytes.
    pub(super) fn decode(self, bytes: &[u8]) -> f64 {
        let value = match self {
            Self::LittleF64 => bytes.try_into().map(f64::from_le_bytes),
            Self::BigF64 => bytes.try_into().map(f64::from_be_bytes),
            Self::LittleF32 => bytes.try_into().map(|b| f64::from(f32::from_le_bytes(b))),
            Self::BigF32 => bytes.try_into().map(|b| f64::from(f32::from_be_bytes(b))),
        };
        value.unwrap_or(f64::NAN)
    }
}

/// Magic string and version 1.0.
const PREAMBLE: &[u8; 8] = b"\x93NUMPY\x01\x00";

/// The elements of a file begin at a multiple of this many bytes.
const ALIGNMENT: usize = 64;

/// The header of a matrix of `float64`, little-endian, in C order, as NumPy itself writes it.
pub(super) fn of_doubles((nx, ny): (usize, usize)) -> Vec<u8> {
    let mut text = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({nx}, {ny}), }}");
    // The text ends with a line feed, and its length stands before it in two bytes, which are
    // enough: two numbers have at most 40 digits.
    let unpadded = PREAMBLE.len() + 2 + text.len() + 1;
    let padding = unpadded.next_multiple_of(ALIGNMENT) - unpadded;
    text.extend(std::iter::repeat_n(' ', padding));
    text.push('\n');
    let mut header = PREAMBLE.to_vec();
    header.extend((text.len() as u16).to_le_bytes());
    header.extend(text.bytes());
    header
}

/// What a header says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Header {
    pub(super) shape: (usize, usize),
    pub(super) fortran_order: bool,
    pub(super) element: Element,
    /// Length of the header itself: the elements begin there.
    pub(super) bytes: u64,
}

impl Header {
    /// Reads the header of a file of `length` bytes.
    pub(super) fn read(input: &mut impl Read, length: u64) -> Result<Self, Fault> {
        let cut = || Fault::malformed("the file ends within its header");
        let mut preamble = [0; 8];
        if length < preamble.len() as u64 {
            return Err(Fault::malformed("the file is too short for a .npy file"));
        }
        input.read_exact(&mut preamble)?;
        if preamble[..6] != PREAMBLE[..6] {
            return Err(Fault::malformed("the file does not begin like a .npy file"));
        }
        let (width, version) = match preamble[6] {
            1 => (2, 1),
            major @ (2 | 3) => (4, major),
            major => {
                return Err(Fault::malformed(format!(
                    "version {major} of the format is unknown"
                )));
            }
        };
        let start = preamble.len() as u64 + width as u64;
        if length < start {
            return Err(cut());
        }
        let mut size = [0; 4];
        input.read_exact(&mut size[..width])?;
        let size = u32::from_le_bytes(size);
        if length < start + u64::from(size) {
            return Err(cut());
        }
        if size as usize > MAX_TEXT {
            return Err(Fault::malformed(format!(
                "a header of {size} bytes (version {version}) is longer than that of any matrix"
            )));
        }
        let mut text = vec![0; size as usize];
        input.read_exact(&mut text)?;
        let text =
            String::from_utf8(text).map_err(|_| Fault::malformed("the header is not text"))?;
        Self::parse(&text, start + u64::from(size))
    }

    fn parse(text: &str, bytes: u64) -> Result<Self, Fault> {
        let mut text = Cursor(text);
        let (mut descr, mut order, mut shape) = (None, None, None);
        text.expect('{')?;
        while !text.take('}') {
            let key = text.string()?;
            text.expect(':')?;
            match key {
                "descr" if text.at('[') => {
                    return Err(Fault::malformed("the elements are records"));
                }
                "descr" => descr = Some(text.string()?),
                "fortran_order" => order = Some(text.boolean()?),
                "shape" => shape = Some(text.pair()?),
                other => {
                    return Err(Fault::malformed(format!(
                        "the header has an unknown key '{other}'"
                    )));
                }
            }
            if !text.take(',') && !text.at('}') {
                return Err(text.unexpected());
            }
        }
        text.end()?;
        let missing = |key| Fault::malformed(format!("the header lacks the key '{key}'"));
        Ok(Self {
            element: Element::from_descr(descr.ok_or_else(|| missing("descr"))?)?,
            fortran_order: order.ok_or_else(|| missing("fortran_order"))?,
            shape: shape.ok_or_else(|| missing("shape"))?,
            bytes,
        })
    }
}

/// What is left of a header's text.
struct Cursor<'a>(&'a str);

impl<'a> Cursor<'a> {
    fn unexpected(&self) -> Fault {
        let rest: String = self.0.chars().take(20).collect();
        Fault::malformed(format!("the header cannot be read from '{rest}' on"))
    }

    fn at(&mut self, symbol: char) -> bool {
        self.0 = self.0.trim_start();
        self.0.starts_with(symbol)
    }

    fn take(&mut self, symbol: char) -> bool {
        let found = self.at(symbol);
        if found {
            self.0 = &self.0[symbol.len_utf8()..];
        }
        found
    }

    fn expect(&mut self, symbol: char) -> Result<(), Fault> {
        if self.take(symbol) {
            Ok(())
        } else {
            Err(self.unexpected())
        }
    }

    fn end(&self) -> Result<(), Fault> {
        if self.0.trim().is_empty() {
            Ok(())
        } else {
            Err(self.unexpected())
        }
    }

    /// A quoted string without escapes.
    fn string(&mut self) -> Result<&'a str, Fault> {
        let quote = if self.at('"') { '"' } else { '\'' };
        self.expect(quote)?;
        let (string, rest) = self.0.split_once(quote).ok_or_else(|| self.unexpected())?;
        self.0 = rest;
        Ok(string)
    }

    fn boolean(&mut self) -> Result<bool, Fault> {
        let text = self.0.trim_start();
        for (word, value) in [("True", true), ("False", false)] {
            if let Some(rest) = text.strip_prefix(word) {
                self.0 = rest;
                return Ok(value);
            }
        }
        Err(self.unexpected())
    }

    /// A tuple of two integers; numbers too large for the computer become the largest.
    fn pair(&mut self) -> Result<(usize, usize), Fault> {
        self.expect('(')?;
        let mut sides = Vec::new();
        while !self.take(')') {
            sides.push(self.integer()?);
            if !self.take(',') && !self.at(')') {
                return Err(self.unexpected());
            }
        }
        match sides[..] {
            [nx, ny] => Ok((nx, ny)),
            _ => Err(Fault::malformed(format!(
                "the array has {} dimensions, but a height map has 2",
                sides.len()
            ))),
        }
    }

    fn integer(&mut self) -> Result<usize, Fault> {
        let text = self.0.trim_start();
        let digits = text.bytes().take_while(u8::is_ascii_digit).count();
        if digits == 0 {
            return Err(self.unexpected());
        }
        let (number, rest) = text.split_at(digits);
        // Python 2 ended long integers with an L.
        self.0 = rest.strip_prefix('L').unwrap_or(rest);
        // Only digits: the one error left is a number that is too large.
        Ok(number.parse().unwrap_or(usize::MAX))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headers_of_every_writer_are_understood() -> Result<(), Fault> {
        let expected = Header {
            shape: (3, 40),
            fortran_order: true,
            element: Element::BigF32,
            bytes: 0,
        };
        for text in [
            "{'descr': '>f4', 'fortran_order': True, 'shape': (3, 40), }          \n",
            "{'shape': (3L, 40L), 'fortran_order': True, 'descr': '>f4'}",
            "{\"descr\":\">f4\",\"shape\":(3,40,),\"fortran_order\":True}\n",
            "  { 'descr' :\t'>f4' , 'fortran_order' : True , 'shape' : ( 3 , 40 ) } ",
        ] {
            assert_eq!(Header::parse(text, 0)?, expected, "{text}");
        }
        Ok(())
    }

    #[test]
    fn other_headers_are_refused() {
        for text in [
            "",
            "{}",
            "{'descr': '<f8', 'fortran_order': False}",
            "{'descr': '<f8', 'shape': (3, 4)}",
            "{'fortran_order': False, 'shape': (3, 4)}",
            "{'descr': '<i4', 'fortran_order': False, 'shape': (3, 4)}",
            "{'descr': '|O', 'fortran_order': False, 'shape': (3, 4)}",
            "{'descr': [('a', '<f8')], 'fortran_order': False, 'shape': (3, 4)}",
            "{'descr': '<f8', 'fortran_order': 0, 'shape': (3, 4)}",
            "{'descr': '<f8', 'fortran_order': False, 'shape': (3,)}",
            "{'descr': '<f8', 'fortran_order': False, 'shape': ()}",
            "{'descr': '<f8', 'fortran_order': False, 'shape': (3, 4, 5)}",
            "{'descr': '<f8', 'fortran_order': False, 'shape': (-3, 4)}",
            "{'descr': '<f8', 'fortran_order': False, 'shape': (3 4)}",
            "{'descr': '<f8', 'fortran_order': False, 'shape': 3}",
            "{'descr': '<f8' 'fortran_order': False, 'shape': (3, 4)}",
            "{'descr': '<f8', 'fortran_order': False, 'shape': (3, 4), 'x': 1}",
            "{'descr': '<f8', 'fortran_order': False, 'shape': (3, 4)} 1",
            "{'descr': '<f8, 'fortran_order': False, 'shape': (3, 4)}",
            "{{{{{{{{",
            "{'é",
        ] {
            let refused = Header::parse(text, 0);
            assert!(matches!(refused, Err(Fault::Malformed(_))), "{text}");
        }
    }
}
