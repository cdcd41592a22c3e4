//! Answers the triangles of a scene with the attributes that a description reads, for the page to draw them itself.

use fragbuf::{Registry, Selection, plan};
use fragbuf_codegen::Plan;
use fragbuf_scene::{AttributeRequest, Scene};
use serde::Deserialize;
use serde_json::{Value, json};

use super::description::{Folder, sentence};
use super::models::Models;
use super::problem::Problem;
use super::scene::{MEMORY, RequestedScene};
use crate::cli::attributes::{color_offset, geometry, model_attributes};
use crate::cli::memory::{Budget, budget};
use crate::cli::output::Failure;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct GeometryRequest {
    text: String,
    /// The name of a generated scene, without `builtin:`, with its parameters; or that of a model.
    scene: String,
}

/// Returns the triangles of a scene for a description without files, as [`GeometryRequest`] answers.
pub(in crate::cli) fn triangles(text: &str, scene: &str) -> Result<Vec<u8>, String> {
    let request = GeometryRequest { text: text.to_owned(), scene: scene.to_owned() };
    request.answer(&Folder(None), &Models::default()).map_err(|problem| problem.message)
}

impl GeometryRequest {
    /// Returns the length of a header in four bytes, the header as JSON, zeros up to a multiple of four bytes, then words: vertices,
    /// normals, indices.
    pub(super) fn answer(&self, folder: &Folder, models: &Models) -> Result<Vec<u8>, Problem> {
        let registry = Registry::builtin();
        let variant = folder.variant(&self.text, &registry)?;
        let requested = RequestedScene::find(&self.scene, models)?;
        let problem = |failure: Failure| Problem::input(failure.message());
        let wanted = model_attributes(&[&variant], &[]).map_err(problem)?;
        let wanted: Vec<AttributeRequest> = wanted.into_iter().map(|attribute| attribute.request).collect();
        let memory = budget(MEMORY).map_err(Problem::server)?;
        let scene = requested.open(&wanted, memory.left())?;
        let plan = plan(&variant, &Selection::first(&variant), &registry);
        let plan = plan.map_err(|errors| Problem::input(sentence(&errors)))?;
        let rest = memory.without(scene.bytes(), "the scene").map_err(problem)?;
        packed(&scene, &plan, rest)
    }
}

fn packed(scene: &Scene, plan: &Plan, memory: Budget) -> Result<Vec<u8>, Problem> {
    let geometry = geometry((scene, &[]), plan, memory).map_err(|failure| Problem::input(failure.message()))?;
    let objects: Vec<Value> = geometry.objects.iter().map(|range| json!([range.start, range.end])).collect();
    let header = json!({
        "stride": geometry.stride,
        "vertices": geometry.vertices.len() / geometry.stride.max(1),
        "indices": geometry.indices.len(),
        "objects": objects,
        "triangles": scene.triangles(),
        "color": color_offset(&plan.variant.attributes),
    });
    let mut bytes = header.to_string().into_bytes();
    let length = bytes.len() as u32;
    bytes.resize(bytes.len().next_multiple_of(4), 0);
    let normals = scene.objects.iter().flat_map(|object| object.normals.iter().flatten().map(|value| value.to_bits()));
    let words = geometry.vertices.iter().copied().chain(normals).chain(geometry.indices.iter().copied());
    let mut packed = length.to_le_bytes().to_vec();
    packed.append(&mut bytes);
    words.for_each(|word| packed.extend(word.to_le_bytes()));
    Ok(packed)
}
