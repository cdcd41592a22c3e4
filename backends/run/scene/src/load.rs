//! Opens a scene by its name: a path, or `builtin:…`.

use std::path::Path;

use crate::error::{Error, FileError};
use crate::file::{beside, read};
use crate::limits::Budget;
use crate::{BuiltinScene, Limits, Scene, gltf, normals, obj, ply};

/// Opens the scene `name`. `color` is the colour of parts for which the model gives none: linear, straight alpha.
pub fn open(name: &str, color: [f32; 4], limits: &Limits) -> Result<Scene, Error> {
    match name.strip_prefix("builtin:") {
        Some(builtin) => builtin.parse::<BuiltinScene>()?.generate(limits),
        None => load(Path::new(name), color, limits),
    }
}

/// Loads a model: OBJ, PLY, glTF or GLB by its extension, optionally compressed as `.gz`.
pub fn load(path: &Path, color: [f32; 4], limits: &Limits) -> Result<Scene, Error> {
    let file = path.display().to_string();
    let name = file.to_lowercase();
    let plain = name.strip_suffix(".gz").unwrap_or(&name);
    let extension = Path::new(plain).extension().map(|extension| extension.to_string_lossy().into_owned());
    let extension = extension.as_deref().filter(|extension| EXTENSIONS.contains(extension));
    let Some(extension) = extension else {
        return Err(
            FileError::whole("unknown extension: use .obj, .ply, .gltf or .glb, optionally with .gz").in_file(&file)
        );
    };
    let budget = Budget::new(limits);
    let bytes = read(path, &budget)?;
    let mut scene = match extension {
        "obj" => {
            let folder = path.parent().unwrap_or(Path::new(""));
            obj::parse(&bytes, &file, color, &|library| materials((&file, folder), library, &budget), &budget)?
        }
        "ply" => ply::parse(&bytes, color, &budget).map_err(|error| error.in_file(&file))?,
        _ => gltf::parse(&bytes, path, color, &budget)?,
    };
    if scene.triangles() == 0 {
        return Err(FileError::whole("the model has no triangles").in_file(&file));
    }
    scene.objects.iter_mut().for_each(normals::complete);
    Ok(scene)
}

/// The extensions of models. Without one of them a file is not opened.
const EXTENSIONS: [&str; 4] = ["obj", "ply", "gltf", "glb"];

/// Returns the name and the bytes of a material library in the folder of its model. A `#` in `library` may be part of the name or begin a
/// comment: the longest name of a file that exists is read.
fn materials((model, folder): (&str, &Path), library: &str, budget: &Budget) -> Result<(String, Vec<u8>), Error> {
    let mut path = beside(folder, library).map_err(|error| error.in_file(model))?;
    let mut name = library;
    while !path.exists() {
        let Some((shorter, _)) = name.rsplit_once('#').filter(|(shorter, _)| !shorter.trim_end().is_empty()) else {
            break;
        };
        name = shorter.trim_end();
        path = folder.join(name);
    }
    Ok((path.display().to_string(), read(&path, budget)?))
}
