//! Seeded random numbers: SplitMix64 (Steele, Lea & Flood 2014).

/// A seeded generator of random numbers.
pub(super) struct Rng(u64);

impl Rng {
    pub(super) fn seeded(seed: u32) -> Self {
        Rng(u64::from(seed))
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.0;
        bits = (bits ^ bits >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ bits >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        bits ^ bits >> 31
    }

    /// Returns a number from 0 to 1, excluding 1.
    pub(super) fn unit(&mut self) -> f32 {
        (self.next() >> 40) as f32 / (1 << 24) as f32
    }

    /// Returns a number from `from` to `to`.
    pub(super) fn between(&mut self, from: f32, to: f32) -> f32 {
        from + (to - from) * self.unit()
    }

    /// Returns a point in the unit ball.
    pub(super) fn in_ball(&mut self) -> glam::Vec3 {
        loop {
            let point = glam::Vec3::new(self.between(-1.0, 1.0), self.between(-1.0, 1.0), self.between(-1.0, 1.0));
            if point.length_squared() <= 1.0 {
                return point;
            }
        }
    }
}
