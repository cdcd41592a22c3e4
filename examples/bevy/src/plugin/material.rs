//! The shader that lights a `StandardMaterial` and stores the fragment, and the pipelines that have it.
//!
//! Input: generated functions, and the pipeline that Bevy has specialised for a mesh, its material and the camera. Output: the same
//! pipeline with another fragment shader, and with the targets of the pass that stores. Vertices, skins and bind groups remain Bevy's.

use bevy::asset::AssetServer;
use bevy::prelude::*;
use bevy::render::render_resource::{BindGroupLayoutDescriptor, MultisampleState, RenderPipelineDescriptor};
use bevy::shader::ShaderDefVal;
use fragbuf_follow::Error;

use crate::follower::{Follower, depth_stencil, sample_formula, targets};
use crate::{Attribute, GROUP, PREFIX, Passes};

/// The bind group of the material, behind that of the fragment buffer.
pub const MATERIAL_GROUP: usize = GROUP as usize + 1;

/// The format of the image that the passes resolve into.
pub const IMAGE_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;

/// What a material of Bevy gives: the name and the type of the attribute, and the expression.
const GIVEN: [(&str, &str, &str); 5] = [
    ("color", "vec4<f32>", "color"),
    // Bevy's depth is reversed.
    ("depth", "f32", "1.0 - vertex.position.z"),
    ("front", "u32", "u32(is_front)"),
    ("normal", "vec3<f32>", "pbr.N"),
    ("position", "vec3<f32>", "vertex.world_position.xyz"),
];

/// Lights a surface as Bevy's own shader for `StandardMaterial` does.
const LIT: &str = "
#import bevy_pbr::{
    forward_io::VertexOutput,
    pbr_fragment::pbr_input_from_standard_material,
    pbr_functions::{alpha_discard, apply_pbr_lighting, main_pass_post_lighting_processing},
    pbr_types::STANDARD_MATERIAL_FLAGS_UNLIT_BIT,
}

@fragment
fn store_material(vertex: VertexOutput, @builtin(front_facing) is_front: boolBUILT_INS) {
    var pbr = pbr_input_from_standard_material(vertex, is_front);
    pbr.material.base_color = alpha_discard(pbr.material, pbr.material.base_color);
    var color = pbr.material.base_color;
    if (pbr.material.flags & STANDARD_MATERIAL_FLAGS_UNLIT_BIT) == 0u {
        color = apply_pbr_lighting(pbr);
    }
    color = main_pass_post_lighting_processing(pbr, color);
    FUNCTION(vertex.position.xy, PREFIX_Fragment(ATTRIBUTES));
}
";

/// A pass that draws meshes.
pub struct StorePass {
    /// The index of its step.
    pub step: usize,
    shader: Handle<Shader>,
    layout: BindGroupLayoutDescriptor,
    targets: Vec<Option<wgpu::ColorTargetState>>,
    depth_stencil: Option<wgpu::DepthStencilState>,
    samples: u32,
}

/// Returns an error if a material of Bevy does not have an attribute.
pub fn check(passes: &Passes) -> Result<(), Error> {
    passes.attributes.iter().try_for_each(|attribute| expression(attribute).map(drop))
}

/// Returns the expression of an attribute in the shader.
fn expression(attribute: &Attribute) -> Result<String, Error> {
    let Attribute { name, kind, built_in } = attribute;
    if built_in.is_some() {
        return Ok(format!("built_in_{name}"));
    }
    let given = GIVEN.iter().find(|(known, of_kind, _)| known == name && of_kind == kind);
    given.map(|(_, _, expression)| (*expression).to_owned()).ok_or_else(|| {
        let known: Vec<String> = GIVEN.iter().map(|(name, kind, _)| format!("`{name}`: `{kind}`")).collect();
        Error(format!(
            "a `StandardMaterial` has no value for the attribute `{name}`, a `{kind}`: use {}",
            known.join(", ")
        ))
    })
}

/// Returns the passes of a follower that draw meshes, with their shaders.
pub fn store_passes(follower: &Follower, passes: &Passes, assets: &AssetServer) -> Result<Vec<StorePass>, Error> {
    let mut stores = Vec::new();
    for (step, pass) in follower.plan().passes() {
        let file = follower.files(&pass.name).find(|file| file.stage == "module");
        let (Some(file), Some(Some(layout))) = (file, follower.layouts().get(step)) else { continue };
        let text = shader(passes, passes.file(&file.path)?, &file.entry_point)?;
        let samples = follower.values().value(sample_formula(follower.plan(), pass), 0)?;
        stores.push(StorePass {
            step,
            shader: assets.add(Shader::from_wgsl(text, format!("fragbuf/{}/{}", passes.name, file.path))),
            layout: BindGroupLayoutDescriptor::new(format!("fragbuf {}", pass.name), &layout.entries),
            targets: targets(follower.plan(), pass, IMAGE_FORMAT)?,
            depth_stencil: depth_stencil(follower.plan(), pass)?,
            samples: samples as u32,
        });
    }
    Ok(stores)
}

/// Returns the shader of a pass: the generated functions, and the material that calls one of them.
fn shader(passes: &Passes, functions: &str, function: &str) -> Result<String, Error> {
    let attributes = passes.attributes.iter().map(expression).collect::<Result<Vec<_>, Error>>()?;
    let built_ins = passes.attributes.iter().filter_map(|attribute| {
        let built_in = attribute.built_in.as_ref()?;
        Some(format!(", @builtin({built_in}) built_in_{}: {}", attribute.name, attribute.kind))
    });
    let lit = LIT.replace("BUILT_INS", &built_ins.collect::<String>()).replace("FUNCTION", function);
    let lit = lit.replace("PREFIX", PREFIX).replace("ATTRIBUTES", &attributes.join(", "));
    Ok(format!("{functions}\n{lit}"))
}

impl StorePass {
    /// Returns the pipeline that stores what another one of Bevy would blend.
    pub fn pipeline(&self, blended: &RenderPipelineDescriptor) -> RenderPipelineDescriptor {
        let mut stored = blended.clone();
        stored.label = Some(self.layout.label.clone());
        stored.layout.insert(GROUP as usize, self.layout.clone());
        change_definitions(&mut stored.vertex.shader_defs);
        if let Some(fragment) = &mut stored.fragment {
            fragment.shader = self.shader.clone();
            fragment.entry_point = Some("store_material".into());
            fragment.targets = self.targets.clone();
            change_definitions(&mut fragment.shader_defs);
        }
        stored.depth_stencil = self.depth_stencil.clone();
        stored.multisample = MultisampleState { count: self.samples, ..default() };
        stored
    }
}

/// Moves the material behind the fragment buffer.
fn change_definitions(definitions: &mut [ShaderDefVal]) {
    for definition in definitions {
        if let ShaderDefVal::UInt(name, group) = definition
            && name == "MATERIAL_BIND_GROUP"
        {
            *group = MATERIAL_GROUP as u32;
        }
    }
}
