//! The rows of experiments: plain data. The runners of [`super::sweep`] and its siblings read them.
//!
//! `{x}` in a text stands for the value of the sweep.

use super::claim::Claim;

/// An experiment of a paper.
#[derive(Clone, Copy)]
pub(super) struct Experiment {
    /// The name on the command line, and that of its files.
    pub(super) name: &'static str,
    /// The paper and its figure.
    pub(super) paper: &'static str,
    /// What it shows.
    pub(super) title: &'static str,
    pub(super) kind: Kind,
}

/// How an experiment is run.
#[derive(Clone, Copy)]
pub(super) enum Kind {
    /// Times of series of descriptions over a swept value.
    Sweep(Sweep),
}

/// Times of frames and passes.
#[derive(Clone, Copy)]
pub(super) struct Sweep {
    pub(super) panels: &'static [Panel],
    pub(super) charts: &'static [Chart],
    /// The paper's statements.
    pub(super) claims: &'static [Claim],
}

/// One scene, and the value that is swept over it.
#[derive(Clone, Copy)]
pub(super) struct Panel {
    /// The name in the CSV file.
    pub(super) name: &'static str,
    /// The scene, and a smaller one for `--quick`.
    pub(super) scene: [&'static str; 2],
    pub(super) camera: &'static str,
    pub(super) axis: Axis,
    pub(super) side: Side,
    /// The first series is the reference of the ratios.
    pub(super) series: &'static [Series],
}

/// The swept value.
#[derive(Clone, Copy)]
pub(super) struct Axis {
    /// Its symbol in sentences.
    pub(super) symbol: &'static str,
    pub(super) label: &'static str,
    pub(super) values: &'static [u32],
    /// The values of `--quick`.
    pub(super) quick: &'static [u32],
}

/// The pixels along a side of the images.
#[derive(Clone, Copy)]
pub(super) enum Side {
    /// The same for all points. `--size` and `--quick` replace it.
    Fixed(u32),
    /// The swept value.
    Swept,
}

/// A description with its changes.
#[derive(Clone, Copy)]
pub(super) struct Series {
    pub(super) label: &'static str,
    pub(super) technique: &'static str,
    pub(super) set: &'static [(&'static str, &'static str)],
}

/// A chart of one panel.
#[derive(Clone, Copy)]
pub(super) struct Chart {
    pub(super) panel: &'static str,
    pub(super) title: &'static str,
    pub(super) passes: Passes,
}

/// Passes whose times are added.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Passes {
    All,
    /// The passes of these names.
    Only(&'static [&'static str]),
    /// All but the passes of these names.
    Except(&'static [&'static str]),
}

impl Passes {
    /// Returns whether a pass is among them.
    pub(super) fn contain(self, pass: &str) -> bool {
        match self {
            Passes::All => true,
            Passes::Only(names) => names.contains(&pass),
            Passes::Except(names) => !names.contains(&pass),
        }
    }
}

/// Replaces `{x}` by the value of a sweep.
pub(super) fn at(text: &str, x: u32) -> String {
    text.replace("{x}", &x.to_string())
}
