//! One description, one scene, one frame: drawn again with more room until nothing is lost for want of it.
//!
//! In: a description, a staged scene. Out: premultiplied linear colours and the figures of the frame. What is lost all the
//! same (a lock that was not free in time, more layers than any resolve pass takes) is said on stderr, never hidden.

mod cpu;
#[cfg(feature = "gpu")]
mod gpu;
mod opaque;

use fragbuf::vocabulary::Fact;
use fragbuf::{Plan, Registry, Variant};
use fragbuf_frame::{Counters, LoopEnd, Looped, OUT_OF_ORDER, PARTLY_COVERED, PassTime};
use fragbuf_scene::Scene;

use self::opaque::{Opaque, put_before, turned_away};
use super::device::Picked;
use super::input::Input;
use super::output::{Failure, warn};
use super::progress::Progress;
use super::view::{Stage, View};

/// The payload that does not round what a scene's colours are. The papers' rounds each layer to 255ths.
const UNROUNDED: (&str, &str) = ("fragment.color", "rgba16");

/// A description as it was asked for.
pub(crate) struct Wish<'a> {
    pub(crate) description: &'a str,
    pub(crate) set: &'a [(String, String)],
    pub(crate) uniforms: &'a [(String, String)],
    /// Whether everything is counted unless the description says otherwise.
    pub(crate) count_all: bool,
    /// What is opaque, and drawn first.
    pub(crate) opaque: Option<&'a Stage>,
}

/// What came of it.
pub(crate) struct Painted {
    pub(crate) drawn: Figures,
    /// The picture of what is opaque, behind all of it.
    behind: Option<Vec<[f32; 4]>>,
    /// What drew it, and through what.
    pub(crate) device: String,
    pub(crate) backend: String,
    /// The language that it ran.
    pub(crate) target: &'static str,
    pub(crate) plan: Plan,
    /// Frames that were drawn until there was room for everything.
    pub(crate) frames: u32,
}

/// One description to be drawn on one device.
struct Task<'a> {
    wish: &'a Wish<'a>,
    view: &'a View,
    stage: &'a Stage,
    progress: &'a Progress,
    variant: &'a Variant,
    opaque: Option<&'a Opaque<'a>>,
}

/// Draws the scene.
pub(crate) fn paint(wish: &Wish<'_>, view: &View, stage: &Stage, progress: &Progress) -> Result<Painted, Failure> {
    let registry = Registry::builtin();
    let picked = view.picked()?;
    let mut input = Input::read(wish.description, &registry)?;
    let opaque = wish.opaque.map(|stage| Opaque::new(stage, &registry)).transpose()?;
    let rounded = stage.exact && !in_255ths(&stage.scene);
    let mut unless_said: Vec<(&str, &str)> = Vec::new();
    unless_said.extend(everything(&registry).filter(|_| wish.count_all));
    unless_said.extend(rounded.then_some(UNROUNDED));
    unless_said.extend(opaque.as_ref().and_then(|_| turned_away(&registry)));
    // A storage whose slots hold no more than the papers' payload rounds as the papers do.
    if rounded && input.variant_or(wish.set, &unless_said, &registry).is_err() {
        unless_said.retain(|set| *set != UNROUNDED);
    }
    let (mut set, mut frames) = (wish.set.to_vec(), 0);
    let (mut said, mut room) = (None, None);
    loop {
        let variant = input.variant_or(&set, &unless_said, &registry)?;
        let said = *said.get_or_insert_with(|| says_layers(&variant));
        let task = Task { wish, view, stage, progress, variant: &variant, opaque: opaque.as_ref() };
        let mut painted = match &picked {
            Picked::Cpu(order) => cpu::paint(&task, *order, (&input, &registry), (&mut frames, &mut room))?,
            #[cfg(feature = "gpu")]
            Picked::Gpu(choice) => gpu::paint(&task, choice, (&input, &registry), (&mut frames, &mut room))?,
        };
        match painted.more_layers().filter(|_| !said) {
            Some((option, layers)) => set.push((option, layers.to_string())),
            None => {
                painted.warn(wish.description);
                if let Some(behind) = painted.behind.take() {
                    put_before(&mut painted.drawn.pixels, &behind);
                }
                return Ok(painted);
            }
        }
    }
}

/// The choice that counts every event.
fn everything(registry: &Registry) -> Option<(&str, &str)> {
    registry.offering(Fact::CountsEvents).next().map(|row| (row.axis.as_str(), row.key.as_str()))
}

/// Whether 8 bits a channel hold every colour of the scene, but for the rounding of its text.
fn in_255ths(scene: &Scene) -> bool {
    let whole = |channel: &f32| (255.0 * channel - (255.0 * channel).round()).abs() < 1.0e-3;
    scene.objects.iter().all(|object| object.colors.iter().flatten().all(whole))
}

/// A picture and its figures.
pub(crate) struct Figures {
    /// Premultiplied linear colours.
    pub(crate) pixels: Vec<[f32; 4]>,
    pub(crate) counters: Option<Counters>,
    pub(crate) times: Option<Vec<PassTime>>,
    /// Bytes held at one time.
    pub(crate) bytes: u64,
    pub(crate) slices: u32,
    /// Loops whose end was found out while they ran.
    pub(crate) loops: Vec<Looped>,
}

impl Figures {
    /// What loops left undone, in words.
    fn undone(&self) -> impl Iterator<Item = String> {
        self.loops.iter().filter(|looped| looped.end == LoopEnd::Cut).map(|Looped { until, rounds, .. }| {
            format!(
                "the loop until {until} was ended by its bound, after {rounds} rounds: the picture lacks what was left"
            )
        })
    }
}

/// The parameter of how many layers a resolve pass holds. What exceeds it is counted as `layers_exceeded`.
const LAYERS: &str = "layers";

/// Whether the description, or `--set`, says how many layers a resolve pass holds.
fn says_layers(variant: &Variant) -> bool {
    let mut selected = variant.choices.iter().flat_map(|chosen| &chosen.alternatives);
    selected.any(|selected| selected.options.iter().any(|(name, _)| name == LAYERS))
}

impl Painted {
    /// The option that makes the resolve pass hold more, and twice what it holds now, where some layers did not fit and
    /// there is more to be had.
    fn more_layers(&self) -> Option<(String, u32)> {
        self.drawn.counters.as_ref().filter(|counters| counters.get("layers_exceeded") > 0)?;
        self.plan.selection.rows.iter().find_map(|selected| {
            let parameter = selected.row.parameters.iter().find(|parameter| parameter.name == LAYERS)?;
            let (_, now) = self.plan.constants.iter().find(|(name, _)| *name == parameter.constant)?;
            let more = (2 * now).min(parameter.range.1);
            (more > *now).then(|| (format!("{}.{LAYERS}", selected.row.axis), more))
        })
    }

    /// Whether every event was counted, and not losses alone.
    pub(crate) fn counts_everything(&self) -> bool {
        self.plan.selection.offers().contains(&Fact::CountsEvents)
    }

    fn warn(&self, description: &str) {
        if self.drawn.pixels.iter().all(|[_, _, _, alpha]| *alpha == 0.0) {
            warn(&format!(
                "{description}: no fragment is seen; look at the camera, at `where`, and at uniforms, which are 0 unless given"
            ));
        }
        if self.behind.is_some() && !self.plan.resources.iter().any(|planned| planned.is_brought()) {
            warn(&format!(
                "{description}: it does not ask for the depths of opaque surfaces, so what lies behind them is seen through them"
            ));
        }
        self.drawn.undone().for_each(|text| warn(&format!("{description}: {text}")));
        for counter in self.drawn.counters.iter().flat_map(|counters| &counters.0) {
            // What better fragments displaced is what the description asked for.
            if counter.loss && counter.count > 0 && counter.name != "displaced" {
                warn(&format!("{description}: {} fragments lost: {}", counter.count, counter.name));
            }
            if counter.name == OUT_OF_ORDER && counter.count > 0 {
                warn(&format!(
                    "{description}: {} fragments came after farther ones had been composited; draw from front to back, or keep more",
                    counter.count
                ));
            }
            if counter.name == PARTLY_COVERED && counter.count > 0 {
                warn(&format!(
                    "{description}: {} fragments cover their pixel in part: at borders of triangles, pixels may show others than the first",
                    counter.count
                ));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_loop_that_was_cut_is_said() {
        let looped = |end| Looped { until: "`left` is zero".to_owned(), rounds: 7, end };
        let loops = vec![looped(LoopEnd::Reached), looped(LoopEnd::Cut)];
        let drawn = Figures { pixels: Vec::new(), counters: None, times: None, bytes: 0, slices: 1, loops };
        let said: Vec<String> = drawn.undone().collect();
        assert!(
            said.len() == 1 && said[0].contains("until `left` is zero was ended by its bound, after 7"),
            "{said:?}"
        );
    }
}
