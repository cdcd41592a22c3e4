//! `fragbuf devices`: what can render here, best first. The first is what `--device auto` takes.

use fragbuf_runtime::headless::adapters;
use serde_json::{Value, json};

use super::output::{self, Failure};

#[derive(clap::Args)]
pub(crate) struct Devices {
    /// As JSON
    #[arg(long)]
    json: bool,
}

impl Devices {
    pub(crate) fn run(&self) -> Result<(), Failure> {
        let found = adapters();
        if found.is_empty() && !self.json {
            let hint = "install a Vulkan driver; mesa-vulkan-drivers has one for the CPU";
            return Err(Failure::Device(format!("no adapter can render fragment buffers: {hint}")));
        }
        let rows: Vec<[String; 4]> = found
            .iter()
            .map(|info| {
                let driver = format!("{} {}", info.driver, info.driver_info);
                [
                    info.name.clone(),
                    format!("{:?}", info.device_type),
                    info.backend.to_string(),
                    driver.trim().to_owned(),
                ]
            })
            .collect();
        if self.json {
            let row = |[name, kind, backend, driver]: &[String; 4]| json!({ "name": name, "type": kind, "backend": backend, "driver": driver });
            return output::print(&output::json(&rows.iter().map(row).collect::<Value>()));
        }
        output::print(&rows.iter().map(|row| format!("{}\n", row.join("  "))).collect::<String>())
    }
}
