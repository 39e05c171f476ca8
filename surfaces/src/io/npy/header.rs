//! The header of a `.npy` file: the text of a Python dictionary.
//!
//! A matrix of floating-point numbers needs very little of that language. The parser therefore never
//! recurses, and it believes no length before it has compared it with the file.

use crate::io::bytes::Bytes;
use crate::io::fault::Fault;
use crate::io::number::Number;

/// Longest header text accepted. NumPy's own limit is 10 000, and a matrix needs about 100.
const MAX_TEXT: usize = 1 << 16;

/// Type of the elements.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Element {
    number: Number,
    big_endian: bool,
}

impl Element {
    pub(super) fn from_descr(descr: &str) -> Result<Self, Fault> {
        let big_endian = descr.starts_with('>');
        let number = match descr.trim_start_matches(['<', '>', '|', '=']) {
            "f8" => Number::F64,
            "f4" => Number::F32,
            "i1" => Number::I8,
            "i2" => Number::I16,
            "i4" => Number::I32,
            "i8" => Number::I64,
            "u1" => Number::U8,
            "u2" => Number::U16,
            "u4" => Number::U32,
            "u8" => Number::U64,
            _ => {
                return Err(Fault::malformed(format!(
                    "the elements are of type '{descr}', but only float64, float32 and integers are read"
                )));
            }
        };
        Ok(Self { number, big_endian })
    }

    /// Bytes an element takes.
    pub(super) fn size(self) -> usize {
        self.number.size()
    }

    /// The value of [`Element::size`] bytes, NaN for another number of bytes.
    pub(super) fn decode(self, bytes: &[u8]) -> f64 {
        if !self.big_endian {
            return self.number.decode(bytes);
        }
        let mut little = [0; 8];
        let Some(raw) = little.get_mut(..bytes.len()) else {
            return f64::NAN;
        };
        raw.copy_from_slice(bytes);
        raw.reverse();
        self.number.decode(raw)
    }
}

/// Magic string and version 1.0.
const PREAMBLE: &[u8; 8] = b"\x93NUMPY\x01\x00";

/// The elements of a file begin at a multiple of this many bytes.
const ALIGNMENT: usize = 64;

/// The header of an array in C order, as NumPy itself writes it.
pub(crate) fn header_of(descr: &str, shape: &[usize]) -> Vec<u8> {
    let sides: Vec<String> = shape.iter().map(usize::to_string).collect();
    // Python's tuple of one has a comma.
    let comma = if shape.len() == 1 { "," } else { "" };
    let mut text = format!(
        "{{'descr': '{descr}', 'fortran_order': False, 'shape': ({}{comma}), }}",
        sides.join(", ")
    );
    // The text ends with a line feed, and its length stands before it in two bytes, which are
    // enough: no array of this crate has more than two dimensions, of at most 20 digits each.
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
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Header {
    pub(super) shape: Vec<usize>,
    pub(super) fortran_order: bool,
    /// Type of the elements, as the file writes it.
    pub(super) descr: String,
}

impl Header {
    /// Reads the header, up to the first element.
    pub(super) fn read(bytes: &mut Bytes) -> Result<Self, Fault> {
        let preamble: [u8; 8] = bytes.array()?;
        if preamble[..6] != PREAMBLE[..6] {
            return Err(Fault::at(0, "the file does not begin like a .npy file"));
        }
        let size = match preamble[6] {
            1 => usize::from(bytes.u16()?),
            2 | 3 => bytes.u32()? as usize,
            major => {
                return Err(Fault::at(6, format!("version {major} of the format is unknown")));
            }
        };
        if size > MAX_TEXT {
            return Err(Fault::at(
                8,
                format!("a header of {size} bytes is longer than that of any matrix"),
            ));
        }
        let text = std::str::from_utf8(bytes.take(size)?)
            .map_err(|_| Fault::malformed("the header is not text"))?;
        Self::parse(text)
    }

    fn parse(text: &str) -> Result<Self, Fault> {
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
                "shape" => shape = Some(text.sides()?),
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
            descr: descr.ok_or_else(|| missing("descr"))?.to_string(),
            fortran_order: order.ok_or_else(|| missing("fortran_order"))?,
            shape: shape.ok_or_else(|| missing("shape"))?,
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
        if self.take(symbol) { Ok(()) } else { Err(self.unexpected()) }
    }

    fn end(&self) -> Result<(), Fault> {
        if self.0.trim().is_empty() { Ok(()) } else { Err(self.unexpected()) }
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

    /// A tuple of integers; numbers too large for the computer become the largest.
    fn sides(&mut self) -> Result<Vec<usize>, Fault> {
        self.expect('(')?;
        let mut sides = Vec::new();
        while !self.take(')') {
            sides.push(self.integer()?);
            if !self.take(',') && !self.at(')') {
                return Err(self.unexpected());
            }
        }
        Ok(sides)
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
        let expected = Header { shape: vec![3, 40], fortran_order: true, descr: ">f4".to_string() };
        for text in [
            "{'descr': '>f4', 'fortran_order': True, 'shape': (3, 40), }          \n",
            "{'shape': (3L, 40L), 'fortran_order': True, 'descr': '>f4'}",
            "{\"descr\":\">f4\",\"shape\":(3,40,),\"fortran_order\":True}\n",
            "  { 'descr' :\t'>f4' , 'fortran_order' : True , 'shape' : ( 3 , 40 ) } ",
        ] {
            assert_eq!(Header::parse(text)?, expected, "{text}");
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
            "{'descr': [('a', '<f8')], 'fortran_order': False, 'shape': (3, 4)}",
            "{'descr': '<f8', 'fortran_order': 0, 'shape': (3, 4)}",
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
            let refused = Header::parse(text);
            assert!(matches!(refused, Err(Fault::Malformed { .. })), "{text}");
        }
    }
}
