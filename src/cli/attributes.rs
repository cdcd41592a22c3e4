//! Converts the scene's vertices to a description's payload. The name of an attribute selects the scene's data, data of the model, or a
//! value of `--attribute`.

use std::ops::Range;

use fragbuf::Variant;
use fragbuf_codegen::Plan;
use fragbuf_model::{Format, nearest_name};
use fragbuf_scene::{AttributeRequest, AvailableAttribute, FilePosition, Object, Scene};

use super::memory::Budget;
use super::output::Failure;
use super::scene_data::{SCENE_DATA, SceneData, SceneVertex, bits, scene_data, scene_row};

/// The words of the vertices, three indices per triangle, and the range of indices of each object; none if the scene has an order of its own.
pub(crate) struct Geometry {
    pub(crate) vertices: Vec<u32>,
    pub(crate) indices: Vec<u32>,
    pub(crate) objects: Vec<Range<u32>>,
    /// The words of a vertex; the first three are its position.
    #[cfg_attr(not(feature = "gpu"), allow(dead_code, reason = "only GPUs draw boxes of objects"))]
    pub(crate) stride: usize,
    /// The memory that is left beside them.
    pub(crate) memory: Budget,
}

/// The attributes that the rasteriser computes, with their formats.
const RASTERISED: &str = "depth (f32), and front (u32)";

/// The greatest number of attributes of a model that a message lists.
const MAX_LISTED: usize = 12;

/// Where the words of an attribute come from.
enum Source {
    /// The data of every scene.
    Scene(&'static SceneData),
    /// An attribute of the model, by its index in the scene.
    Model(usize),
    /// A value of the command line, for every vertex.
    Value([u32; 4]),
}

/// An attribute that the scene must be opened with, and its format in the description.
#[derive(Clone, PartialEq)]
pub(crate) struct ModelAttribute {
    pub(crate) request: AttributeRequest,
    format: Format,
}

/// Returns the attributes of descriptions that are neither data of every scene nor `given` on the command line, and checks those
/// that are given.
pub(crate) fn model_attributes(
    variants: &[&Variant],
    given: &[(String, String)],
) -> Result<Vec<ModelAttribute>, Failure> {
    let attributes = || {
        let attributes = variants.iter().flat_map(|variant| &variant.attributes);
        attributes
            .filter(|attribute| attribute.is_vertex_input())
            .map(|attribute| (attribute.name.value.as_str(), attribute.format.value))
    };
    check_given(variants, given)?;
    let mut found: Vec<ModelAttribute> = Vec::new();
    for (name, format) in attributes() {
        if value(name, format, given)?.is_some() || scene_row(name).is_some_and(|row| !row.is_default) {
            continue;
        }
        let attribute = ModelAttribute { request: request(name, format), format };
        if found.iter().all(|other| other.request != attribute.request) {
            found.push(attribute);
        }
    }
    Ok(found)
}

/// Checks that the descriptions have each of the attributes that are `given`, and that none of these comes from the rasteriser.
fn check_given(variants: &[&Variant], given: &[(String, String)]) -> Result<(), Failure> {
    let attributes = || variants.iter().flat_map(|variant| &variant.attributes);
    let names: Vec<&str> = attributes()
        .filter(|attribute| attribute.is_vertex_input())
        .map(|attribute| attribute.name.value.as_str())
        .collect();
    let Some((name, _)) = given.iter().find(|(name, _)| !names.contains(&name.as_str())) else { return Ok(()) };
    if attributes().any(|attribute| attribute.name.value == *name) {
        let help = "remove the option, or give the attribute of the description another name";
        return Err(Failure::Usage(format!(
            "the attribute `{name}` comes from the rasteriser and cannot be set: {help}"
        )));
    }
    let known = match (nearest_name(name, &names), names.is_empty()) {
        (_, true) => "it has none that can be set".to_owned(),
        (Some(nearest), false) => format!("did you mean `{nearest}`? it has {}", names.join(", ")),
        (None, false) => format!("it has {}", names.join(", ")),
    };
    Err(Failure::Usage(format!("the description has no attribute `{name}` to set: {known}")))
}

/// Returns the failure for a scene without one of the attributes that it was opened with.
pub(crate) fn missing(
    (scene, other): (&str, Option<&(FilePosition, String)>),
    request: &AttributeRequest,
    available: &[AvailableAttribute],
    attributes: &[ModelAttribute],
) -> Failure {
    let attribute = attributes.iter().find(|attribute| attribute.request == *request);
    let format = attribute.map_or("", |attribute| attribute.format.keyword());
    let name = &request.name;
    let names = available.iter().map(|attribute| attribute.name.as_str());
    let names: Vec<&str> = names.chain(SCENE_DATA.iter().flat_map(|row| row.names.iter().copied())).collect();
    let nearest = nearest_name(name, &names).filter(|nearest| !nearest.eq_ignore_ascii_case(name));
    let nearest = nearest.map_or(String::new(), |nearest| format!("did you mean `{nearest}`? "));
    let of_model: Vec<String> = available
        .iter()
        .take(MAX_LISTED)
        .map(|attribute| {
            let formats = ["f32 or u32", "vec2", "vec3", "vec4"];
            let format = attribute.components.checked_sub(1).and_then(|index| formats.get(index));
            format!("{} ({}), ", attribute.name, format.unwrap_or(&"more components"))
        })
        .collect();
    let more = available.len().saturating_sub(MAX_LISTED);
    let more = if more == 0 { String::new() } else { format!("{more} more of the model, ") };
    let (place, other) = match other {
        Some((FilePosition::Line(line), reason)) => (format!("{scene}:{line}"), format!("{reason}; ")),
        Some((_, reason)) => (scene.to_owned(), format!("{reason}; ")),
        None => (scene.to_owned(), String::new()),
    };
    Failure::Input(format!(
        "{place}: the scene has no `{name}: {format}` for the fragments: {other}{nearest}it has {}{more}{}, {RASTERISED}; {}",
        of_model.concat(),
        scene_data(),
        advice(request)
    ))
}

/// Returns the vertices as the plan's geometry passes read them: the position, then the attributes in their order, without
/// depth. `given` are values of the command line. The vertices are taken from `memory`.
pub(crate) fn geometry(
    (scene, given): (&Scene, &[(String, String)]),
    plan: &Plan,
    memory: Budget,
) -> Result<Geometry, Failure> {
    let attributes = plan.variant.attributes.iter().filter(|attribute| attribute.is_vertex_input());
    let columns = attributes.map(|attribute| {
        let (name, format) = (attribute.name.value.as_str(), attribute.format.value);
        Ok((words(format), source(name, format, scene, given)?))
    });
    let columns: Vec<(usize, Source)> = columns.collect::<Result<_, Failure>>()?;
    let (memory, own_corners) = own_corners(scene, &columns, memory)?;
    let scene = own_corners.as_ref().unwrap_or(scene);
    let stride = 3 + columns.iter().map(|(words, _)| words).sum::<usize>();
    let words = stride.saturating_mul(scene.vertices());
    let bytes = (words as u64).saturating_add(3 * scene.triangles() as u64).saturating_mul(4);
    let memory = memory.without(bytes, "the list of vertices and indices")?;
    // Numbers of vertices and indices have 32 bits.
    if scene.vertices().max(3 * scene.triangles()) > u32::MAX as usize {
        return Err(Failure::Input("the scene has too many vertices or triangles".to_owned()));
    }
    let (mut vertices, mut indices) = (Vec::with_capacity(words), Vec::with_capacity(3 * scene.triangles()));
    let (mut first, mut objects) = (vec![0], Vec::new());
    for (id, object) in (0..).zip(&scene.objects) {
        let begin = first.last().copied().unwrap_or(0);
        first.push(begin + object.positions.len() as u32);
        for vertex in 0..object.positions.len() {
            vertices.extend(bits(&object.positions, vertex).iter().take(3));
            for (words, source) in &columns {
                let values = match source {
                    Source::Scene(row) => (row.read)(&SceneVertex { scene, object, id, index: vertex }),
                    Source::Model(index) => model_words(object, *index, (*words, vertex)),
                    Source::Value(value) => *value,
                };
                vertices.extend(values.iter().take(*words));
            }
        }
        if scene.order.is_empty() {
            let from = indices.len() as u32;
            indices.extend(object.triangles.iter().flatten().map(|index| begin + index));
            objects.push(from..indices.len() as u32);
        }
    }
    // Sorted triangles of one object are not one range: all of them count as one object.
    for id in &scene.order {
        let begin = first.get(id.object as usize).copied().unwrap_or(0);
        indices.extend(scene.corners(*id).into_iter().flatten().map(|index| begin + index));
    }
    Ok(Geometry { vertices, indices, objects, stride, memory })
}

/// Returns the first word of the colour in a vertex; `None`: the description has no colour of the scene.
#[cfg(feature = "playground")]
pub(crate) fn color_offset(attributes: &[fragbuf_model::Attribute]) -> Option<usize> {
    let mut offset = 3;
    for attribute in attributes.iter().filter(|attribute| attribute.is_vertex_input()) {
        let (name, format) = (attribute.name.value.as_str(), attribute.format.value);
        if scene_row(name).is_some_and(|row| row.is_color && row.formats.contains(&format)) {
            return Some(offset);
        }
        offset += words(format);
    }
    None
}

/// Checks that every attribute of the descriptions has a source.
pub(crate) fn check_sources(variants: &[&Variant], scene: &Scene, given: &[(String, String)]) -> Result<(), Failure> {
    let attributes = variants.iter().flat_map(|variant| &variant.attributes);
    for attribute in attributes.filter(|attribute| attribute.is_vertex_input()) {
        source(&attribute.name.value, attribute.format.value, scene, given)?;
    }
    Ok(())
}

/// Returns the source of an attribute. A value of the command line has precedence.
fn source(name: &str, format: Format, scene: &Scene, given: &[(String, String)]) -> Result<Source, Failure> {
    if let Some(value) = value(name, format, given)? {
        return Ok(Source::Value(value));
    }
    let request = request(name, format);
    let index = scene.attributes.iter().position(|attribute| *attribute == request);
    if let Some(row) = scene_row(name).filter(|row| row.formats.contains(&format) && index.is_none()) {
        return Ok(Source::Scene(row));
    }
    index.map(Source::Model).ok_or_else(|| {
        Failure::Input(format!(
            "the scene has no `{name}: {}` for the fragments: it has {}, {RASTERISED}; {}",
            format.keyword(),
            scene_data(),
            advice(&request)
        ))
    })
}

/// Returns the advice to set an attribute on the command line.
fn advice(AttributeRequest { name, components, is_integer, .. }: &AttributeRequest) -> String {
    let value = vec![if *is_integer { "1" } else { "0.5" }; *components].join(",");
    format!("`--attribute {name}={value}` sets a value for every vertex")
}

/// Returns the attribute of a model for one of a description.
fn request(name: &str, format: Format) -> AttributeRequest {
    AttributeRequest {
        name: name.to_owned(),
        components: words(format),
        is_integer: format == Format::U32,
        is_optional: scene_row(name).is_some(),
    }
}

/// Returns the number of words of a format in a vertex.
fn words(format: Format) -> usize {
    match format {
        Format::F32 | Format::U32 => 1,
        Format::Vec2 => 2,
        Format::Vec3 | Format::Octahedral => 3,
        Format::Vec4 | Format::Rgba8 | Format::Rgba16 => 4,
    }
}

/// Parses the last value for an attribute on the command line. `None`: there is none.
fn value(name: &str, format: Format, given: &[(String, String)]) -> Result<Option<[u32; 4]>, Failure> {
    let Some((_, text)) = given.iter().rev().find(|(other, _)| other == name) else { return Ok(None) };
    let word = |part: &str| match format {
        Format::U32 => part.parse().ok(),
        _ => part.parse().ok().filter(|value: &f32| value.is_finite()).map(f32::to_bits),
    };
    let parsed: Option<Vec<u32>> = text.split(',').map(|part| word(part.trim())).collect();
    let count = words(format);
    match parsed.filter(|parsed| parsed.len() == count) {
        Some(parsed) => Ok(Some(std::array::from_fn(|index| parsed.get(index).copied().unwrap_or(0)))),
        None => {
            let expected = match (format, count) {
                (Format::U32, _) => "one whole number, 0 or more".to_owned(),
                (_, 1) => "one number".to_owned(),
                _ => format!("{count} numbers, separated by commas"),
            };
            let is_name = text.starts_with(|letter: char| letter.is_ascii_alphabetic()) && text.parse::<f32>().is_err();
            let help = match is_name {
                true => format!(
                    "; for the attribute `{text}` of the scene, name it so in the description: `{text}: {}`",
                    format.keyword()
                ),
                false => String::new(),
            };
            let message = format!("attribute `{name}: {}` takes {expected}, not `{text}`{help}", format.keyword());
            Err(Failure::Usage(message))
        }
    }
}

/// Returns the words of an attribute of the model, padded with 0.
fn model_words(object: &Object, index: usize, (count, vertex): (usize, usize)) -> [u32; 4] {
    let words = object.attributes.get(index).and_then(|words| words.get(vertex * count..(vertex + 1) * count));
    std::array::from_fn(|index| words.and_then(|words| words.get(index)).copied().unwrap_or(0))
}

/// Returns the scene with vertices of its own for each triangle if an attribute needs them. Its memory is taken from `memory`.
fn own_corners(scene: &Scene, columns: &[(usize, Source)], memory: Budget) -> Result<(Budget, Option<Scene>), Failure> {
    if !columns.iter().any(|(_, source)| matches!(source, Source::Scene(row) if row.is_of_corners)) {
        return Ok((memory, None));
    }
    let memory = memory.without(scene.bytes_with_own_corners(), "the corners of the triangles")?;
    Ok((memory, Some(scene.with_own_corners())))
}
