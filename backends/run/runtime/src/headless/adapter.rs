//! Lists the adapters and chooses one.

use std::fmt;
use std::future::Future;
use std::pin::pin;
use std::str::FromStr;
use std::task::{Context, Poll, Waker};

use super::instance;
use crate::Error;

/// The choice of an adapter.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Choice {
    /// The fastest adapter that can run fragment buffers.
    Auto,
    /// The adapter that runs on the CPU.
    Cpu,
    /// The first adapter whose name contains this text, ignoring case.
    Named(String),
}

impl FromStr for Choice {
    type Err = std::convert::Infallible;

    /// Parses `auto`, `cpu`, or a part of a name.
    fn from_str(text: &str) -> Result<Self, Self::Err> {
        Ok(match text {
            "auto" => Choice::Auto,
            "cpu" => Choice::Cpu,
            name => Choice::Named(name.to_owned()),
        })
    }
}

impl fmt::Display for Choice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Choice::Auto => f.write_str("auto"),
            Choice::Cpu => f.write_str("cpu"),
            Choice::Named(name) => write!(f, "named `{name}`"),
        }
    }
}

/// Returns every adapter of this machine that can write buffers from fragment shaders, best first. OpenGL adapters are listed only if
/// there are no others, because they are the same devices with fewer features.
pub fn adapters() -> Vec<wgpu::Adapter> {
    let allowed = descriptor().backends;
    let mut adapters = Vec::new();
    for backends in [wgpu::Backends::PRIMARY, wgpu::Backends::SECONDARY].map(|some| some & allowed) {
        if adapters.is_empty() && !backends.is_empty() {
            let instance = instance::create(wgpu::InstanceDescriptor { backends, ..descriptor() });
            adapters = ready(instance.enumerate_adapters(backends)).unwrap_or_default();
            adapters.retain(is_suitable);
        }
    }
    // The sort is stable: adapters of one kind keep the drivers' order.
    adapters.sort_by_key(|adapter| rank(adapter.get_info().device_type));
    adapters
}

/// Returns wgpu's descriptor, in debug builds without the validation layer of the driver's API: it multiplies the time of a frame, and
/// its messages go to the crate `log`, to which no program here listens. The environment variable `WGPU_VALIDATION=1` enables it. wgpu
/// itself validates every call in any case.
fn descriptor() -> wgpu::InstanceDescriptor {
    let flags = wgpu::InstanceFlags::default() - wgpu::InstanceFlags::VALIDATION;
    let descriptor = wgpu::InstanceDescriptor::new_without_display_handle_from_env();
    wgpu::InstanceDescriptor { flags: flags.with_env(), ..descriptor }
}

/// Returns the chosen adapter, for [`open_device`](super::open_device) or a device of the caller.
pub fn adapter(choice: &Choice) -> Result<wgpu::Adapter, Error> {
    let adapters = adapters();
    let available = adapters.iter().map(|adapter| adapter.get_info().name).collect();
    let chosen = adapters.into_iter().find(|adapter| {
        let info = adapter.get_info();
        match choice {
            Choice::Auto => true,
            Choice::Cpu => info.device_type == wgpu::DeviceType::Cpu,
            Choice::Named(part) => info.name.to_lowercase().contains(&part.to_lowercase()),
        }
    });
    chosen.ok_or_else(|| Error::NoAdapter { requested: choice.to_string(), available })
}

fn rank(kind: wgpu::DeviceType) -> u32 {
    match kind {
        wgpu::DeviceType::DiscreteGpu => 0,
        wgpu::DeviceType::IntegratedGpu => 1,
        wgpu::DeviceType::VirtualGpu => 2,
        wgpu::DeviceType::Other => 3,
        wgpu::DeviceType::Cpu => 4,
    }
}

fn is_suitable(adapter: &wgpu::Adapter) -> bool {
    let flags = adapter.get_downlevel_capabilities().flags;
    flags.contains(wgpu::DownlevelFlags::FRAGMENT_WRITABLE_STORAGE | wgpu::DownlevelFlags::COMPUTE_SHADERS)
}

/// Returns the value of a future that native back ends complete at once.
pub(super) fn ready<T>(future: impl Future<Output = T>) -> Option<T> {
    match pin!(future).poll(&mut Context::from_waker(Waker::noop())) {
        Poll::Ready(value) => Some(value),
        Poll::Pending => None,
    }
}
