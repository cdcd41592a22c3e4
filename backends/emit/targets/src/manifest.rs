//! Writes `manifest.json`, which an engine follows to run the generated passes. The schema is versioned: within one version,
//! fields are added and never renamed or removed.

mod frame;

use fragbuf_codegen::{GENERATOR, Plan, PlanSymbol, PlanValue, PlannedResource, SymbolId};
use fragbuf_glsl::Dialect;
use fragbuf_model::{UniformBlock, mangled};
use fragbuf_templates::vocabulary::{Element, Init, Lifetime, SYMBOLS, TextureFormat};
use fragbuf_templates::{COUNTERS, CounterKind};
use serde_json::{Map, Value, json};

use crate::generate::{Generation, PlanForTargets};
use crate::glsl::slot;
use crate::limits::{Limit, Needed, Sharing, limits};
use crate::names::kebab_case;
use crate::tier;

/// The schema of `manifest.json`.
pub const SCHEMA: &str = "fragbuf-manifest/3";

/// Returns the manifest of a generation whose resources are in bind group `group`.
pub fn manifest(generation: &Generation, group: u32) -> Value {
    let mut manifest = Map::new();
    manifest.insert("schema".into(), SCHEMA.into());
    manifest.insert("generator".into(), GENERATOR.into());
    let mut plans = generation.plans.iter();
    let first = plans.next();
    let technique = first.and_then(|planned| planned.plan.variant.technique.clone());
    manifest.insert("technique".into(), technique.into());
    manifest.insert("name".into(), first.map(|planned| planned.plan.variant.name.value.clone()).into());
    manifest.insert("files".into(), files(generation));
    if let Some(first) = first {
        manifest.extend(plan_json(&first.plan, group));
        manifest.insert("limits".into(), limits_json(first, group));
    }
    manifest.insert("tier".into(), tiers(&generation.plans));
    let unsupported: Map<String, Value> =
        generation.unsupported.iter().map(|(target, why)| (target.name.to_owned(), why.to_string().into())).collect();
    manifest.insert("unsupported".into(), unsupported.into());
    let alternatives: Vec<Value> = plans
        .map(|planned| {
            let mut alternative = Map::new();
            let targets: Vec<&str> = planned.targets.iter().map(|target| target.name).collect();
            alternative.insert("targets".into(), targets.into());
            alternative.extend(plan_json(&planned.plan, group));
            alternative.insert("limits".into(), limits_json(planned, group));
            alternative.into()
        })
        .collect();
    manifest.insert("alternatives".into(), alternatives.into());
    manifest.into()
}

fn files(generation: &Generation) -> Value {
    let rows = generation.files.iter().flat_map(|file| {
        file.entry_points.iter().map(move |(stage, entry_point)| {
            json!({
                "path": file.path,
                "target": file.target,
                "pass": file.pass,
                "stage": stage,
                "entry_point": entry_point,
            })
        })
    });
    rows.collect()
}

fn tiers(plans: &[PlanForTargets]) -> Value {
    let mut tiers = Map::new();
    for planned in plans {
        for target in &planned.targets {
            tiers.insert(target.name.to_owned(), tier(planned.plan.soundness, target).into());
        }
    }
    tiers.into()
}

/// Returns the limits that a device must meet.
fn limits_json(planned: &PlanForTargets, group: u32) -> Value {
    let limit = |limit: Limit| {
        json!({
            "webgpu": limit.webgpu.map(|webgpu| webgpu.name),
            "webgpu_default": limit.webgpu.map(|webgpu| webgpu.default),
            "vulkan": limit.vulkan,
            "opengl": limit.opengl,
            "needed": match limit.needed {
                Needed::Number(number) => Value::from(number),
                Needed::Formula(formula) => Value::from(formula),
            },
            "in_one_shader": if limit.sharing == Sharing::Sum { "sum" } else { "greatest" },
        })
    };
    limits(&planned.plan, group, &planned.workgroups).into_iter().map(limit).collect()
}

/// Returns the part of a manifest that depends on one plan.
pub fn plan_json(plan: &Plan, group: u32) -> Map<String, Value> {
    let mut map = Map::new();
    let axes: Map<String, Value> = plan
        .selection
        .rows
        .iter()
        .map(|selected| (selected.row.axis.clone(), selected.row.key.clone().into()))
        .collect();
    map.insert("axes".into(), axes.into());
    map.insert("keep".into(), plan.variant.keep.into());
    map.insert("words_per_pixel".into(), plan.words_per_pixel.clone().into());
    map.insert("symbols".into(), symbols(plan));
    map.insert("geometry_passes".into(), plan.geometry_passes.clone().into());
    map.insert("features".into(), plan.requires.iter().map(|feature| Value::from(feature.name())).collect());
    map.insert(
        "constants".into(),
        plan.constants.iter().map(|(name, value)| (name.clone(), Value::from(*value))).collect::<Map<_, _>>().into(),
    );
    map.insert("entry".into(), entry(plan));
    map.insert("uniform_blocks".into(), uniform_blocks(plan, group));
    map.insert("vertex_inputs".into(), vertex_inputs(plan));
    map.insert("resources".into(), plan.resources.iter().map(|planned| resource(planned, group)).collect());
    map.insert("exchanges".into(), frame::exchanges(plan));
    map.insert("steps".into(), frame::steps(plan));
    map.insert("counters".into(), counters(plan));
    let hazards = plan.hazards.iter().map(|hazard| json!({ "name": hazard.name, "description": hazard.description }));
    map.insert("hazards".into(), hazards.collect());
    map
}

/// Returns the symbols of formulas: meaning, time of binding, setter, range, and the value or default if there is one.
fn symbols(plan: &Plan) -> Value {
    let symbol = |(_, symbol): (SymbolId, &PlanSymbol)| {
        let (least, most) = symbol.range;
        let mut value = json!({
            "name": symbol.name,
            "meaning": symbol.meaning,
            "when": symbol.when.name(),
            "set_by": symbol.set_by.name(),
            "least": least,
            "most": most,
        });
        match &symbol.value {
            PlanValue::Number(number) => value["value"] = (*number).into(),
            PlanValue::Default(quantity) => value["default"] = quantity.to_string().into(),
            PlanValue::Open => {}
        }
        value
    };
    plan.symbols.iter().take(SYMBOLS.len()).map(symbol).collect()
}

fn entry(plan: &Plan) -> Value {
    let words = plan.layout.values.iter().map(|word| word.field.as_str());
    let fields: Vec<&str> = std::iter::once("key").chain(words).collect();
    json!({ "words": plan.layout.entry_words(), "fields": fields, "key": kebab_case(&format!("{:?}", plan.layout.key)) })
}

/// Returns the uniform blocks with their fields in order. Offsets and sizes are bytes of WGSL's uniform layout, which equals
/// std140 for these types.
fn uniform_blocks(plan: &Plan, group: u32) -> Value {
    let field = |name: &str, kind: &str, offset: u32| json!({ "name": name, "type": kind, "offset": offset });
    let frame = (0..).zip(&plan.fields).map(|(word, id)| field(&plan.symbols.get(*id).name, "u32", 4 * word));
    let frame: Vec<Value> = frame.collect();
    let uniforms = &plan.variant.uniforms;
    let UniformBlock { offsets, size } = UniformBlock::of(uniforms);
    let user_fields = offsets.into_iter().zip(uniforms);
    let user_fields =
        user_fields.map(|(offset, one)| field(&mangled(&one.name.value), one.kind.value.wgsl_type(), offset));
    let block = |name: &str, binding: u32, bytes: u32, fields: Vec<Value>| {
        let opengl = opengl_binding(group, binding);
        json!({
            "name": name, "group": group, "binding": binding, "opengl_binding": opengl, "bytes": bytes, "fields": fields,
        })
    };
    let mut blocks = vec![block("frame", 0, (4 * plan.fields.len() as u32).next_multiple_of(16), frame)];
    if !uniforms.is_empty() {
        blocks.push(block("uniforms", 1, size, user_fields.collect()));
    }
    blocks.push(block("camera", 2, 64, vec![field("view_projection", "mat4x4<f32>", 0)]));
    blocks.into()
}

fn opengl_binding(group: u32, binding: u32) -> u32 {
    slot(Dialect::OpenGl450, group, binding).binding
}

/// Returns the vertex inputs of geometry passes, in program form.
fn vertex_inputs(plan: &Plan) -> Value {
    let position = json!({ "location": 0, "name": "position", "type": "vec3<f32>" });
    let attributes = plan.variant.attributes.iter().filter(|attribute| attribute.name.value != "depth");
    let others = (1..).zip(attributes).map(|(location, attribute)| {
        json!({ "location": location, "name": attribute.name.value, "type": attribute.format.value.wgsl_type() })
    });
    std::iter::once(position).chain(others).collect()
}

fn resource(planned: &PlannedResource, group: u32) -> Value {
    let resource = &planned.resource;
    let extents: Vec<Value> =
        resource.extents.iter().map(|extent| json!({ "name": extent.name, "length": extent.length.0 })).collect();
    let element = match resource.element {
        Element::Texture(format) => format!("texture:{}", texture_format(format)),
        Element::Word => "word".to_owned(),
        Element::Word64 => "word64".to_owned(),
        Element::Entry => "entry".to_owned(),
        Element::Value => "value".to_owned(),
        Element::ValueTextures(format) => format!("value-textures:{}", texture_format(format)),
        Element::EntryTextures(format) => format!("entry-textures:{}", texture_format(format)),
    };
    let init = match resource.init {
        Init::Clear(value) => json!({ "clear": value }),
        Init::Keep => json!("keep"),
        Init::External => json!("external"),
    };
    let mut value = json!({
        "name": resource.name,
        "group": group,
        "binding": planned.binding,
        "opengl_binding": opengl_binding(group, planned.binding),
        "element": element,
        "extents": extents,
        "words": planned.words.to_string(),
        "bytes": format!("4 * ({})", planned.words),
        "init": init,
        "lifetime": if resource.lifetime == Lifetime::Persistent { "persistent" } else { "frame" },
        "summary": resource.summary,
    });
    if let Element::Texture(format) = resource.element {
        value["texture"] = texture(planned, format);
    }
    value
}

/// Returns how to create a texture. It has the size of the frame; `clear` has one value per channel of its format. `word` is the
/// field of an entry that it stores, if an entry is spread over one texture per word.
fn texture(planned: &PlannedResource, format: TextureFormat) -> Value {
    let resource = &planned.resource;
    let clear = match resource.init {
        Init::Clear(word) => texel(format, word),
        _ => Value::Null,
    };
    json!({
        "format": texture_format(format),
        "samples": planned.sample_count().map_or("1", |count| &count.formula().0),
        "clear": clear,
        "word": planned.part.as_ref().map(|part| &part.field),
    })
}

/// Returns the channels of a texel that stores this word.
fn texel(format: TextureFormat, word: u32) -> Value {
    match format {
        TextureFormat::R32Uint => json!([word]),
        TextureFormat::Rg16Uint => json!([word & 0xffff, word >> 16]),
        TextureFormat::Rgba8Unorm => json!(word.to_le_bytes().map(|byte| f64::from(byte) / 255.0)),
        TextureFormat::R32Float => json!([f32::from_bits(word)]),
        TextureFormat::Rg32Float => vec![f32::from_bits(word); 2].into(),
        TextureFormat::Rgba16Float => vec![f32::from_bits(word); 4].into(),
        TextureFormat::Depth32Float => json!({ "depth": f32::from_bits(word) }),
        TextureFormat::Depth24PlusStencil8 => {
            json!({ "depth": f64::from(word >> 8) / 16_777_215.0, "stencil": word & 0xff })
        }
    }
}

fn texture_format(format: TextureFormat) -> &'static str {
    match format {
        TextureFormat::R32Uint => "r32uint",
        TextureFormat::Rg16Uint => "rg16uint",
        TextureFormat::R32Float => "r32float",
        TextureFormat::Rg32Float => "rg32float",
        TextureFormat::Rgba8Unorm => "rgba8unorm",
        TextureFormat::Rgba16Float => "rgba16float",
        TextureFormat::Depth32Float => "depth32float",
        TextureFormat::Depth24PlusStencil8 => "depth24plus-stencil8",
    }
}

fn counters(plan: &Plan) -> Value {
    if plan.resource("counters").is_none() {
        return json!([]);
    }
    let rows = COUNTERS.iter().enumerate().map(|(index, (name, kind, meaning))| {
        let is_loss = *kind == CounterKind::Loss;
        json!({ "name": name, "index": index, "is_loss": is_loss, "meaning": meaning })
    });
    rows.collect()
}
