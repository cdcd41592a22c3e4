//! The time that passes take, however a device measures it.

/// The time that one pass took on the device.
#[derive(Clone, Debug, PartialEq)]
pub struct PassTime {
    /// The pass.
    pub pass: String,
    /// In milliseconds, over all slices and rounds.
    pub milliseconds: f64,
}
