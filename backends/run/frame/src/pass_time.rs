//! The time that passes take, independent of how a device measures it.

/// The time that one pass took on the device.
#[derive(Clone, Debug, PartialEq)]
pub struct PassTime {
    /// The pass.
    pub pass: String,
    /// The sum over all slices and iterations, in milliseconds.
    pub milliseconds: f64,
    /// The number of runs without a measured time, because the device has too few queries.
    pub untimed: u32,
}

impl PassTime {
    /// Returns the time of a pass that has not run.
    pub fn zero(pass: String) -> Self {
        PassTime { pass, milliseconds: 0.0, untimed: 0 }
    }
}
