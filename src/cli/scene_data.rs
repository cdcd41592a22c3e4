//! The data that every scene has for attributes of fragments, a row each.
//!
//! Input: a vertex of a scene. Output: the words of an attribute, padded with 0.

use fragbuf_model::Format;
use fragbuf_scene::{Object, Scene, edge_distances};

/// A function that returns the words of one attribute of a vertex.
type ReadWords = fn(vertex: &SceneVertex<'_>) -> [u32; 4];

/// A vertex of a scene.
pub(super) struct SceneVertex<'a> {
    pub(super) scene: &'a Scene,
    pub(super) object: &'a Object,
    /// The number of its object.
    pub(super) id: u32,
    /// Its index in the object.
    pub(super) index: usize,
}

/// Data of every scene.
pub(super) struct SceneData {
    pub(super) names: &'static [&'static str],
    /// The formats that it can be read as.
    pub(super) formats: &'static [Format],
    pub(super) read: ReadWords,
    /// Whether an attribute of the model with this name has precedence.
    pub(super) is_default: bool,
    /// Whether light changes it.
    #[cfg_attr(
        not(feature = "playground"),
        allow(dead_code, reason = "only the page of the playground lights vertices itself")
    )]
    pub(super) is_color: bool,
    /// Whether it differs between the triangles around a vertex.
    pub(super) is_of_corners: bool,
}

/// Every row.
pub(super) const SCENE_DATA: [SceneData; 6] = [
    SceneData {
        names: &["color", "colour"],
        formats: &[Format::Rgba8, Format::Rgba16, Format::Vec4, Format::Vec3],
        read: |vertex| bits(&vertex.object.colors, vertex.index),
        is_default: false,
        is_color: true,
        is_of_corners: false,
    },
    SceneData {
        names: &["alpha"],
        formats: &[Format::F32],
        read: |vertex| [bits(&vertex.object.colors, vertex.index)[3], 0, 0, 0],
        is_default: false,
        is_color: false,
        is_of_corners: false,
    },
    SceneData {
        names: &["normal"],
        formats: &[Format::Octahedral, Format::Vec3],
        read: |vertex| bits(&vertex.object.normals, vertex.index),
        is_default: false,
        is_color: false,
        is_of_corners: false,
    },
    SceneData {
        names: &["position"],
        formats: &[Format::Vec3],
        read: |vertex| model_position(vertex),
        is_default: true,
        is_color: false,
        is_of_corners: false,
    },
    SceneData {
        names: &["edges"],
        formats: &[Format::Vec3],
        read: |vertex| edges(vertex),
        is_default: true,
        is_color: false,
        is_of_corners: true,
    },
    SceneData {
        names: &["id", "object"],
        formats: &[Format::U32],
        read: |vertex| [vertex.id, 0, 0, 0],
        is_default: true,
        is_color: false,
        is_of_corners: false,
    },
];

/// Returns the data of every scene with this name.
pub(super) fn scene_row(name: &str) -> Option<&'static SceneData> {
    static ROWS: [SceneData; 6] = SCENE_DATA;
    ROWS.iter().find(|row| row.names.contains(&name))
}

/// Returns the names and formats of the data of every scene.
pub(super) fn scene_data() -> String {
    let one = |SceneData { names, formats, .. }: &SceneData| {
        let formats: Vec<&str> = formats.iter().map(|format| format.keyword()).collect();
        format!("{} ({})", names.join(" or "), formats.join(", "))
    };
    SCENE_DATA.iter().map(one).collect::<Vec<String>>().join(", ")
}

/// Returns the words of the position in the coordinates of the model. Far from their zero it is rounded to `f32`.
fn model_position(SceneVertex { scene, object, index, .. }: &SceneVertex<'_>) -> [u32; 4] {
    let position = object.positions.get(*index).copied().unwrap_or_default();
    let [x, y, z] = scene.placement.model_position(position).map(f32::to_bits);
    [x, y, z, 0]
}

/// Returns the distances to the edges of the triangle in the coordinates of the model. The scene has vertices of its own for each triangle.
fn edges(SceneVertex { scene, object, index, .. }: &SceneVertex<'_>) -> [u32; 4] {
    let corner = |corner: usize| object.positions.get(index - index % 3 + corner).copied().unwrap_or_default();
    let corners = [corner(0), corner(1), corner(2)].map(|position| scene.placement.model_position(position));
    let [a, b, c] = edge_distances(corners, index % 3).map(f32::to_bits);
    [a, b, c, 0]
}

/// Returns the bits of a vertex's values, padded with 0.
pub(super) fn bits<const N: usize>(values: &[[f32; N]], vertex: usize) -> [u32; 4] {
    let values = values.get(vertex);
    std::array::from_fn(|index| values.and_then(|values| values.get(index)).map_or(0, |value| value.to_bits()))
}
