//! Scenes: triangles with normals, colours and objects, from a model's file or generated.
//!
//! In: the path of an OBJ, PLY or glTF model, or `builtin:NAME[,parameter=value]`. Out: a [`Scene`], whole and checked:
//! finite numbers, indices in range, a normal and a colour for every vertex. A model is never mended in silence: what is
//! malformed is an [`Error`] with its place. Nothing here knows of fragment buffers or devices.

mod builtin;
mod camera;
mod error;
mod gltf;
mod load;
mod materials;
mod normals;
mod obj;
mod ply;
mod scene;
mod shading;
mod text;

pub use builtin::{BUILTIN, Builtin, Parameter};
pub use camera::{Camera, Eye};
pub use error::{Error, Place};
pub use load::{load, open};
pub use scene::{Object, Scene};
pub use shading::light;
