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
    pub(super) number: Number,
    big_endian: bool,
}

impl Element {
    pub(super) fn from_descr(descr: &str) -> Result<Self, Fault> {
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
            _ => bail!(
                "the elements are of type '{descr}', but only float64, float32 and integers are read"
            ),
        };
        Ok(Self { number, big_endian: descr.starts_with('>') })
    }

    /// The value of an element.
    pub(super) fn decode(self, bytes: &[u8]) -> f64 {
        if self.big_endian {
            self.number.decode(bytes.iter())
        } else {
            self.number.decode(bytes.iter().rev())
        }
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
        let begins = preamble[..6] == PREAMBLE[..6];
        ensure!(begins, at(0), "the file does not begin like a .npy file");
        let size = match preamble[6] {
            1 => usize::from(bytes.u16()?),
            2 | 3 => bytes.u32()? as usize,
            major => bail!(at(6), "version {major} of the format is unknown"),
        };
        let is_short = size <= MAX_TEXT;
        ensure!(is_short, at(8), "a header of {size} bytes is longer than that of any matrix");
        let text = std::str::from_utf8(bytes.take(size)?);
        Self::parse(text.map_err(|_| fault!("the header is not text"))?)
    }

    /// The header of an array of `N` dimensions, and its sides.
    pub(super) fn of_dimensions<const N: usize>(
        bytes: &mut Bytes,
    ) -> Result<(Self, [usize; N]), Fault> {
        let header = Self::read(bytes)?;
        let found = header.shape.len();
        let sides = header.shape[..].try_into();
        let sides = sides
            .map_err(|_| fault!("the number of dimensions is {found}, but {N} was expected"))?;
        Ok((header, sides))
    }

    fn parse(text: &str) -> Result<Self, Fault> {
        let mut rest = Cursor(text);
        let entries = rest.dictionary().ok_or_else(|| {
            let shown: String = rest.0.chars().take(20).collect();
            fault!("the header cannot be read from '{shown}' on")
        });
        let (descr, order, shape) = entries?;
        let lacks = |key| fault!("the header lacks the key '{key}'");
        Ok(Self {
            descr: descr.ok_or_else(|| lacks("descr"))?.to_string(),
            fortran_order: order.ok_or_else(|| lacks("fortran_order"))?,
            shape: shape.ok_or_else(|| lacks("shape"))?,
        })
    }
}

/// The values of the keys `descr`, `fortran_order` and `shape`.
type Entries<'a> = (Option<&'a str>, Option<bool>, Option<Vec<usize>>);

/// What is left of a header's text. Where it is not what it should be, methods return `None` and stay there.
struct Cursor<'a>(&'a str);

impl<'a> Cursor<'a> {
    fn dictionary(&mut self) -> Option<Entries<'a>> {
        let mut entries = Entries::default();
        self.expect('{')?;
        while !self.take('}') {
            let key = self.string()?;
            self.expect(':')?;
            match key {
                "descr" => entries.0 = Some(self.string()?),
                "fortran_order" => entries.1 = Some(self.boolean()?),
                "shape" => entries.2 = Some(self.sides()?),
                _ => return None,
            }
            self.comma('}')?;
        }
        self.0.trim().is_empty().then_some(entries)
    }

    /// Whether this sign comes next; it is skipped then.
    fn take(&mut self, sign: char) -> bool {
        let rest = self.0.trim_start().strip_prefix(sign);
        self.0 = rest.unwrap_or(self.0);
        rest.is_some()
    }

    fn expect(&mut self, sign: char) -> Option<()> {
        self.take(sign).then_some(())
    }

    /// A comma, which may lack before the sign that ends a list.
    fn comma(&mut self, end: char) -> Option<()> {
        (self.take(',') || self.0.trim_start().starts_with(end)).then_some(())
    }

    /// A quoted string without escapes.
    fn string(&mut self) -> Option<&'a str> {
        let text = self.0.trim_start();
        let quote = text.chars().next().filter(|sign| matches!(sign, '"' | '\''))?;
        let (string, rest) = text[1..].split_once(quote)?;
        self.0 = rest;
        Some(string)
    }

    fn boolean(&mut self) -> Option<bool> {
        let text = self.0.trim_start();
        let words = [("True", true), ("False", false)];
        let (rest, value) =
            words.iter().find_map(|(word, value)| Some((text.strip_prefix(word)?, *value)))?;
        self.0 = rest;
        Some(value)
    }

    /// A tuple of integers; numbers too large for the computer become the largest.
    fn sides(&mut self) -> Option<Vec<usize>> {
        self.expect('(')?;
        let mut sides = Vec::new();
        while !self.take(')') {
            let text = self.0.trim_start();
            let digits = text.bytes().take_while(u8::is_ascii_digit).count();
            let (number, rest) = (digits > 0).then(|| text.split_at(digits))?;
            // Python 2 ended long integers with an L.
            self.0 = rest.strip_prefix('L').unwrap_or(rest);
            // Only digits: the one error left is a number that is too large.
            sides.push(number.parse().unwrap_or(usize::MAX));
            self.comma(')')?;
        }
        Some(sides)
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
