//! `fragbuf figure`: repeats an experiment of a paper.
//!
//! Input: the name of an experiment, which is a row of data in [`experiments`]. Output: a CSV file, a chart or image, and one sentence that
//! compares the trend with the paper's. [`experiment`] has the types of the rows, [`run`] what all kinds share. Each kind of
//! experiment has a runner: [`sweep`], [`images`], [`properties`], [`steps`], [`predictions`], [`coplanar`],
//! [`disorder`] and [`peers`]. [`claim`] compares with the paper, [`measured`] evaluates the formulas of tables,
//! [`chart`] and [`svg`] draw.

mod chart;
mod claim;
mod coplanar;
mod csv;
mod disorder;
mod experiment;
mod experiments;
pub(crate) mod histogram;
mod images;
mod measured;
mod peers;
mod point;
mod predictions;
mod properties;
mod run;
mod spread;
mod steps;
pub(crate) mod style;
mod svg;
mod sweep;

use std::path::PathBuf;

use self::claim::{Finding, findings, sentence};
use self::experiment::{Experiment, Kind, Sweep};
use self::experiments::EXPERIMENTS;
use self::run::Run;
use super::device::DeviceRequest;
use super::memory::{self, Budget};
use super::output::{self, Failure};

#[derive(clap::Args)]
pub(crate) struct Figure {
    /// Name of an experiment, as `--list` prints it
    #[arg(required_unless_present = "list")]
    name: Option<String>,
    /// List the experiments with their papers
    #[arg(long, conflicts_with = "name")]
    list: bool,
    /// `auto`: the first adapter, or the CPU device where fragments must be interleaved. `cpu`: the CPU device. NAME: an adapter whose
    /// name contains NAME
    #[arg(long, default_value = "auto", value_name = "auto|cpu|NAME")]
    device: DeviceRequest,
    /// Folder for NAME.csv and NAME.svg. Points that the CSV file has from an earlier run with the same options are not measured again
    #[arg(long, value_name = "DIR", default_value = "figures")]
    out: PathBuf,
    /// Checkout of a project whose shaders `peers` compares with ours
    #[arg(long, value_name = "DIR")]
    peer: Option<PathBuf>,
    /// Measured frames per point [default: 7, or 2 with `--quick`]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1000))]
    repeats: Option<u32>,
    /// Pixels along a side of the images, instead of those of the experiment
    #[arg(long, value_name = "PIXELS", value_parser = clap::value_parser!(u32).range(1..=16384))]
    size: Option<u32>,
    /// Memory budget of a point, as for `render`. A frame that needs more is drawn in slices; the CSV file has their number
    #[arg(long, value_name = "SIZE", default_value = "2GiB", value_parser = memory::budget)]
    memory: Budget,
    /// Few values, small scenes and images, two repeats: a test of the command, and not a measurement
    #[arg(long)]
    quick: bool,
}

impl Figure {
    pub(crate) fn run(&self) -> Result<(), Failure> {
        let Some(name) = self.name.as_deref().filter(|_| !self.list) else { return list() };
        let found = EXPERIMENTS.iter().find(|experiment| experiment.name == name);
        let names: Vec<&str> = EXPERIMENTS.iter().map(|experiment| experiment.name).collect();
        let experiment = found.ok_or_else(|| Failure::unknown("experiment", name, &names))?;
        Failure::unless_folder(&self.out)?;
        let text = match &experiment.kind {
            Kind::Sweep(sweep) => self.sweep(experiment, sweep)?,
            Kind::Images(images) => images::run(images, self, experiment)?,
            Kind::Properties(properties) => properties::run(properties, self, experiment)?,
            Kind::Steps(steps) => steps::run(steps, self, experiment)?,
            Kind::Predictions(row) => predictions::run(row, self, experiment)?,
            Kind::Coplanarity(row) => coplanar::run(row, self, experiment)?,
            Kind::Disorder(row) => disorder::run(row, self, experiment)?,
            Kind::Peers(peers) => peers::run(peers, self, experiment)?,
        };
        output::print(&format!("{text}\n"))
    }

    /// Returns the measured frames per point.
    fn repeats(&self) -> u32 {
        self.repeats.unwrap_or(if self.quick { 2 } else { 7 })
    }

    /// Measures a sweep, draws its chart and returns its sentence.
    fn sweep(&self, experiment: &Experiment, sweep: &Sweep) -> Result<String, Failure> {
        let sizes: Vec<String> = sweep.panels.iter().map(|panel| sweep::setup(panel, self)).collect();
        let details = [
            format!(
                "each point: 1 frame that finds the capacity, {} warm-up frames, {} measured frames, without counters, all series in \
                 turns",
                sweep::WARM_UP,
                self.repeats()
            ),
            format!("memory budget: {} bytes", self.memory.whole()),
        ];
        let details = [sizes, details.to_vec()].concat();
        let mut run = Run::new(self, experiment, None, &details)?;
        let points = sweep::measure(sweep, &mut run)?;
        let device = run.selection.name();
        let svg = chart::svg(experiment, sweep, &points, &device)?;
        csv::write_text(&run.file("svg"), &svg)?;
        let findings: Vec<(&str, Finding)> = findings(sweep.claims, sweep.panels, &points);
        Ok(sentence(experiment.paper, &device, &findings))
    }
}

/// Prints the experiments.
fn list() -> Result<(), Failure> {
    let widths = [
        EXPERIMENTS.iter().map(|experiment| experiment.name.chars().count()).max().unwrap_or(0),
        EXPERIMENTS.iter().map(|experiment| experiment.paper.chars().count()).max().unwrap_or(0),
    ];
    let line = |Experiment { name, paper, title, .. }: &Experiment| {
        format!("{name:name_width$}  {paper:paper_width$}  {title}\n", name_width = widths[0], paper_width = widths[1])
    };
    output::print(&EXPERIMENTS.iter().map(line).collect::<String>())
}
