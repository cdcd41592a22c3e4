//! The rows of experiments: plain data. The runners of [`super::sweep`] and its siblings read them.
//!
//! `{x}` in a text stands for the value of the sweep, `{x+1}` for the next number.

use fragbuf_cpu::FragmentOrder;
use fragbuf_templates::PaperTable;

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
    /// Images of variants, and where they differ from the first.
    Images(Images),
    /// Properties of techniques, computed from their plans, beside those that a paper states.
    Properties(Properties),
    /// What pixels hold after each object of a scene.
    Steps(Steps),
    /// Predicted k for views of a scene.
    Predictions(Predictions),
    /// Fragments of equal depths in scenes, and what a technique keeps of them.
    Coplanarity(CoplanarScenes),
    /// The disorder of sorted triangles after subdivisions.
    Disorder(Disorder),
    /// Times of frames beside those of other projects, on OpenGL.
    Peers(Peers),
}

/// The disorder of a scene whose triangles are divided, and sorted by their centroids.
#[derive(Clone, Copy)]
pub(super) struct Disorder {
    /// The scene, and a smaller one for `--quick`.
    pub(super) scene: [&'static str; 2],
    pub(super) camera: &'static str,
    /// The pixels along a side of the image.
    pub(super) side: u32,
    /// Triangles over those of the model in per cent, ascending, and the disorder that the paper has for it.
    pub(super) budgets: &'static [(u32, Option<u32>)],
}

/// Scenes with fragments of equal depths.
#[derive(Clone, Copy)]
pub(super) struct CoplanarScenes {
    pub(super) scenes: &'static [CoplanarScene],
    pub(super) camera: &'static str,
    /// The pixels along a side of the images.
    pub(super) side: u32,
    /// The technique whose hit ratio is measured. It blends the fragments that it keeps with `over`.
    pub(super) technique: &'static str,
    pub(super) claims: &'static [CoplanarClaim],
}

/// One scene with fragments of equal depths.
#[derive(Clone, Copy)]
pub(super) struct CoplanarScene {
    pub(super) label: &'static str,
    /// The scene, and a smaller one for `--quick`.
    pub(super) scene: [&'static str; 2],
}

/// A statement of a paper about fragments of equal depths.
#[derive(Clone, Copy)]
pub(super) struct CoplanarClaim {
    /// What the paper states, as a clause.
    pub(super) statement: &'static str,
    pub(super) check: CoplanarCheck,
}

/// How a statement about fragments of equal depths is checked.
#[derive(Clone, Copy)]
pub(super) enum CoplanarCheck {
    /// The technique keeps as many fragments as there are depths, in every scene.
    KeepsOnePerDepth,
    /// Over these scenes, the hit ratio falls as C_p rises.
    FallsWithCoplanarity(&'static [&'static str]),
    /// In this scene every pixel has C_p 1 and this total coplanarity.
    EveryPixelHas(&'static str, u32),
}

/// Predicted k for views of a scene, by goals.
#[derive(Clone, Copy)]
pub(super) struct Predictions {
    /// The scene, and a smaller one for `--quick`.
    pub(super) scene: [&'static str; 2],
    pub(super) technique: &'static str,
    /// Labels and cameras.
    pub(super) views: &'static [(&'static str, &'static str)],
    /// The pixels along a side of the images.
    pub(super) side: u32,
    pub(super) goals: &'static [Goal],
    pub(super) claims: &'static [PredictionClaim],
}

/// A budget and a hit ratio.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Goal {
    pub(super) bytes_per_pixel: u64,
    /// The fragments to keep, in per cent.
    pub(super) percent: u32,
}

/// A statement of a paper about predictions.
#[derive(Clone, Copy)]
pub(super) struct PredictionClaim {
    /// What the paper states, as a clause.
    pub(super) statement: &'static str,
    pub(super) check: PredictionCheck,
}

/// How a statement about predictions is checked.
#[derive(Clone, Copy)]
pub(super) enum PredictionCheck {
    /// In each view k does not shrink with more memory and a greater hit ratio.
    GrowsWithGoals,
    /// k is not the same in all views.
    Adapts,
    /// Every goal is met within its budget.
    KeepsWithinBudget,
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

impl Series {
    pub(super) const fn new(
        label: &'static str,
        technique: &'static str,
        set: &'static [(&'static str, &'static str)],
    ) -> Self {
        Series { label, technique, set }
    }
}

/// A chart of one panel.
#[derive(Clone, Copy)]
pub(super) struct Chart {
    pub(super) panel: &'static str,
    pub(super) title: &'static str,
    pub(super) measure: Measure,
}

/// What a chart shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Measure {
    /// The milliseconds of some passes.
    Time(Passes),
    /// The milliseconds of a frame over the MiB of its buffers.
    TimePerMebibyte,
    /// The MiB of the buffers of a frame.
    Mebibytes,
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

/// Scenes on which other projects' shaders run beside ours.
#[derive(Clone, Copy)]
pub(super) struct Peers {
    pub(super) scenes: &'static [PeerScene],
    /// The pixels along a side.
    pub(super) side: u32,
}

/// A scene of at most 64 fragments per pixel, the capacity in the descriptions of peers.
#[derive(Clone, Copy)]
pub(super) struct PeerScene {
    /// The name in the CSV file.
    pub(super) name: &'static str,
    /// The scene, and a smaller one for `--quick`.
    pub(super) scene: [&'static str; 2],
    pub(super) camera: &'static str,
}

/// Images of one scene.
#[derive(Clone, Copy)]
pub(super) struct Images {
    /// The scene, and a smaller one for `--quick`.
    pub(super) scene: [&'static str; 2],
    pub(super) camera: &'static str,
    /// The pixels along a side.
    pub(super) side: u32,
    /// The order of fragments on the CPU device, which `--device auto` selects.
    pub(super) order: FragmentOrder,
    /// The first is the reference.
    pub(super) variants: &'static [Variant],
    /// What the sheet shows of the others.
    pub(super) shown: Shown,
    pub(super) claims: &'static [ImageClaim],
}

/// What a sheet of images shows beside the reference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Shown {
    /// Where an image differs, as a heat map.
    Differences,
    /// The image itself.
    Images,
}

/// A description, and the order of the triangles that it renders.
#[derive(Clone, Copy)]
pub(super) struct Variant {
    pub(super) series: Series,
    pub(super) triangles: Triangles,
}

/// The order of triangles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Triangles {
    /// That of the model.
    AsModelled,
    /// From front to back by the depth of their centroids.
    ByCentroid,
}

/// A statement of a paper about the image of a variant.
#[derive(Clone, Copy)]
pub(super) struct ImageClaim {
    pub(super) statement: &'static str,
    /// The label of the variant.
    pub(super) variant: &'static str,
    pub(super) expected: Expected,
}

/// How an image differs from the reference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Expected {
    /// In no pixel.
    Equal,
    /// In some pixels.
    Different,
    /// In fewer pixels than the image of another variant.
    FewerThan(&'static str),
    /// The image equals that of another variant.
    Same(&'static str),
}

/// Properties of techniques.
#[derive(Clone, Copy)]
pub(super) struct Properties {
    pub(super) table: &'static PaperTable,
    /// Whether techniques that the table does not have follow.
    pub(super) has_others: bool,
    /// The widths of the columns in the SVG, after that of the technique.
    pub(super) widths: &'static [u32],
    /// The columns that are compared, each with what it states.
    pub(super) compared: &'static [(&'static str, &'static str)],
    /// The scenes on which draws and hit ratios are measured, if they are.
    pub(super) measured: Option<MeasuredScenes>,
}

/// Scenes of `builtin:layers` in which every pixel has the same number of depths, and each depth the same number of fragments.
#[derive(Clone, Copy)]
pub(super) struct MeasuredScenes {
    /// The depths of a pixel.
    pub(super) depths: u32,
    /// The fragments of each depth, a scene per number.
    pub(super) coplanar: &'static [u32],
    pub(super) camera: &'static str,
    /// The pixels along a side.
    pub(super) side: u32,
}

/// The states of a row of pixels while a scene is drawn.
#[derive(Clone, Copy)]
pub(super) struct Steps {
    /// The scene, whose objects are drawn one after the other.
    pub(super) scene: &'static str,
    pub(super) camera: &'static str,
    pub(super) series: Series,
    pub(super) k: u32,
    /// The pixels along a side, and the row.
    pub(super) side: u32,
    pub(super) row: u32,
}

/// Replaces `{x}` by the value of a sweep, and `{x+1}` by the next number.
pub(super) fn at(text: &str, x: u32) -> String {
    text.replace("{x}", &x.to_string()).replace("{x+1}", &x.saturating_add(1).to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_value_of_a_sweep_replaces_its_name() {
        assert_eq!(at("n={x},k={x+1},x", 4), "n=4,k=5,x");
    }
}
