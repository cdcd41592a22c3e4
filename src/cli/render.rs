//! `fragbuf render`: a picture of a scene through one description, and the figures of its frame.

use fragbuf::vocabulary::Fact;
use fragbuf_frame::{LoopEnd, Looped, PassTime};
use serde_json::{Value, json};

use super::output::{self, Failure};
use super::paint::{Painted, Wish, paint};
use super::picture;
use super::progress::Progress;
use super::view::{Stage, View, scenes};

#[derive(clap::Args)]
#[command(after_help = scenes())]
pub(crate) struct Render {
    /// A technique's key, or a .fragbuf file
    description: String,
    /// Changes the description: axis=value, axis.option=value or k=8
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = super::assignment)]
    set: Vec<(String, String)>,
    /// A uniform of the description; those that are not given are 0
    #[arg(long = "uniform", value_name = "NAME=VALUE[,VALUE]", value_parser = super::assignment)]
    uniforms: Vec<(String, String)>,
    #[command(flatten)]
    view: View,
}

impl Render {
    pub(crate) fn run(&self) -> Result<(), Failure> {
        let view = &self.view;
        view.check()?;
        let progress = Progress::new();
        progress.stage(format!("loading {}", view.scene));
        let (stage, opaque) = view.stages()?;
        let wish = Wish {
            description: &self.description,
            set: &self.set,
            uniforms: &self.uniforms,
            count_all: view.json,
            opaque: opaque.as_ref(),
        };
        let painted = paint(&wish, view, &stage, &progress)?;
        progress.stage(format!("writing {}", view.out.display()));
        let pixels = picture::displayed(&painted.drawn.pixels, view.background, view.linear);
        picture::write(&view.out, view.size, &pixels, view.linear)?;
        drop(progress);
        if view.json {
            output::print(&output::json(&figures(&self.description, &painted, &stage)))?;
        }
        Ok(())
    }
}

/// Milliseconds of a pass; null where the device could not time all of its runs.
fn milliseconds(time: &PassTime) -> Value {
    if time.untimed == 0 { time.milliseconds.into() } else { Value::Null }
}

/// What `--json` says of one frame. Counts are null where the description does not count.
pub(crate) fn figures(description: &str, painted: &Painted, stage: &Stage) -> Value {
    let ms: serde_json::Map<String, Value> =
        painted.drawn.times.iter().flatten().map(|time| (time.pass.clone(), milliseconds(time))).collect();
    let losses: serde_json::Map<String, Value> = painted
        .drawn
        .counters
        .iter()
        .flat_map(|counters| counters.0.iter().filter(|counter| counter.loss))
        .map(|counter| (counter.name.to_owned(), counter.count.into()))
        .collect();
    let tally = tally(painted);
    json!({
        "description": description,
        "device": painted.device,
        "backend": painted.backend,
        "target": painted.target,
        "triangles": stage.scene.triangles(),
        "k": painted.plan.variant.keep,
        "fragment": payload(painted),
        "ms": if painted.drawn.times.is_some() { Value::from(ms) } else { Value::Null },
        "bytes": painted.drawn.bytes,
        "fragments": {
            "generated": tally.as_ref().map(|tally| tally.generated),
            "stored": tally.as_ref().map(|tally| tally.stored),
            "culled": tally.as_ref().map(|tally| tally.culled),
            "occluded": tally.as_ref().map(|tally| tally.occluded),
            "dropped": painted.drawn.counters.as_ref().map(|counters| counters.lost()),
        },
        "lost": losses,
        "hit_ratio": tally.as_ref().map(|tally| tally.hit_ratio),
        "loops": loops(painted),
        "frames": painted.frames,
        "slices": painted.drawn.slices,
    })
}

/// How the loops ended that wait for something: `cut` left work undone.
fn loops(painted: &Painted) -> Value {
    let row = |looped: &Looped| {
        let end = match looped.end {
            LoopEnd::Reached => "reached",
            LoopEnd::Cut => "cut",
        };
        json!({ "until": looped.until, "rounds": looped.rounds, "end": end })
    };
    painted.drawn.loops.iter().map(row).collect()
}

/// The attributes that fragments carried, each with its format.
fn payload(painted: &Painted) -> Value {
    let attributes = painted.plan.variant.attributes.iter();
    attributes
        .map(|a| (a.name.value.clone(), Value::from(a.format.value.keyword())))
        .collect::<serde_json::Map<_, _>>()
        .into()
}

/// Where the fragments of a frame went.
pub(crate) struct Tally {
    generated: u64,
    culled: u64,
    /// Behind something opaque, and not among the generated ones.
    occluded: u64,
    stored: u64,
    /// Kept fragments over generated ones.
    pub(crate) hit_ratio: f64,
}

/// `None` where not every event was counted: a test that is fixed function counts nothing.
pub(crate) fn tally(painted: &Painted) -> Option<Tally> {
    let is_counted = painted.counts_everything() && !painted.plan.selection.offers().contains(&Fact::FixedFunction);
    let counters = painted.drawn.counters.as_ref().filter(|_| is_counted)?;
    let (generated, culled) = (u64::from(counters.get("generated")), u64::from(counters.get("culled")));
    let stored = generated.saturating_sub(culled + counters.lost());
    let hit_ratio = if generated == 0 { 1.0 } else { stored as f64 / generated as f64 };
    let occluded = u64::from(counters.get("occluded"));
    Some(Tally { generated, culled, occluded, stored, hit_ratio })
}
