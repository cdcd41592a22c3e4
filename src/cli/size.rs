//! `fragbuf show --size`: the bytes of a frame of some size, the limits that a device must have for it, and its slices.
//!
//! Input: a plan and a size. Output: text or JSON. All numbers are those of the plan's formulas; nothing is allocated.

use std::fmt::Write as _;

use fragbuf::vocabulary::Formula;
use fragbuf::{Generation, Limit, Needed, Plan, limits};
use fragbuf_frame::{
    BufferLimit, Error, MemoryLimits, PoolSize, Sizing, Values, initial_values, most_rows, resource_bytes,
};
use fragbuf_model::counted;
use fragbuf_targets::PlanForTargets;
use serde_json::{Value, json};

use super::output::{self, Failure};

/// The frame whose memory is computed.
#[derive(Clone, Copy)]
pub(crate) struct FrameSize {
    pub(crate) size: (u32, u32),
    /// The fragments of an average pixel, for storages whose memory depends on them.
    pub(crate) per_pixel: u32,
}

/// The greatest binding of a WebGPU device whose program requests no other limit.
const BINDING: &str = "maxStorageBufferBindingSize";

/// Returns the sizes of every plan of a generation, as text or JSON.
pub(crate) fn sizes(generation: &Generation, frame: FrameSize, is_json: bool) -> Result<String, Failure> {
    let found = generation.plans.iter().map(|planned| {
        let targets: Vec<&str> = planned.targets.iter().map(|target| target.name).collect();
        Ok((
            targets,
            Sizes::of(planned, frame)
                .map_err(|error| Failure::Input(format!("{error}: give a smaller `--size`, or fewer `--fragments`")))?,
        ))
    });
    let found = found.collect::<Result<Vec<_>, Failure>>()?;
    Ok(match is_json {
        true => output::json(&found.iter().map(|(targets, sizes)| sizes.json(targets, frame)).collect::<Value>()),
        false => found.iter().map(|(targets, sizes)| sizes.text(targets, frame)).collect(),
    })
}

struct Sizes<'a> {
    k: Option<u32>,
    resources: Vec<(&'a str, u64)>,
    limits: Vec<(Limit, u64)>,
    /// The default of [`BINDING`], and the rows of a slice whose bindings fit into it; `None`: not even one row fits.
    binding: u64,
    rows: Option<u32>,
}

impl<'a> Sizes<'a> {
    fn of(planned: &'a PlanForTargets, FrameSize { size, per_pixel }: FrameSize) -> Result<Self, Error> {
        let plan = &planned.plan;
        let pixels = u64::from(size.0) * u64::from(size.1);
        let fragments = u32::try_from(pixels.saturating_mul(per_pixel.into())).unwrap_or(u32::MAX);
        let (values, _) = initial_values(plan, size, Sizing::Reserve(PoolSize::Fragments(fragments)))?;
        let limits: Vec<(Limit, u64)> = limits(plan, 0, &planned.workgroups)
            .into_iter()
            .map(|limit| needed(plan, &values, &limit).map(|needed| (limit, needed)))
            .collect::<Result<_, _>>()?;
        let default = |limit: &Limit| limit.webgpu.filter(|webgpu| webgpu.name == BINDING).map(|webgpu| webgpu.default);
        let binding = limits.iter().find_map(|(limit, _)| default(limit)).unwrap_or(u64::MAX);
        let help = "use a smaller frame";
        let memory = MemoryLimits {
            budget: u64::MAX,
            buffer: BufferLimit { bytes: binding, name: BINDING, help },
            copies_external: false,
            per_pixel: 0,
            per_slice_pixel: 0,
            per_slice: 0,
        };
        // Reserved fragments are those of a slice, so a slice of fewer rows needs a part of them.
        let fits = |rows: u32| {
            let part = u64::from(fragments) * u64::from(rows) / u64::from(size.1);
            let sizing = Sizing::Reserve(PoolSize::Fragments(u32::try_from(part).unwrap_or(u32::MAX)));
            let values = initial_values(plan, size, sizing).map(|(values, _)| values.with_rows(rows));
            values.is_ok_and(|values| memory.sizes(plan, &values).is_ok())
        };
        let rows = Some(most_rows(size.1, fits)).filter(|rows| *rows > 0);
        Ok(Sizes { k: values.k(), resources: resource_bytes(plan, &values)?, limits, binding, rows })
    }

    fn bytes(&self) -> u64 {
        self.resources.iter().fold(0, |sum: u64, (_, bytes)| sum.saturating_add(*bytes))
    }

    fn text(&self, targets: &[&str], FrameSize { size: (width, height), per_pixel }: FrameSize) -> String {
        let mut text = format!("{width} x {height} pixels, {} per pixel", counted(per_pixel, "fragment"));
        if let Some(k) = self.k {
            let _ = write!(text, ", k = {k}");
        }
        let _ = writeln!(text, ": {}", targets.join(" "));
        for (name, bytes) in &self.resources {
            let _ = writeln!(text, "  {name:<16} {bytes:>14} bytes");
        }
        let _ = writeln!(text, "  {:<16} {:>14} bytes", "all", self.bytes());
        text.push_str("limits\n");
        for (limit, needed) in &self.limits {
            let names = [limit.webgpu.map(|webgpu| webgpu.name), limit.vulkan, limit.opengl];
            let mut names: Vec<&str> = names.into_iter().flatten().collect();
            // WebGPU and Vulkan share some names.
            names.dedup();
            let beyond = limit.webgpu.filter(|webgpu| *needed > webgpu.default);
            let beyond = beyond.map(|webgpu| format!(", WebGPU's default is {}", webgpu.default)).unwrap_or_default();
            let _ = writeln!(text, "  {needed:>14}  {}{beyond}", names.join(", "));
        }
        let slices = match self.rows {
            Some(rows) if rows == height => "the whole frame fits".to_owned(),
            Some(rows) => {
                format!("{} of at most {} fit", counted(height.div_ceil(rows), "slice"), counted(rows, "row"))
            }
            None => "not even one row fits".to_owned(),
        };
        let _ = writeln!(text, "  with bindings of {} bytes, WebGPU's default, {slices}", self.binding);
        text
    }

    fn json(&self, targets: &[&str], FrameSize { size: (width, height), per_pixel }: FrameSize) -> Value {
        let limit = |(limit, needed): &(Limit, u64)| {
            json!({
                "webgpu": limit.webgpu.map(|webgpu| webgpu.name),
                "webgpu_default": limit.webgpu.map(|webgpu| webgpu.default),
                "vulkan": limit.vulkan,
                "opengl": limit.opengl,
                "needed": needed,
            })
        };
        let resource = |(name, bytes): &(&str, u64)| json!({ "name": name, "bytes": bytes });
        json!({
            "targets": targets,
            "width": width,
            "height": height,
            "fragments_per_pixel": per_pixel,
            "k": self.k,
            "resources": self.resources.iter().map(resource).collect::<Value>(),
            "bytes": self.bytes(),
            "limits": self.limits.iter().map(limit).collect::<Value>(),
            "slice_rows": self.rows,
            "slices": self.rows.map(|rows| height.div_ceil(rows)),
        })
    }
}

fn needed(plan: &Plan, values: &Values, limit: &Limit) -> Result<u64, Error> {
    match &limit.needed {
        Needed::Number(number) => Ok(*number),
        Needed::Formula(text) => {
            let what = format!("the limit {text}");
            let compiled = plan.symbols.compile(&Formula::from(text.clone()));
            values.evaluate(&compiled.map_err(|error| Error::Formula { what: what.clone(), error })?, &what)
        }
    }
}
