//! glTF 2.0, as JSON or GLB: the triangles of the default scene, with nodes' transforms, normals, vertex colours and the
//! materials' base colour factors, alpha included whatever the alpha mode. Textures, skins and animations are passed over.
//!
//! Every accessor is held against its buffer before anything is read through it.

use std::path::Path;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use glam::{Mat3, Mat4, Vec3};
use gltf::mesh::Mode;
use gltf::{Accessor, Gltf, Node, Primitive};

use crate::error::{Error, Fault, Place};
use crate::load::read;
use crate::{Object, Scene};

/// Reads the model of `path`, whose bytes are `bytes`. `color` is the colour of what has no material.
pub(crate) fn parse(bytes: &[u8], path: &Path, color: [f32; 4]) -> Result<Scene, Error> {
    let file = path.display().to_string();
    let model = Gltf::from_slice(bytes).map_err(|error| refused(&error).of(&file))?;
    let buffers = buffers(&model, path)?;
    let reader = Reader { buffers: &buffers, color };
    let mut scene = Scene::default();
    let roots = model.default_scene().or_else(|| model.scenes().next());
    let roots = roots.ok_or_else(|| Fault::whole("there is no scene in it").of(&file))?;
    let mut waiting: Vec<(Node<'_>, Mat4, usize)> = roots.nodes().map(|node| (node, Mat4::IDENTITY, 0)).collect();
    waiting.reverse();
    while let Some((node, outer, depth)) = waiting.pop() {
        // A tree is never deeper than it has nodes; a circle is.
        if depth > model.nodes().len() {
            return Err(Fault::whole(format!("node {} is its own descendant", node.index())).of(&file));
        }
        let transform = outer * Mat4::from_cols_array_2d(&node.transform().matrix());
        if let Some(mesh) = node.mesh() {
            let name = node.name().or(mesh.name()).unwrap_or_default().to_owned();
            let mut object = Object { name, ..Object::default() };
            for primitive in mesh.primitives() {
                reader.primitive(&primitive, &transform, &mut object).map_err(|fault| fault.of(&file))?;
            }
            scene.objects.push(object);
        }
        let children = node.children().map(|child| (child, transform, depth + 1));
        let first = waiting.len();
        waiting.extend(children);
        if let Some(children) = waiting.get_mut(first..) {
            children.reverse();
        }
    }
    Ok(scene)
}

fn refused(error: &gltf::Error) -> Fault {
    match error {
        gltf::Error::Deserialize(error) => Fault(Place::Line(error.line()), error.to_string()),
        gltf::Error::Validation(mistakes) => {
            let mistakes: Vec<String> = mistakes.iter().map(|(path, error)| format!("{path}: {error}")).collect();
            Fault::whole(mistakes.join("; "))
        }
        other => Fault::whole(other.to_string()),
    }
}

/// The bytes of every buffer: the GLB's own, a data URI's, or a file's beside the model.
fn buffers(model: &Gltf, path: &Path) -> Result<Vec<Vec<u8>>, Error> {
    let file = path.display().to_string();
    let mut buffers = Vec::new();
    for buffer in model.buffers() {
        let index = buffer.index();
        let fault = |message: String| Fault::whole(format!("buffer {index}: {message}")).of(&file);
        let bytes = match buffer.source() {
            gltf::buffer::Source::Bin => {
                model.blob.clone().ok_or_else(|| fault("the file has no binary part".to_owned()))?
            }
            gltf::buffer::Source::Uri(uri) => match uri.strip_prefix("data:") {
                Some(data) => {
                    let (_, text) =
                        data.split_once(";base64,").ok_or_else(|| fault("its data is not in base64".to_owned()))?;
                    STANDARD.decode(text).map_err(|error| fault(format!("its data is broken: {error}")))?
                }
                None => read(&path.parent().unwrap_or(Path::new("")).join(uri.replace("%20", " ")))?,
            },
        };
        if bytes.len() < buffer.length() {
            return Err(fault(format!("{} bytes, and {} are said", bytes.len(), buffer.length())));
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
    fn primitive(&self, primitive: &Primitive<'_>, transform: &Mat4, object: &mut Object) -> Result<(), Fault> {
        let material = primitive.material();
        // The material of index none is the format's own default: white and opaque. Here it stands for none.
        let factor = material.index().map_or(self.color, |_| material.pbr_metallic_roughness().base_color_factor());
        let accessors = primitive.attributes().map(|(_, accessor)| accessor).chain(primitive.indices());
        for accessor in accessors {
            self.check(&accessor)?;
        }
        let reader = primitive.reader(|buffer| self.buffers.get(buffer.index()).map(Vec::as_slice));
        let missing =
            |what: &str| Fault::whole(format!("primitive {} has no {what} that can be read", primitive.index()));
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
                return Err(Fault::whole(format!("position {index} of primitive {} is not finite", primitive.index())));
            }
            let normal = normals.get(index).map_or(Vec3::ZERO, |normal| directions * Vec3::from_array(*normal));
            let normal = if normal.is_finite() { normal } else { Vec3::ZERO };
            let own = colors.get(index).copied().unwrap_or([1.0; 4]);
            let color = std::array::from_fn(|channel| factor[channel] * own[channel]);
            object.vertex(position.to_array(), normal.to_array(), color);
        }
        if let Some(index) = indices.iter().find(|index| **index as usize >= positions.len()) {
            return Err(Fault::whole(format!(
                "no vertex {index} in primitive {}: there are {}",
                primitive.index(),
                positions.len()
            )));
        }
        let corners = triangles(primitive.mode(), &indices);
        let corners =
            corners.ok_or_else(|| Fault::whole(format!("{:?}: only triangles are read", primitive.mode())))?;
        object.triangles.extend(corners.into_iter().map(|triangle| triangle.map(|index| first + index)));
        Ok(())
    }

    /// The accessor lies within its view, and the view within its buffer.
    fn check(&self, accessor: &Accessor<'_>) -> Result<(), Fault> {
        let fault = |message: &str| Fault::whole(format!("accessor {}: {message}", accessor.index()));
        let Some(view) = accessor.view() else { return Err(fault("no buffer view; sparse ones are not read")) };
        if accessor.sparse().is_some() || accessor.count() == 0 {
            return Err(fault("empty or sparse"));
        }
        let stride = view.stride().unwrap_or(accessor.size());
        let end = (accessor.count() - 1).checked_mul(stride).and_then(|end| end.checked_add(accessor.size()));
        let end = end.and_then(|end| end.checked_add(accessor.offset())).filter(|end| *end <= view.length());
        let length = self.buffers.get(view.buffer().index()).map_or(0, Vec::len);
        let inside = view.offset().checked_add(view.length()).is_some_and(|end| end <= length);
        if end.is_none() || !inside { Err(fault("it reaches beyond its buffer")) } else { Ok(()) }
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
