//! Fingerprints of states: 128 bits by which a search recognises a state that it has visited.

use std::hash::{Hash, Hasher};

use crate::state::State;

/// Returns two hashes of 64 bits, mixed differently.
pub(crate) fn fingerprint(state: &State) -> u128 {
    let mut lanes = Lanes::default();
    state.hash(&mut lanes);
    lanes.both()
}

/// A hasher with two hashes of 64 bits.
pub(crate) struct Lanes(u64, u64);

impl Default for Lanes {
    fn default() -> Self {
        Lanes(0x9e37_79b9_7f4a_7c15, 0xc2b2_ae3d_27d4_eb4f)
    }
}

impl Lanes {
    /// Returns both hashes.
    pub(crate) fn both(&self) -> u128 {
        u128::from(self.0) << 64 | u128::from(self.1)
    }

    fn mix(&mut self, value: u64) {
        self.0 = (self.0 ^ value).wrapping_mul(0xff51_afd7_ed55_8ccd);
        self.0 ^= self.0 >> 32;
        self.1 = (self.1.rotate_left(23) ^ value).wrapping_mul(0xc4ce_b9fe_1a85_ec53);
        self.1 ^= self.1 >> 29;
    }
}

impl Hasher for Lanes {
    fn finish(&self) -> u64 {
        self.0
    }

    fn write(&mut self, bytes: &[u8]) {
        for chunk in bytes.chunks(8) {
            let mut word = [0; 8];
            word[..chunk.len()].copy_from_slice(chunk);
            self.mix(u64::from_le_bytes(word));
        }
    }

    fn write_usize(&mut self, value: usize) {
        self.mix(value as u64 ^ 0x5bd1_e995);
    }

    fn write_u128(&mut self, value: u128) {
        self.mix(value as u64);
        self.mix((value >> 64) as u64);
    }

    fn write_u64(&mut self, value: u64) {
        self.mix(value);
    }

    fn write_u32(&mut self, value: u32) {
        self.mix(value.into());
    }

    fn write_u8(&mut self, value: u8) {
        self.mix(value.into());
    }
}

/// The hasher of maps whose keys are fingerprints: a fingerprint is its own hash.
#[derive(Default)]
pub(crate) struct Identity(u64);

impl Hasher for Identity {
    fn finish(&self) -> u64 {
        self.0
    }

    fn write(&mut self, bytes: &[u8]) {
        for chunk in bytes.chunks(8) {
            let mut word = [0; 8];
            word[..chunk.len()].copy_from_slice(chunk);
            self.0 ^= u64::from_le_bytes(word);
        }
    }

    fn write_u128(&mut self, value: u128) {
        self.0 = value as u64;
    }
}
