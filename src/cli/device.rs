//! `--device`: which device is meant, and whether there is one.
//!
//! In: the words of the command line. Out: the CPU device, which is always there, or an adapter of wgpu's.

use std::convert::Infallible;
use std::str::FromStr;

use fragbuf_cpu::Order;

use super::output::Failure;

/// The name of the device that needs no driver.
pub(crate) const CPU: &str = "cpu";

/// What the command line asks for.
#[derive(Clone, Debug)]
pub(crate) enum Wanted {
    /// A GPU where there is one, else the CPU device.
    Auto,
    /// The CPU device.
    Cpu,
    /// The first adapter whose name has this in it.
    Named(String),
}

/// What will draw.
pub(crate) enum Picked {
    Cpu(Order),
    #[cfg(feature = "gpu")]
    Gpu(fragbuf_runtime::headless::Choice),
}

impl FromStr for Wanted {
    type Err = Infallible;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        Ok(match text {
            "auto" => Wanted::Auto,
            CPU => Wanted::Cpu,
            name => Wanted::Named(name.to_owned()),
        })
    }
}

impl Wanted {
    /// The device, which takes fragments in this order, if one was asked for.
    pub(crate) fn pick(&self, order: Option<Order>) -> Result<Picked, Failure> {
        let picked = match self {
            Wanted::Cpu => Picked::Cpu(order.unwrap_or_default()),
            Wanted::Auto => gpu().unwrap_or(Picked::Cpu(order.unwrap_or_default())),
            Wanted::Named(name) => named(name)?,
        };
        match picked {
            Picked::Cpu(_) => Ok(picked),
            #[cfg(feature = "gpu")]
            Picked::Gpu(_) if order.is_some() => {
                let hint = "take `--device cpu`";
                Err(Failure::Usage(format!(
                    "`--order` is the CPU device's: no other takes fragments as it is told; {hint}"
                )))
            }
            #[cfg(feature = "gpu")]
            Picked::Gpu(_) => Ok(picked),
        }
    }
}

/// The best adapter that is no software.
#[cfg(feature = "gpu")]
fn gpu() -> Option<Picked> {
    use fragbuf_runtime::headless::{Choice, adapters};
    let best = adapters().into_iter().next()?;
    (best.device_type != fragbuf_runtime::wgpu::DeviceType::Cpu).then_some(Picked::Gpu(Choice::Auto))
}

#[cfg(not(feature = "gpu"))]
fn gpu() -> Option<Picked> {
    None
}

#[cfg(feature = "gpu")]
fn named(name: &str) -> Result<Picked, Failure> {
    Ok(Picked::Gpu(fragbuf_runtime::headless::Choice::Named(name.to_owned())))
}

#[cfg(not(feature = "gpu"))]
fn named(name: &str) -> Result<Picked, Failure> {
    Err(Failure::Device(format!("no adapter is named `{name}`: this build has the device `{CPU}` alone")))
}

/// `submission`, or `shuffle:SEED`.
pub(crate) fn order(text: &str) -> Result<Order, String> {
    let seed = text.strip_prefix("shuffle:").and_then(|seed| seed.parse().ok());
    match (text, seed) {
        ("submission", _) => Ok(Order::Submission),
        (_, Some(seed)) => Ok(Order::Shuffled(seed)),
        _ => Err("write submission, or shuffle:SEED with a whole number".to_owned()),
    }
}
