//! Converts the scene's vertices to a description's payload. The name of an attribute selects the scene's data.

use std::ops::Range;

use fragbuf_codegen::Plan;
use fragbuf_model::Format;
use fragbuf_scene::{Object, Scene};

use super::memory::Budget;
use super::output::Failure;

/// The words of the vertices, three indices per triangle, and the range of indices of each object.
pub(crate) struct Geometry {
    pub(crate) vertices: Vec<u32>,
    pub(crate) indices: Vec<u32>,
    pub(crate) objects: Vec<Range<u32>>,
    /// The memory that is left beside them.
    pub(crate) memory: Budget,
}

/// A function that returns the words of one attribute of a vertex.
type ReadWords = fn(object: &Object, id: u32, vertex: usize) -> [u32; 4];

/// The data of a scene: its names, the formats that it can be read as, and the function that reads it.
const SCENE_DATA: [(&[&str], &[Format], ReadWords); 4] = [
    (&["color", "colour"], &[Format::Rgba8, Format::Rgba16, Format::Vec4, Format::Vec3], |object, _, vertex| {
        bits(&object.colors, vertex)
    }),
    (&["alpha"], &[Format::F32], |object, _, vertex| [bits(&object.colors, vertex)[3], 0, 0, 0]),
    (&["normal"], &[Format::Octahedral, Format::Vec3], |object, _, vertex| bits(&object.normals, vertex)),
    (&["id", "object"], &[Format::U32], |_, id, _| [id, 0, 0, 0]),
];

/// Returns the vertices as the plan's geometry passes read them: the position, then the attributes in their order, without
/// depth. They are taken from `memory`.
pub(crate) fn geometry(scene: &Scene, plan: &Plan, memory: Budget) -> Result<Geometry, Failure> {
    let attributes = plan.variant.attributes.iter().filter(|attribute| attribute.name.value != "depth");
    let columns = attributes.map(|attribute| column(&attribute.name.value, attribute.format.value));
    let columns: Vec<(usize, ReadWords)> = columns.collect::<Result<_, _>>()?;
    let stride = 3 + columns.iter().map(|(words, _)| words).sum::<usize>();
    let words = stride.saturating_mul(scene.vertices());
    let bytes = (words as u64).saturating_add(3 * scene.triangles() as u64).saturating_mul(4);
    let memory = memory.without(bytes, "the list of vertices and indices")?;
    // Numbers of vertices and indices have 32 bits.
    if scene.vertices().max(3 * scene.triangles()) > u32::MAX as usize {
        return Err(Failure::Input("the scene has too many vertices or triangles".to_owned()));
    }
    let (mut vertices, mut indices) = (Vec::with_capacity(words), Vec::with_capacity(3 * scene.triangles()));
    let (mut first, mut objects) = (0, Vec::with_capacity(scene.objects.len()));
    for (id, object) in (0..).zip(&scene.objects) {
        for vertex in 0..object.positions.len() {
            let position = bits(&object.positions, vertex);
            let attributes = columns.iter().map(|(words, read)| (*words, read(object, id, vertex)));
            for (words, values) in std::iter::once((3, position)).chain(attributes) {
                vertices.extend(values.iter().take(words));
            }
        }
        let begin = indices.len() as u32;
        indices.extend(object.triangles.iter().flatten().map(|index| first + index));
        objects.push(begin..indices.len() as u32);
        first += object.positions.len() as u32;
    }
    Ok(Geometry { vertices, indices, objects, memory })
}

/// Returns the number of words of an attribute in a vertex, and the function that reads them.
fn column(name: &str, format: Format) -> Result<(usize, ReadWords), Failure> {
    let found = SCENE_DATA.iter().find(|(names, formats, _)| names.contains(&name) && formats.contains(&format));
    let Some((_, _, read)) = found else {
        let known: Vec<String> = SCENE_DATA
            .iter()
            .map(|(names, formats, _)| {
                let formats: Vec<&str> = formats.iter().map(|format| format.keyword()).collect();
                format!("{} ({})", names.join(" or "), formats.join(", "))
            })
            .collect();
        return Err(Failure::Input(format!(
            "the scene has no `{name}: {}` for the fragments: it has {}, and depth",
            format.keyword(),
            known.join(", ")
        )));
    };
    let words = match format {
        Format::F32 | Format::U32 => 1,
        Format::Vec2 => 2,
        Format::Vec3 | Format::Octahedral => 3,
        Format::Vec4 | Format::Rgba8 | Format::Rgba16 => 4,
    };
    Ok((words, *read))
}

/// Returns the bits of a vertex's values, padded with 0.
fn bits<const N: usize>(values: &[[f32; N]], vertex: usize) -> [u32; 4] {
    let values = values.get(vertex);
    std::array::from_fn(|index| values.and_then(|values| values.get(index)).map_or(0, |value| value.to_bits()))
}
