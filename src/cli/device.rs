//! Parses `--device` and `--order`.

use std::str::FromStr;

use fragbuf_cpu::FragmentOrder;

/// The name of the CPU device.
pub(crate) const CPU: &str = "cpu";

/// The value of `--device`. Letters may be of either case.
#[derive(Clone, Debug)]
pub(crate) enum DeviceRequest {
    /// A GPU if there is one, else the CPU device or a software driver.
    Auto,
    /// The CPU device.
    Cpu,
    /// The first adapter whose name contains this text.
    Named(String),
}

impl FromStr for DeviceRequest {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        match text.to_ascii_lowercase().as_str() {
            "" => Err("give `auto`, `cpu` or a part of an adapter's name, which `fragbuf devices` lists".to_owned()),
            "auto" => Ok(DeviceRequest::Auto),
            CPU => Ok(DeviceRequest::Cpu),
            _ => Ok(DeviceRequest::Named(text.to_owned())),
        }
    }
}

/// Parses `submission` or `shuffle:SEED`.
pub(crate) fn order(text: &str) -> Result<FragmentOrder, String> {
    let seed = text.strip_prefix("shuffle:").and_then(|seed| seed.parse().ok());
    match (text, seed) {
        ("submission", _) => Ok(FragmentOrder::Submission),
        (_, Some(seed)) => Ok(FragmentOrder::Shuffled(seed)),
        _ => Err("write submission, or shuffle:SEED with a whole number".to_owned()),
    }
}
