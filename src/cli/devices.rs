//! `fragbuf devices`: what can render here. The first is what `--device auto` takes: a GPU, or the CPU device; software
//! drivers come last.

use serde_json::{Value, json};

use super::device::CPU;
use super::output::{self, Failure};

#[derive(clap::Args)]
pub(crate) struct Devices {
    /// As JSON
    #[arg(long)]
    json: bool,
}

impl Devices {
    pub(crate) fn run(&self) -> Result<(), Failure> {
        let rows = rows();
        if self.json {
            let row = |[name, kind, backend, driver]: &[String; 4]| json!({ "name": name, "type": kind, "backend": backend, "driver": driver });
            return output::print(&output::json(&rows.iter().map(row).collect::<Value>()));
        }
        output::print(&rows.iter().map(|row| format!("{}\n", row.join("  "))).collect::<String>())
    }
}

/// Name, kind, back end and driver of each.
fn rows() -> Vec<[String; 4]> {
    let own = [CPU, "Cpu", "interpreter", fragbuf::GENERATOR].map(str::to_owned);
    let adapters = adapters();
    let first = adapters.iter().position(|[_, kind, _, _]| *kind == own[1]).unwrap_or(adapters.len());
    let (gpus, software) = adapters.split_at(first);
    [gpus, &[own], software].concat()
}

#[cfg(feature = "gpu")]
fn adapters() -> Vec<[String; 4]> {
    let row = |info: &fragbuf_runtime::wgpu::AdapterInfo| {
        let driver = format!("{} {}", info.driver, info.driver_info);
        let kind = format!("{:?}", info.device_type);
        [info.name.clone(), kind, info.backend.to_string(), driver.trim().to_owned()]
    };
    fragbuf_runtime::headless::adapters().iter().map(row).collect()
}

#[cfg(not(feature = "gpu"))]
fn adapters() -> Vec<[String; 4]> {
    Vec::new()
}
