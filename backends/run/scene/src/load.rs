//! Opens a scene by its name: a path, or `builtin:…`.

use std::path::Path;

use crate::error::{Error, FileError};
use crate::file::read;
use crate::{BuiltinScene, Scene, gltf, normals, obj, ply};

/// Opens the scene `name`. `color` is the colour of parts for which the model gives none: linear, straight alpha.
pub fn open(name: &str, color: [f32; 4]) -> Result<Scene, Error> {
    match name.strip_prefix("builtin:") {
        Some(builtin) => Ok(builtin.parse::<BuiltinScene>()?.generate()),
        None => load(Path::new(name), color),
    }
}

/// Loads a model: OBJ, PLY, glTF or GLB by its extension, optionally compressed as `.gz`.
pub fn load(path: &Path, color: [f32; 4]) -> Result<Scene, Error> {
    let file = path.display().to_string();
    let bytes = read(path)?;
    let name = file.to_lowercase();
    let plain = name.strip_suffix(".gz").unwrap_or(&name);
    let extension = Path::new(plain).extension().map(|extension| extension.to_string_lossy().into_owned());
    let mut scene = match extension.as_deref() {
        Some("obj") => {
            let folder = path.parent().unwrap_or(Path::new(""));
            obj::parse(&String::from_utf8_lossy(&bytes), &file, color, &|library| materials(folder, library))?
        }
        Some("ply") => ply::parse(&bytes, color).map_err(|error| error.in_file(&file))?,
        Some("gltf" | "glb") => gltf::parse(&bytes, path, color)?,
        _ => {
            return Err(FileError::whole("unknown extension: use .obj, .ply, .gltf or .glb, optionally with .gz")
                .in_file(&file));
        }
    };
    if scene.triangles() == 0 {
        return Err(FileError::whole("the model has no triangles").in_file(&file));
    }
    scene.objects.iter_mut().for_each(normals::complete);
    Ok(scene)
}

/// Returns the name and the text of a material library in the folder of its model.
fn materials(folder: &Path, library: &str) -> Result<(String, String), Error> {
    let path = folder.join(library);
    let bytes = read(&path)?;
    Ok((path.display().to_string(), String::from_utf8_lossy(&bytes).into_owned()))
}
