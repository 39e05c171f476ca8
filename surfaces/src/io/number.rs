//! How numbers lie in a file.

#[cfg(feature = "io")]
use super::bytes::{Order, reserved};
#[cfg(feature = "io")]
use super::fault::Fault;

/// A type of number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Number {
    F64,
    F32,
    I8,
    I16,
    I32,
    I64,
    U8,
    U16,
    U32,
    U64,
}

impl Number {
    /// Bytes a number takes.
    pub(super) fn size(self) -> usize {
        match self {
            Self::F64 | Self::I64 | Self::U64 => 8,
            Self::F32 | Self::I32 | Self::U32 => 4,
            Self::I16 | Self::U16 => 2,
            Self::I8 | Self::U8 => 1,
        }
    }

    /// The value of [`Number::size`] bytes, the most significant first. Integers beyond 2⁵³ are rounded.
    pub(super) fn decode<'a>(self, bytes: impl Iterator<Item = &'a u8>) -> f64 {
        let bits = bytes.fold(0_u64, |bits, byte| bits << 8 | u64::from(*byte));
        match self {
            Self::F64 => f64::from_bits(bits),
            Self::F32 => f64::from(f32::from_bits(bits as u32)),
            Self::I8 => f64::from(bits as i8),
            Self::I16 => f64::from(bits as i16),
            Self::I32 => f64::from(bits as i32),
            Self::I64 => bits as i64 as f64,
            Self::U8 | Self::U16 | Self::U32 | Self::U64 => bits as f64,
        }
    }

    /// What `map` makes of each of the numbers, little-endian, in `bytes`, with memory asked for once.
    #[cfg(feature = "io")]
    pub(super) fn decode_all(
        self,
        bytes: &[u8],
        map: impl Fn(f64) -> f64,
    ) -> Result<Vec<f64>, Fault> {
        self.decode_ordered(bytes, Order::Little, map)
    }

    /// The same in any order.
    #[cfg(feature = "io")]
    pub(super) fn decode_ordered(
        self,
        bytes: &[u8],
        order: Order,
        map: impl Fn(f64) -> f64,
    ) -> Result<Vec<f64>, Fault> {
        let mut values = reserved(bytes.len() / self.size())?;
        let numbers = bytes.chunks_exact(self.size());
        values.extend(numbers.map(|number| {
            map(match order {
                Order::Little => self.decode(number.iter().rev()),
                Order::Big => self.decode(number.iter()),
            })
        }));
        Ok(values)
    }
}

/// The number that a text is, the defect of the field of this name, and place if it has one, otherwise.
#[cfg(feature = "io")]
pub(super) fn parsed<T: std::str::FromStr>(
    name: &str,
    text: &str,
    at: impl Into<Option<usize>>,
) -> Result<T, Fault> {
    text.parse().map_err(|_| {
        let shown: String = text.chars().take(40).collect();
        let reason = format!("{name} is '{shown}', but a number was expected");
        Fault::Malformed { offset: at.into(), reason }
    })
}

/// `Ok(value)` if it is positive and finite, the defect of the field of this name, and place if it has one, otherwise.
#[cfg(feature = "io")]
pub(super) fn positive(name: &str, value: f64, at: impl Into<Option<usize>>) -> Result<f64, Fault> {
    if value > 0.0 && value.is_finite() {
        return Ok(value);
    }
    let reason = format!("{name} is {value}, but a positive number was expected");
    Err(Fault::Malformed { offset: at.into(), reason })
}
