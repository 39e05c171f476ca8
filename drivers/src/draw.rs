//! Numbers and choices out of bytes.

use arbitrary::Unstructured;

/// Draws from bytes; when they are used up, every draw is the least there is.
#[derive(Debug)]
pub(crate) struct Draw<'a>(Unstructured<'a>);

impl<'a> Draw<'a> {
    pub(crate) fn new(bytes: &'a [u8]) -> Self {
        Self(Unstructured::new(bytes))
    }

    /// A whole number from `least` to `most`.
    pub(crate) fn whole(&mut self, least: usize, most: usize) -> usize {
        self.0.int_in_range(least..=most).unwrap_or(least)
    }

    /// One of several things.
    pub(crate) fn one_of<T: Copy>(&mut self, first: T, others: &[T]) -> T {
        match self.whole(0, others.len()) {
            0 => first,
            k => others[k - 1],
        }
    }

    /// True once in so many times.
    pub(crate) fn once_in(&mut self, times: usize) -> bool {
        self.whole(1, times.max(1)) == times.max(1)
    }

    /// A number from 0 to 1, in steps of 2⁻¹⁶.
    pub(crate) fn unit(&mut self) -> f64 {
        f64::from(self.0.arbitrary::<u16>().unwrap_or(0)) / 65536.0
    }

    /// A number from `least` to `most`.
    pub(crate) fn between(&mut self, least: f64, most: f64) -> f64 {
        least + (most - least) * self.unit()
    }

    /// A number from `least` to `most`, or once in eight times from there to `limit`. It takes the bytes of
    /// [`Draw::between`].
    pub(crate) fn mostly(&mut self, least: f64, most: f64, limit: f64) -> f64 {
        let unit = self.unit();
        match (65536.0 * unit) as u32 % 8 {
            7 => most + (limit - most) * unit,
            _ => least + (most - least) * unit,
        }
    }

    /// A positive number whose decimal logarithm is between these.
    pub(crate) fn decades(&mut self, least: f64, most: f64) -> f64 {
        10_f64.powf(self.between(least, most))
    }

    /// Any number at all, NaN and infinities among them.
    pub(crate) fn any(&mut self) -> f64 {
        f64::from_bits(self.0.arbitrary().unwrap_or(0))
    }

    /// So many bytes, or all that are left.
    pub(crate) fn bytes(&mut self, count: usize) -> &'a [u8] {
        self.0.bytes(count.min(self.0.len())).unwrap_or_default()
    }

    /// All bytes that are left.
    pub(crate) fn rest(self) -> &'a [u8] {
        self.0.take_rest()
    }
}

impl Draw<'_> {
    /// Numbers from 0 to 1 without end, of a seed that is drawn: a few bytes make many.
    pub(crate) fn noise(&mut self) -> impl FnMut() -> f64 + use<> {
        let mut state: u64 = self.0.arbitrary().unwrap_or(0);
        // SplitMix64, whose output never changes.
        move || {
            state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
            let mut z = state;
            z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
        }
    }
}
