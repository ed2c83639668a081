//! A hash that is the same in every run, on every platform and for every version of the compiler, which those of the standard library are not.

/// FNV-1a over 128 bits. Source: G. Fowler, L. C. Noll, K.-P. Vo, D. Eastlake, "The FNV non-cryptographic hash algorithm".
#[derive(Clone, Copy, Debug)]
pub(super) struct Fnv(u128);

impl Fnv {
    pub(super) fn new() -> Self {
        Self(0x6c62_272e_07bb_0142_62b8_2175_6295_c58d)
    }

    pub(super) fn bytes(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.0 = (self.0 ^ u128::from(byte)).wrapping_mul(0x0000_0000_0100_0000_0000_0000_0000_013b);
        }
    }

    pub(super) fn whole(&mut self, value: u64) {
        self.bytes(&value.to_le_bytes());
    }

    /// −0 counts as 0: both mean the same physics.
    pub(super) fn number(&mut self, value: f64) {
        self.whole((value + 0.0).to_bits());
    }

    pub(super) fn numbers<'a>(&mut self, values: impl IntoIterator<Item = &'a f64>) {
        values.into_iter().for_each(|&value| self.number(value));
    }

    pub(super) fn finish(self) -> u128 {
        self.0
    }
}
