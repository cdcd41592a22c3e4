//! The time that passes take, however a device measures it.

/// The time that one pass took on the device.
#[derive(Clone, Debug, PartialEq)]
pub struct PassTime {
    /// The pass.
    pub pass: String,
    /// In milliseconds, over all slices and iterations.
    pub milliseconds: f64,
    /// Runs that no time is known of, because the device had no more queries.
    pub untimed: u32,
}

impl PassTime {
    /// The time of a pass that has not run.
    pub fn none(pass: String) -> Self {
        PassTime { pass, milliseconds: 0.0, untimed: 0 }
    }
}
