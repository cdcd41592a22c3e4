//! Parses `--device` and `--order`, and selects the device.
//!
//! Input: the arguments. Output: the CPU device, which is always available, or an adapter of wgpu's.

use std::convert::Infallible;
use std::str::FromStr;

use fragbuf_cpu::FragmentOrder;

use super::output::Failure;

/// The name of the CPU device.
pub(crate) const CPU: &str = "cpu";

/// The value of `--device`.
#[derive(Clone, Debug)]
pub(crate) enum DeviceRequest {
    /// A GPU if there is one, else the CPU device.
    Auto,
    /// The CPU device.
    Cpu,
    /// The first adapter whose name contains this text.
    Named(String),
}

/// The device that renders.
pub(crate) enum SelectedDevice {
    Cpu(FragmentOrder),
    #[cfg(feature = "gpu")]
    Gpu(fragbuf_runtime::headless::Choice),
}

impl FromStr for DeviceRequest {
    type Err = Infallible;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        Ok(match text {
            "auto" => DeviceRequest::Auto,
            CPU => DeviceRequest::Cpu,
            name => DeviceRequest::Named(name.to_owned()),
        })
    }
}

impl DeviceRequest {
    /// Selects a device. Only the CPU device supports an `order`.
    pub(crate) fn select(&self, order: Option<FragmentOrder>) -> Result<SelectedDevice, Failure> {
        let selected = match self {
            DeviceRequest::Cpu => SelectedDevice::Cpu(order.unwrap_or_default()),
            DeviceRequest::Auto => gpu().unwrap_or(SelectedDevice::Cpu(order.unwrap_or_default())),
            DeviceRequest::Named(name) => named(name)?,
        };
        match selected {
            SelectedDevice::Cpu(_) => Ok(selected),
            #[cfg(feature = "gpu")]
            SelectedDevice::Gpu(_) if order.is_some() => {
                Err(Failure::Usage("`--order` works only with `--device cpu`".to_owned()))
            }
            #[cfg(feature = "gpu")]
            SelectedDevice::Gpu(_) => Ok(selected),
        }
    }
}

/// Returns the best adapter, unless it is a software driver.
#[cfg(feature = "gpu")]
fn gpu() -> Option<SelectedDevice> {
    use fragbuf_runtime::headless::{Choice, adapters};
    let best = adapters().into_iter().next()?;
    (best.device_type != fragbuf_runtime::wgpu::DeviceType::Cpu).then_some(SelectedDevice::Gpu(Choice::Auto))
}

#[cfg(not(feature = "gpu"))]
fn gpu() -> Option<SelectedDevice> {
    None
}

#[cfg(feature = "gpu")]
fn named(name: &str) -> Result<SelectedDevice, Failure> {
    Ok(SelectedDevice::Gpu(fragbuf_runtime::headless::Choice::Named(name.to_owned())))
}

#[cfg(not(feature = "gpu"))]
fn named(name: &str) -> Result<SelectedDevice, Failure> {
    Err(Failure::Device(format!("no adapter is named `{name}`: this build has only the device `{CPU}`")))
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
