//! The result of a rendering: the image and the statistics of its frame.

use fragbuf::Plan;
use fragbuf::vocabulary::Capability;
use fragbuf_frame::{Counters, LaggedValues, LoopReport, PassTime};

/// The option of an axis that sets how many layers a resolve pass holds. Layers beyond it are counted as `layers_exceeded`.
const LAYERS: &str = "layers";

/// An image, its statistics, and the device and plan that produced it.
pub(crate) struct RenderResult {
    pub(crate) stats: FrameStats,
    /// The image of the opaque scene, if there is one.
    pub(super) opaque: Option<Vec<[f32; 4]>>,
    pub(crate) device: String,
    pub(crate) backend: String,
    /// The target whose shaders the device ran.
    pub(crate) target: &'static str,
    pub(crate) plan: Plan,
    /// Frames drawn until every fragment fitted.
    pub(crate) frames: u32,
}

/// The pixels and statistics of one frame.
pub(crate) struct FrameStats {
    /// Premultiplied linear colours.
    pub(crate) pixels: Vec<[f32; 4]>,
    pub(crate) counters: Option<Counters>,
    pub(crate) times: Option<Vec<PassTime>>,
    /// Bytes allocated at one time.
    pub(crate) bytes: u64,
    pub(crate) slices: u32,
    /// Loops that end when a condition is met.
    pub(crate) loops: Vec<LoopReport>,
    /// The fragments that a pixel of the last slice keeps at most; `None`: all.
    pub(crate) k: Option<u32>,
    /// Whether an earlier frame decided k.
    pub(crate) is_lagged: bool,
    /// The decisions for the next frame.
    pub(crate) lagged: Option<LaggedValues>,
    /// The words that the request reads.
    pub(crate) words: Vec<Vec<u32>>,
}

impl RenderResult {
    /// Returns the option that makes the resolve pass hold more layers, with twice the present value. `None` if all layers
    /// fitted or the option is at its maximum.
    pub(super) fn more_layers(&self) -> Option<(String, u32)> {
        self.stats.counters.as_ref().filter(|counters| counters.get("layers_exceeded") > 0)?;
        self.plan.selection.rows.iter().find_map(|selected| {
            let parameter = selected.row.parameters.iter().find(|parameter| parameter.name == LAYERS)?;
            let (_, now) = self.plan.constants.iter().find(|(name, _)| *name == parameter.constant)?;
            let more = (2 * now).min(parameter.range.1);
            (more > *now).then(|| (format!("{}.{LAYERS}", selected.row.axis), more))
        })
    }

    /// Returns whether every event was counted, and not losses alone.
    pub(crate) fn counts_everything(&self) -> bool {
        self.plan.selection.provides().contains(&Capability::CountsEvents)
    }
}

/// Returns how many layers a resolve pass holds, if the description or `--set` chooses it.
pub(super) fn fixed_layers(variant: &fragbuf::Variant) -> Option<u32> {
    let selected = variant.choices.iter().flat_map(|chosen| &chosen.alternatives);
    let mut options = selected.flat_map(|selected| &selected.options);
    options.find(|(name, _)| name == LAYERS).map(|(_, layers)| *layers)
}
