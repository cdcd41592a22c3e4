//! glTF 2.0, as JSON or GLB: the triangles of the default scene, with the transforms of nodes, normals, vertex colours and base
//! colour factors of materials. Alpha is used in every alpha mode. Textures, skins and animations are ignored.
//!
//! Every accessor is checked against its buffer before it is read.

use std::path::Path;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use glam::{Mat3, Mat4, Vec3};
use gltf::mesh::Mode;
use gltf::{Accessor, Gltf, Node, Primitive};

use crate::error::{Error, FileError, FilePosition};
use crate::file::read;
use crate::{Object, Scene};

/// Reads the model of `path`, whose bytes are `bytes`. `color` is the colour of primitives without a material.
pub(crate) fn parse(bytes: &[u8], path: &Path, color: [f32; 4]) -> Result<Scene, Error> {
    let file = path.display().to_string();
    let model = Gltf::from_slice(bytes).map_err(|error| file_error(&error).in_file(&file))?;
    let buffers = buffers(&model, path)?;
    let reader = Reader { buffers: &buffers, color };
    let mut scene = Scene::default();
    let roots = model.default_scene().or_else(|| model.scenes().next());
    let roots = roots.ok_or_else(|| FileError::whole("the file has no scene").in_file(&file))?;
    let mut pending: Vec<(Node<'_>, Mat4, usize)> = roots.nodes().map(|node| (node, Mat4::IDENTITY, 0)).collect();
    pending.reverse();
    while let Some((node, outer, depth)) = pending.pop() {
        // A tree is at most as deep as its number of nodes; a cycle is deeper.
        if depth > model.nodes().len() {
            return Err(FileError::whole(format!("node {} is its own descendant", node.index())).in_file(&file));
        }
        let transform = outer * Mat4::from_cols_array_2d(&node.transform().matrix());
        if let Some(mesh) = node.mesh() {
            let name = node.name().or(mesh.name()).unwrap_or_default().to_owned();
            let mut object = Object { name, ..Object::default() };
            for primitive in mesh.primitives() {
                reader.primitive(&primitive, &transform, &mut object).map_err(|error| error.in_file(&file))?;
            }
            scene.objects.push(object);
        }
        let children = node.children().map(|child| (child, transform, depth + 1));
        let first = pending.len();
        pending.extend(children);
        if let Some(children) = pending.get_mut(first..) {
            children.reverse();
        }
    }
    Ok(scene)
}

fn file_error(error: &gltf::Error) -> FileError {
    match error {
        gltf::Error::Deserialize(error) => FileError(FilePosition::Line(error.line()), error.to_string()),
        gltf::Error::Validation(errors) => {
            let errors: Vec<String> = errors.iter().map(|(path, error)| format!("{path}: {error}")).collect();
            FileError::whole(errors.join("; "))
        }
        other => FileError::whole(other.to_string()),
    }
}

/// Returns the bytes of every buffer: from the GLB, a data URI, or a file in the folder of the model.
fn buffers(model: &Gltf, path: &Path) -> Result<Vec<Vec<u8>>, Error> {
    let file = path.display().to_string();
    let mut buffers = Vec::new();
    for buffer in model.buffers() {
        let index = buffer.index();
        let error_at = |message: String| FileError::whole(format!("buffer {index}: {message}")).in_file(&file);
        let bytes = match buffer.source() {
            gltf::buffer::Source::Bin => {
                model.blob.clone().ok_or_else(|| error_at("the file has no binary chunk".to_owned()))?
            }
            gltf::buffer::Source::Uri(uri) => match uri.strip_prefix("data:") {
                Some(data) => {
                    let (_, text) =
                        data.split_once(";base64,").ok_or_else(|| error_at("its data is not base64".to_owned()))?;
                    STANDARD.decode(text).map_err(|error| error_at(format!("its data is invalid: {error}")))?
                }
                None => read(&path.parent().unwrap_or(Path::new("")).join(uri.replace("%20", " ")))?,
            },
        };
        if bytes.len() < buffer.length() {
            return Err(error_at(format!("it has {} bytes, but declares {}", bytes.len(), buffer.length())));
        }
        buffers.push(bytes);
    }
    Ok(buffers)
}

struct Reader<'a> {
    buffers: &'a [Vec<u8>],
    color: [f32; 4],
}

impl Reader<'_> {
    fn primitive(&self, primitive: &Primitive<'_>, transform: &Mat4, object: &mut Object) -> Result<(), FileError> {
        let material = primitive.material();
        // A primitive without a material has the default material of the format, white and opaque; `color` replaces it.
        let factor = material.index().map_or(self.color, |_| material.pbr_metallic_roughness().base_color_factor());
        let accessors = primitive.attributes().map(|(_, accessor)| accessor).chain(primitive.indices());
        for accessor in accessors {
            self.check(&accessor)?;
        }
        let reader = primitive.reader(|buffer| self.buffers.get(buffer.index()).map(Vec::as_slice));
        let missing = |what: &str| FileError::whole(format!("primitive {} has no readable {what}", primitive.index()));
        let positions: Vec<[f32; 3]> = reader.read_positions().ok_or_else(|| missing("positions"))?.collect();
        let normals: Vec<[f32; 3]> = reader.read_normals().map_or(Vec::new(), Iterator::collect);
        let colors: Vec<[f32; 4]> = reader.read_colors(0).map_or(Vec::new(), |colors| colors.into_rgba_f32().collect());
        let indices: Vec<u32> = match reader.read_indices() {
            Some(indices) => indices.into_u32().collect(),
            None => (0..positions.len() as u32).collect(),
        };
        let directions = Mat3::from_mat4(*transform).inverse().transpose();
        let first = object.positions.len() as u32;
        for (index, position) in positions.iter().enumerate() {
            let position = transform.transform_point3(Vec3::from_array(*position));
            if !position.is_finite() {
                return Err(FileError::whole(format!(
                    "position {index} of primitive {} is not finite",
                    primitive.index()
                )));
            }
            let normal = normals.get(index).map_or(Vec3::ZERO, |normal| directions * Vec3::from_array(*normal));
            let normal = if normal.is_finite() { normal } else { Vec3::ZERO };
            let vertex_color = colors.get(index).copied().unwrap_or([1.0; 4]);
            let color = std::array::from_fn(|channel| factor[channel] * vertex_color[channel]);
            object.vertex(position.to_array(), normal.to_array(), color);
        }
        if let Some(index) = indices.iter().find(|index| **index as usize >= positions.len()) {
            return Err(FileError::whole(format!(
                "no vertex {index} in primitive {}: it has {}",
                primitive.index(),
                positions.len()
            )));
        }
        let corners = triangles(primitive.mode(), &indices);
        let corners =
            corners.ok_or_else(|| FileError::whole(format!("{:?}: only triangles are supported", primitive.mode())))?;
        object.triangles.extend(corners.into_iter().map(|triangle| triangle.map(|index| first + index)));
        Ok(())
    }

    /// Checks that the accessor is within its view, and the view within its buffer.
    fn check(&self, accessor: &Accessor<'_>) -> Result<(), FileError> {
        let error_at = |message: &str| FileError::whole(format!("accessor {}: {message}", accessor.index()));
        let Some(view) = accessor.view() else {
            return Err(error_at("no buffer view; sparse accessors are not supported"));
        };
        if accessor.sparse().is_some() || accessor.count() == 0 {
            return Err(error_at("it is empty or sparse"));
        }
        let stride = view.stride().unwrap_or(accessor.size());
        let end = (accessor.count() - 1).checked_mul(stride).and_then(|end| end.checked_add(accessor.size()));
        let end = end.and_then(|end| end.checked_add(accessor.offset())).filter(|end| *end <= view.length());
        let length = self.buffers.get(view.buffer().index()).map_or(0, Vec::len);
        let inside = view.offset().checked_add(view.length()).is_some_and(|end| end <= length);
        if end.is_none() || !inside { Err(error_at("it reaches beyond its buffer")) } else { Ok(()) }
    }
}

fn triangles(mode: Mode, indices: &[u32]) -> Option<Vec<[u32; 3]>> {
    let triples = |(turn, window): (usize, &[u32])| match *window {
        [a, b, c] if turn % 2 == 0 => Some([a, b, c]),
        [a, b, c] => Some([b, a, c]),
        _ => None,
    };
    match mode {
        Mode::Triangles => Some(indices.chunks_exact(3).filter_map(|corners| corners.try_into().ok()).collect()),
        Mode::TriangleStrip => Some(indices.windows(3).enumerate().filter_map(triples).collect()),
        Mode::TriangleFan => {
            let (first, rest) = indices.split_first()?;
            Some(rest.windows(2).filter_map(|pair| Some([*first, *pair.first()?, *pair.last()?])).collect())
        }
        _ => None,
    }
}
