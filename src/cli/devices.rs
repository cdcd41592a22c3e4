//! `fragbuf devices`: lists the devices that can render, and what `--device auto` selects: a GPU; without one, the CPU device or a software
//! driver, as the frame requires.

use serde_json::{Value, json};

use super::device::CPU;
use super::output::{self, Failure};

#[derive(clap::Args)]
pub(crate) struct Devices {
    /// Print JSON
    #[arg(long)]
    json: bool,
}

/// A device of the list.
#[derive(Clone)]
struct Row {
    name: String,
    /// wgpu's type of the device.
    kind: String,
    backend: String,
    driver: String,
    is_software: bool,
}

impl Devices {
    pub(crate) fn run(&self) -> Result<(), Failure> {
        let rows = rows();
        let rows = rows.iter().zip(automatic(&rows));
        if self.json {
            let row = |(row, auto): (&Row, &str)| json!({ "name": row.name, "type": row.kind, "backend": row.backend, "driver": row.driver, "auto": auto });
            return output::print(&output::json(&rows.map(row).collect::<Value>()));
        }
        let line = |(row, auto): (&Row, &str)| {
            let auto = if auto == NEVER { String::new() } else { format!("  auto: {auto}") };
            format!("{}  {}  {}  {}{auto}\n", row.name, row.kind, row.backend, row.driver)
        };
        output::print(&rows.map(line).collect::<String>())
    }
}

const NEVER: &str = "never";

/// Returns for each device when `--device auto` selects it. Another device follows if the first cannot run a description.
fn automatic(rows: &[Row]) -> Vec<&'static str> {
    let has_gpu = rows.first().is_some_and(|row| !row.is_software);
    let drivers = rows.len() > 1;
    let of = |(index, row): (usize, &Row)| match (has_gpu, index) {
        (true, 0) => "always",
        (true, _) => NEVER,
        (false, 0) if !drivers => "always",
        (false, 0) => "frames of few fragments",
        (false, 1) if row.is_software => "frames of many fragments",
        _ => NEVER,
    };
    rows.iter().enumerate().map(of).collect()
}

/// Returns the devices: GPUs, the CPU device, software drivers.
fn rows() -> Vec<Row> {
    let cpu = Row {
        name: CPU.to_owned(),
        kind: "Cpu".to_owned(),
        backend: "interpreter".to_owned(),
        driver: fragbuf::GENERATOR.to_owned(),
        is_software: true,
    };
    let (software, gpus): (Vec<Row>, Vec<Row>) = adapters().into_iter().partition(|row| row.is_software);
    [gpus, vec![cpu], software].concat()
}

#[cfg(feature = "gpu")]
fn adapters() -> Vec<Row> {
    let row = |adapter: &fragbuf_runtime::wgpu::Adapter| {
        let info = adapter.get_info();
        Row {
            driver: format!("{} {}", info.driver, info.driver_info).trim().to_owned(),
            kind: format!("{:?}", info.device_type),
            backend: info.backend.to_string(),
            is_software: info.device_type == fragbuf_runtime::wgpu::DeviceType::Cpu,
            name: info.name,
        }
    };
    fragbuf_runtime::headless::adapters().iter().map(row).collect()
}

#[cfg(not(feature = "gpu"))]
fn adapters() -> Vec<Row> {
    Vec::new()
}
