//! What all kinds of experiments share: the options of the command, the device, the header of the files and the progress.

use std::path::PathBuf;

use super::Figure;
use super::experiment::{Experiment, Series, at};
use crate::cli::camera::CameraRequest;
use crate::cli::device::DeviceRequest;
use crate::cli::memory::Budget;
use crate::cli::output::Failure;
use crate::cli::progress::Progress;
use crate::cli::rendering::{DeviceSelection, select_for_figure};
use crate::cli::view::View;
use fragbuf_cpu::FragmentOrder;

/// The pixels along a side in a quick run.
pub(super) const QUICK_SIDE: u32 = 24;

/// A run of an experiment.
pub(super) struct Run<'a> {
    pub(super) options: &'a Figure,
    pub(super) experiment: &'a Experiment,
    pub(super) selection: DeviceSelection,
    /// The comment lines of the CSV file: what the numbers depend on.
    pub(super) header: Vec<String>,
    /// The progress of the whole experiment.
    progress: Progress,
    /// The progress of a single frame, which is not shown.
    pub(super) silent: Progress,
    /// The finished share of the experiment, and that of the current part.
    pub(super) share: (f64, f64),
    order: Option<FragmentOrder>,
}

impl<'a> Run<'a> {
    /// Selects the device. `details` are further lines of the header.
    pub(super) fn new(
        options: &'a Figure,
        experiment: &'a Experiment,
        order: Option<FragmentOrder>,
        details: &[String],
    ) -> Result<Self, Failure> {
        let selection = select_for_figure(&options.device, order)?;
        let build = if cfg!(debug_assertions) { "debug" } else { "release" };
        let header = [
            format!("fragbuf {}, figure {}", env!("CARGO_PKG_VERSION"), experiment.name),
            format!("{}: {}", experiment.paper, experiment.title),
            format!("device: {}; {build} build", selection.description()),
        ];
        let header = header.into_iter().chain(details.iter().cloned()).collect();
        let (progress, silent) = (Progress::new(), Progress::hidden());
        progress.set_message(experiment.name);
        Ok(Run { options, experiment, selection, header, progress, silent, share: (0.0, 1.0), order })
    }

    /// Returns the path of a file of the experiment.
    pub(super) fn file(&self, extension: &str) -> PathBuf {
        self.options.out.join(format!("{}.{extension}", self.experiment.name))
    }

    /// Shows the progress within the current part.
    pub(super) fn show(&self, share: f64, what: &str) {
        let (done, part) = self.share;
        self.progress.set_fraction(|| format!("{}: {what}", self.experiment.name), done + share * part);
    }

    /// Returns the view of a scene at a size, with a memory budget.
    pub(super) fn view(&self, scene: String, camera: &str, size: (u32, u32), memory: Budget) -> Result<View, Failure> {
        let camera: CameraRequest = camera.parse().map_err(Failure::Usage)?;
        let device: (DeviceRequest, _) = (self.options.device.clone(), self.order);
        Ok(View::measured(scene, camera, size, device, memory))
    }
}

/// Returns the technique with the changes at a value.
pub(super) fn description(series: &Series, x: u32) -> String {
    let changes = series.set.iter().map(|(name, value)| format!(" {name}={}", at(value, x)));
    std::iter::once(series.technique.to_owned()).chain(changes).collect()
}

/// Returns the changes of a description at a value.
pub(super) fn changes(series: &Series, x: u32) -> Vec<(String, String)> {
    series.set.iter().map(|(name, value)| ((*name).to_owned(), at(value, x))).collect()
}

/// Returns the reason why a device cannot run a point. `Err`: the failure is of another kind.
pub(super) fn unavailable(failure: Failure) -> Result<String, Failure> {
    match failure {
        Failure::Device(text) | Failure::Input(text) => Ok(text),
        Failure::Description(diagnostics, _) => {
            Ok(diagnostics.iter().map(|diagnostic| diagnostic.message.clone()).collect::<Vec<_>>().join("; "))
        }
        other => Err(other),
    }
}
