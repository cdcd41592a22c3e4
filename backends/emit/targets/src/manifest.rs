//! Writes `manifest.json`, which an engine follows to run the generated passes. The schema is versioned: within one version,
//! fields are added and never renamed or removed.

mod bindings;
pub(crate) mod frame;
mod resources;

use fragbuf_codegen::{Form, GENERATOR, Plan, PlanSymbol, PlanValue, SymbolId};
use fragbuf_model::{UniformBlock, mangled};
use fragbuf_templates::COUNTERS;
use fragbuf_templates::vocabulary::SYMBOLS;
use serde_json::{Map, Value, json};

use crate::generate::{Generation, PlanForTargets};
use crate::limits::{Limit, Needed, Sharing, limits};
use crate::names::kebab_case;
use crate::{Binding, OpenGlBindings, Requirements, Target, requirements, tier};

/// The version of `manifest.json`.
pub const SCHEMA: &str = "fragbuf-manifest/4";

/// The JSON Schema of `manifest.json` (draft 2020-12).
pub const JSON_SCHEMA: &str = include_str!("../manifest.schema.json");

/// The bindings of the uniform blocks; the first resource follows.
pub(crate) const FRAME: u32 = 0;
pub(crate) const UNIFORMS: u32 = 1;
pub(crate) const CAMERA: u32 = 2;

/// A plan, and what else its part of a manifest depends on.
struct Context<'a> {
    plan: &'a Plan,
    group: u32,
    form: Form,
    opengl: OpenGlBindings,
    /// What the text of each pass declares, for each target.
    bindings: &'a [(&'static Target, Vec<Vec<Binding>>)],
}

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
    let form = if generation.form == Form::Program { "program" } else { "module" };
    manifest.insert("form".into(), form.into());
    manifest.insert("prefix".into(), generation.prefix.clone().into());
    manifest.insert("conventions".into(), conventions());
    manifest.insert("files".into(), files(generation));
    if let Some(first) = first {
        manifest.extend(planned_json(first, group, generation.form));
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
            alternative.extend(planned_json(planned, group, generation.form));
            alternative.into()
        })
        .collect();
    manifest.insert("alternatives".into(), alternatives.into());
    manifest.into()
}

/// Returns the part of a manifest that depends on one plan and on its text.
fn planned_json(planned: &PlanForTargets, group: u32, form: Form) -> Map<String, Value> {
    let plan = &planned.plan;
    let mut map = part(&Context { plan, group, form, opengl: OpenGlBindings::of(plan), bindings: &planned.bindings });
    let requires = planned.bindings.iter().map(|(target, bindings)| {
        let Requirements { api, version, features, extensions } = requirements(plan, target, bindings);
        let value = json!({ "api": api, "version": version, "features": features, "extensions": extensions });
        (target.name.to_owned(), value)
    });
    map.insert("requires".into(), requires.collect::<Map<_, _>>().into());
    map.insert("limits".into(), limits_json(planned, group, form));
    map
}

/// Returns what is the same in every manifest: how matrices, clip space and images are oriented, and the state of every pass that draws.
/// The scissor rectangle is x, y, width and height.
fn conventions() -> Value {
    json!({
        "matrices": "column-major",
        "clip_depth": [0, 1],
        "clip_y": "up",
        "first_row": "top",
        "topology": "triangle-list",
        "cull_mode": "none",
        "viewport": "frame",
        "scissor": ["0", "first_row", "width", "height"],
    })
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

/// Returns the limits that a device must meet. Vertices are the caller's in module form.
fn limits_json(planned: &PlanForTargets, group: u32, form: Form) -> Value {
    let limit = |limit: Limit| {
        json!({
            "webgpu": limit.webgpu.map(|webgpu| webgpu.name),
            "webgpu_default": limit.webgpu.map(|webgpu| webgpu.default),
            "vulkan": limit.vulkan,
            "opengl": limit.opengl,
            "opengl_minimum": limit.opengl_minimum(),
            "needed": match limit.needed {
                Needed::Number(number) => Value::from(number),
                Needed::Formula(formula) => Value::from(formula),
            },
            "in_one_shader": if limit.sharing == Sharing::Sum { "sum" } else { "greatest" },
        })
    };
    let is_of_form = |limit: &Limit| {
        let is_of_vertices =
            ["maxVertexAttributes", "maxInterStageShaderVariables"].map(|name| limit.is_of_webgpu(name));
        form == Form::Program || !is_of_vertices.contains(&true)
    };
    limits(&planned.plan, group, &planned.workgroups).into_iter().filter(is_of_form).map(limit).collect()
}

/// Returns the part of a manifest in program form that depends on a plan alone: without what its text declares.
pub fn plan_json(plan: &Plan, group: u32) -> Map<String, Value> {
    part(&Context { plan, group, form: Form::Program, opengl: OpenGlBindings::of(plan), bindings: &[] })
}

fn part(context: &Context<'_>) -> Map<String, Value> {
    let Context { plan, .. } = *context;
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
    if plan.needs_whole_frame() {
        map.insert("whole_frame".into(), true.into());
    }
    map.insert("entry".into(), entry(plan));
    map.insert("uniform_blocks".into(), uniform_blocks(context));
    if context.form == Form::Program {
        map.insert("vertex_inputs".into(), vertex_inputs(plan));
    }
    map.insert("resources".into(), resources::resources(context));
    map.insert("exchanges".into(), frame::exchanges(plan));
    map.insert("steps".into(), frame::steps(context));
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
/// std140 for these types. The camera's is read by the vertex stages of program form.
fn uniform_blocks(context: &Context<'_>) -> Value {
    let Context { plan, group, .. } = *context;
    let field = |name: &str, kind: &str, offset: u32| json!({ "name": name, "type": kind, "offset": offset });
    let frame = (0..).zip(&plan.fields).map(|(word, id)| field(&plan.symbols.get(*id).name, "u32", 4 * word));
    let frame: Vec<Value> = frame.collect();
    let uniforms = &plan.variant.uniforms;
    let UniformBlock { offsets, size } = UniformBlock::of(uniforms);
    let user_fields = offsets.into_iter().zip(uniforms);
    let user_fields = user_fields.map(|(offset, one)| {
        let mut field = field(&mangled(&one.name.value), one.kind.value.wgsl_type(), offset);
        field["uniform"] = one.name.value.as_str().into();
        field
    });
    let block = |name: &str, binding: u32, bytes: u32, fields: Vec<Value>| {
        let opengl = context.opengl.point(binding);
        json!({
            "name": name, "group": group, "binding": binding, "opengl_binding": opengl, "bytes": bytes, "fields": fields,
        })
    };
    let mut blocks = vec![block("frame", FRAME, (4 * plan.fields.len() as u32).next_multiple_of(16), frame)];
    if !uniforms.is_empty() {
        blocks.push(block("uniforms", UNIFORMS, size, user_fields.collect()));
    }
    if context.form == Form::Program {
        let mut matrix = field("view_projection", "mat4x4<f32>", 0);
        matrix["column_stride"] = 16.into();
        blocks.push(block("camera", CAMERA, 64, vec![matrix]));
    }
    blocks.into()
}

/// Returns the vertex inputs of geometry passes, in program form.
fn vertex_inputs(plan: &Plan) -> Value {
    let position = json!({ "location": 0, "name": "position", "type": "vec3<f32>" });
    let attributes = plan.variant.attributes.iter().filter(|attribute| attribute.is_vertex_input());
    let others = (1..).zip(attributes).map(|(location, attribute)| {
        json!({ "location": location, "name": attribute.name.value, "type": attribute.format.value.wgsl_type() })
    });
    std::iter::once(position).chain(others).collect()
}

fn counters(plan: &Plan) -> Value {
    if plan.resource("counters").is_none() {
        return json!([]);
    }
    let rows = COUNTERS.iter().enumerate().map(|(index, (name, kind, meaning))| {
        let is_loss = kind.makes_image_wrong();
        json!({ "name": name, "index": index, "is_loss": is_loss, "meaning": meaning })
    });
    rows.collect()
}
