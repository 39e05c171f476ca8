//! How numbers lie in a file.

/// A type of number, little-endian.
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

    /// The value of [`Number::size`] bytes, NaN for another number of bytes. Integers beyond 2⁵³ are rounded.
    pub(super) fn decode(self, bytes: &[u8]) -> f64 {
        let mut little = [0; 8];
        let Some(raw) = little.get_mut(..bytes.len()) else {
            return f64::NAN;
        };
        raw.copy_from_slice(bytes);
        let bits = u64::from_le_bytes(little);
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
}
