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
    name: &'a [u8],
    /// The file up to the end of the object, so that places in it are places in the file.
    within: &'a [u8],
    begin: usize,
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
        let size = bytes.u32()?;
        let begin = bytes.offset();
        bytes.elements(usize::try_from(size).unwrap_or(usize::MAX), 1)?;
        Ok(Self { name, within: within.get(..bytes.offset()).unwrap_or(within), begin })
    }

    /// Where its components begin in the file.
    pub(super) fn begin(&self) -> usize {
        self.begin
    }

    pub(super) fn is(&self, name: &str) -> bool {
        self.name == name.as_bytes()
    }

    /// Its name, for messages.
    pub(super) fn name(&self) -> String {
        String::from_utf8_lossy(self.name).into_owned()
    }

    pub(super) fn components(&self) -> Result<Components<'a>, Fault> {
        let mut bytes = Bytes::new(self.within);
        bytes.seek(self.begin)?;
        Ok(Components { bytes, within: self.within })
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
        let at = self.bytes.offset();
        let name = self.bytes.until(0)?;
        let kind = self.bytes.u8()?;
        let value = match kind {
            b'i' => Value::Int(self.bytes.i32()?),
            b'd' => Value::Double(self.bytes.f64()?),
            b's' => Value::Text(self.bytes.until(0)?),
            b'o' => Value::Object(Object::read(self.within, &mut self.bytes)?),
            b'D' => Value::Doubles(self.array(8)?),
            b'b' | b'c' => self.skip(1)?,
            b'q' => self.skip(8)?,
            b'C' => self.array(1).map(|_| Value::Other)?,
            b'I' => self.array(4).map(|_| Value::Other)?,
            b'Q' => self.array(8).map(|_| Value::Other)?,
            b'S' => self.each(|bytes, _| bytes.until(0).map(|_| ()))?,
            b'O' => self.each(|bytes, within| Object::read(within, bytes).map(|_| ()))?,
            _ => {
                return Err(Fault::at(
                    at,
                    format!(
                        "the component '{}' has the type {kind:#04x}, which is none of bciqdsoCIQDSO",
                        String::from_utf8_lossy(name)
                    ),
                ));
            }
        };
        Ok((name, value))
    }

    fn skip(&mut self, count: usize) -> Result<Value<'a>, Fault> {
        self.bytes.take(count).map(|_| Value::Other)
    }

    fn count(&mut self) -> Result<usize, Fault> {
        let count = self.bytes.u32()?;
        Ok(usize::try_from(count).unwrap_or(usize::MAX))
    }

    fn array(&mut self, size: usize) -> Result<&'a [u8], Fault> {
        let count = self.count()?;
        self.bytes.elements(count, size)
    }

    /// Skips an array whose elements say themselves how long they are.
    fn each(
        &mut self,
        skip: impl Fn(&mut Bytes<'a>, &'a [u8]) -> Result<(), Fault>,
    ) -> Result<Value<'a>, Fault> {
        for _ in 0..self.count()? {
            skip(&mut self.bytes, self.within)?;
        }
        Ok(Value::Other)
    }
}
