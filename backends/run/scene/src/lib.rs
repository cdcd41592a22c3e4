//! Scenes: triangles with normals, colours and objects, from a model file or generated.
//!
//! Input: the path of an OBJ, PLY, glTF or VTK model, or `builtin:NAME[,parameter=value]`. Output: a complete and checked
//! [`Scene`]: finite numbers, indices in range, a normal and a colour for every vertex, and the attributes that the caller requests. A
//! malformed model is never corrected silently: it is an [`Error`] with its position, or a [`Warning`] where other readers of the
//! format go on, too. A scene beyond the [`Limits`] is an error before its memory is allocated. This crate is independent of fragment buffers and devices.

mod attribute;
mod builtin;
mod camera;
mod color_range;
mod corners;
mod disorder;
mod error;
mod file;
mod foreign;
mod gltf;
mod limits;
mod load;
mod materials;
mod model;
mod normals;
mod obj;
mod placement;
mod ply;
mod polygon;
mod presort;
mod scene;
mod shading;
mod subdivision;
mod tetrahedra;
mod text;
mod vtk;
mod warnings;

pub use attribute::{AttributeRequest, AvailableAttribute};
pub use builtin::{Attribute, BUILTIN_SCENES, BuiltinScene, Parameter};
pub use camera::{Camera, CameraError, Eye, FIELD_OF_VIEW};
pub use corners::edge_distances;
pub use disorder::disorder;
pub use error::{Error, FilePosition};
pub use limits::Limits;
pub use load::{load, load_with, open, open_with};
pub use placement::Placement;
pub use presort::DepthOrder;
pub use scene::{Object, Scene, TriangleId};
pub use shading::light;
pub use warnings::{Warning, WarningKind};
