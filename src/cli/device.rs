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

/// Returns an order as [`order`] parses it.
#[cfg(feature = "figures")]
pub(crate) fn order_text(order: FragmentOrder) -> String {
    match order {
        FragmentOrder::Submission => "submission".to_owned(),
        FragmentOrder::Shuffled(seed) => format!("shuffle:{seed}"),
        FragmentOrder::Window { seed, triangles } => format!("window:{seed},{triangles}"),
    }
}

/// Parses `submission`, `shuffle:SEED` or `window:SEED,TRIANGLES`.
pub(crate) fn order(text: &str) -> Result<FragmentOrder, String> {
    let seed = text.strip_prefix("shuffle:").and_then(|seed| seed.parse().ok());
    let window = text.strip_prefix("window:").and_then(|numbers| numbers.split_once(','));
    let window = window.and_then(|(seed, triangles)| Some((seed.parse().ok()?, triangles.parse().ok()?)));
    match (text, seed, window) {
        ("submission", ..) => Ok(FragmentOrder::Submission),
        (_, Some(seed), _) => Ok(FragmentOrder::Shuffled(seed)),
        (_, _, Some((seed, triangles @ 1..))) => Ok(FragmentOrder::Window { seed, triangles }),
        _ => Err("write submission, shuffle:SEED, or window:SEED,TRIANGLES with whole numbers, at least one triangle"
            .to_owned()),
    }
}
