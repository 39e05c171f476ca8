//! The tree of objects in a Gwyddion file.
//!
//! An object is its name, the length of its body, and the body: components with a name, a type and a value. Whoever
//! walks over components sees objects among them as values and goes down where there is a reason to: nothing here calls
//! itself, so that no depth of nesting can exhaust the stack.

use crate::io::bytes::Bytes;
use crate::io::fault::Fault;

/// An object somewhere in a file.
#[derive(Debug, Clone, Copy)]
pub(super) struct Object<'a> {
    pub(super) name: &'a [u8],
    /// The file up to the end of the object, so that places in it are places in the file.
    within: &'a [u8],
    /// Where its components begin in the file.
    pub(super) begin: usize,
}

/// The value of a component, as far as maps need it.
#[derive(Debug, Clone, Copy)]
pub(super) enum Value<'a> {
    Int(i32),
    Double(f64),
    Text(&'a [u8]),
    /// Eight bytes for each number.
    Doubles(&'a [u8]),
    Object(Object<'a>),
    Other,
}

impl<'a> Object<'a> {
    /// The object that begins at a place in `within`.
    pub(super) fn read(within: &'a [u8], bytes: &mut Bytes<'a>) -> Result<Self, Fault> {
        let name = bytes.until(0)?;
        let size = bytes.u32()? as usize;
        let begin = bytes.offset();
        bytes.take(size)?;
        Ok(Self { name, within: within.get(..bytes.offset()).unwrap_or(within), begin })
    }

    pub(super) fn components(&self) -> Result<Components<'a>, Fault> {
        Ok(Components { bytes: Bytes::from(self.within, self.begin)?, within: self.within })
    }

    /// The value of the first component of this name.
    pub(super) fn find(&self, name: &str) -> Result<Option<Value<'a>>, Fault> {
        for component in self.components()? {
            let (found, value) = component?;
            if found == name.as_bytes() {
                return Ok(Some(value));
            }
        }
        Ok(None)
    }
}

/// The components of an object, each read when it is asked for. After an error there is no sense in going on.
#[derive(Debug)]
pub(super) struct Components<'a> {
    bytes: Bytes<'a>,
    within: &'a [u8],
}

impl<'a> Iterator for Components<'a> {
    type Item = Result<(&'a [u8], Value<'a>), Fault>;

    fn next(&mut self) -> Option<Self::Item> {
        (self.bytes.left() > 0).then(|| self.component())
    }
}

impl<'a> Components<'a> {
    fn component(&mut self) -> Result<(&'a [u8], Value<'a>), Fault> {
        let bytes = &mut self.bytes;
        let at = bytes.offset();
        let name = bytes.until(0)?;
        let kind = bytes.u8()?;
        // Capital letters are arrays of what small ones are.
        let count = if kind.is_ascii_uppercase() { bytes.u32()? as usize } else { 1 };
        let value = match kind {
            b'i' => Value::Int(bytes.i32()?),
            b'd' => Value::Double(bytes.f64()?),
            b's' => Value::Text(bytes.until(0)?),
            b'o' => Value::Object(Object::read(self.within, bytes)?),
            b'D' => Value::Doubles(bytes.elements(count, 8)?),
            b'b' | b'c' | b'C' => skipped(bytes.elements(count, 1)?),
            b'I' => skipped(bytes.elements(count, 4)?),
            b'q' | b'Q' => skipped(bytes.elements(count, 8)?),
            // Elements that say themselves how long they are.
            b'S' => (0..count).try_for_each(|_| bytes.until(0).map(drop)).map(skipped)?,
            b'O' => (0..count)
                .try_for_each(|_| Object::read(self.within, bytes).map(drop))
                .map(skipped)?,
            _ => bail!(
                at(at),
                "the component '{}' has the type {kind:#04x}, which is none of bciqdsoCIQDSO",
                String::from_utf8_lossy(name)
            ),
        };
        Ok((name, value))
    }
}

fn skipped<'a, T>(_: T) -> Value<'a> {
    Value::Other
}
