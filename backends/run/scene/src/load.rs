//! A scene by its name: a path, or `builtin:…`.

use std::io::Read as _;
use std::path::Path;

use crate::error::{Error, Fault};
use crate::{Builtin, Scene, gltf, normals, obj, ply};

/// The scene that `name` stands for. `color` is the colour of what the model gives none: linear, straight alpha.
pub fn open(name: &str, color: [f32; 4]) -> Result<Scene, Error> {
    match name.strip_prefix("builtin:") {
        Some(builtin) => Ok(builtin.parse::<Builtin>()?.generate()),
        None => load(Path::new(name), color),
    }
}

/// The model of a file: OBJ, PLY, glTF or GLB by its extension; any of them may be compressed, as `.gz`.
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
        Some("ply") => ply::parse(&bytes, color).map_err(|fault| fault.of(&file))?,
        Some("gltf" | "glb") => gltf::parse(&bytes, path, color)?,
        _ => {
            return Err(
                Fault::whole("no model by its name: .obj, .ply, .gltf and .glb are read, also with .gz").of(&file)
            );
        }
    };
    if scene.triangles() == 0 {
        return Err(Fault::whole("there are no triangles in it").of(&file));
    }
    scene.objects.iter_mut().for_each(normals::complete);
    Ok(scene)
}

/// The bytes of a file, decompressed.
pub(crate) fn read(path: &Path) -> Result<Vec<u8>, Error> {
    let file = path.display().to_string();
    let bytes =
        std::fs::read(path).map_err(|error| Error::Unreadable { file: file.clone(), reason: error.to_string() })?;
    if !bytes.starts_with(&[0x1f, 0x8b]) {
        return Ok(bytes);
    }
    let mut plain = Vec::new();
    flate2::read::MultiGzDecoder::new(bytes.as_slice())
        .read_to_end(&mut plain)
        .map_err(|error| Fault::whole(format!("its compression is broken: {error}")).of(&file))?;
    Ok(plain)
}

/// The name and the text of a material library beside its model.
fn materials(folder: &Path, library: &str) -> Result<(String, String), Error> {
    let path = folder.join(library);
    let bytes = read(&path)?;
    Ok((path.display().to_string(), String::from_utf8_lossy(&bytes).into_owned()))
}
