//! `fragbuf devices`: lists the devices that can render. The first is the one that `--device auto` selects: a GPU, or the
//! CPU device. Software drivers are last.

use serde_json::{Value, json};

use super::device::CPU;
use super::output::{self, Failure};

#[derive(clap::Args)]
pub(crate) struct Devices {
    /// Print JSON
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

/// Returns the name, type, back end and driver of each device.
fn rows() -> Vec<[String; 4]> {
    let cpu = [CPU, "Cpu", "interpreter", fragbuf::GENERATOR].map(str::to_owned);
    let adapters = adapters();
    let first = adapters.iter().position(|[_, kind, _, _]| *kind == cpu[1]).unwrap_or(adapters.len());
    let (gpus, software) = adapters.split_at(first);
    [gpus, &[cpu], software].concat()
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
