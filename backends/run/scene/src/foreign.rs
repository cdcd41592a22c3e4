//! Recognises files that are not the model that their extension promises: an image, a page of a server, another format of models.
//!
//! Input: the bytes of a file. Output: an error that names what the file is.

use crate::error::FileError;
use crate::text::without_mark;

/// The first bytes of other formats, what a file with them is, and what to do.
const MAGIC: &[(&[u8], &str, &str)] = &[
    (b"\x89PNG", "a PNG image", ""),
    (b"\xff\xd8\xff", "a JPEG image", ""),
    (b"GIF8", "a GIF image", ""),
    (b"RIFF", "a WebP, WAV or AVI file", ""),
    (b"%PDF", "a PDF document", ""),
    (b"PK\x03\x04", "a ZIP archive", "unpack it, and give the model in it"),
    (b"BLENDER", "a Blender file", "export it as glTF"),
    (b"Kaydara FBX", "an FBX model", "convert it to glTF"),
    (b"\xfe\xff", "text in UTF-16", "save it as UTF-8"),
    (b"\xff\xfe", "text in UTF-16", "save it as UTF-8"),
    (b"\x1f\x8b", "compressed twice", "unpack it once"),
    (b"version https://git-lfs", "a pointer of Git LFS, and not the model itself", "run `git lfs pull`"),
    (b"<!doctype", "a page in HTML", "download the file that the page links to"),
    (b"<html", "a page in HTML", "download the file that the page links to"),
    (b"<?xml", "an XML file, such as COLLADA or X3D", "convert it to glTF"),
    (b"solid ", "an STL model", "convert it to PLY"),
];

/// The first bytes of the formats that are read, their names and the extension for each.
const MODELS: &[(&[u8], &str, &str)] = &[
    (b"ply\n", "a PLY", "ply"),
    (b"ply\r", "a PLY", "ply"),
    (b"glTF", "a binary glTF", "glb"),
    (b"# vtk DataFile", "a VTK file", "vtk"),
    (b"<VTKFile", "an XML file of VTK", "vtu"),
    (b"{", "JSON", "gltf"),
];

/// The greatest number of bytes that are compared.
const LONGEST: usize = 32;

/// Checks that a file may be a model with this extension.
pub(crate) fn check(bytes: &[u8], extension: &str) -> Result<(), FileError> {
    let text = without_mark(bytes).trim_ascii_start();
    if text.is_empty() {
        return Err(FileError::whole("the file is empty"));
    }
    let begins = |with: &[u8]| {
        [bytes, text].iter().any(|bytes| {
            let start = bytes.get(..with.len().min(LONGEST));
            start.is_some_and(|start| start.eq_ignore_ascii_case(with))
        })
    };
    // The name of the root follows what is compared.
    let is_vtk = |extension: &str| ["vtk", "vtu"].contains(&extension);
    let may_be_vtk = is_vtk(extension) && begins(b"<?xml");
    if let Some((_, what, fix)) = MAGIC.iter().find(|(magic, ..)| begins(magic) && !may_be_vtk) {
        let fix = if fix.is_empty() { "give an OBJ, a PLY, a glTF or a VTK" } else { fix };
        return Err(FileError::whole(format!("the file is {what}: {fix}")));
    }
    // Both kinds of glTF may have either extension.
    let is_gltf = |extension: &str| ["gltf", "glb"].contains(&extension);
    if is_gltf(extension) && !begins(b"{") && !begins(b"glTF") {
        return Err(FileError::whole("the file is no glTF, which begins with `{` or, in a binary file, with `glTF`"));
    }
    if is_vtk(extension) && !may_be_vtk && !begins(b"# vtk DataFile") && !begins(b"<VTKFile") {
        return Err(FileError::whole(
            "the file is no VTK, which begins with `# vtk DataFile` or, in XML, with `<?xml` or `<VTKFile`",
        ));
    }
    let is_same = |is_one: &dyn Fn(&str) -> bool, other: &str| is_one(other) && is_one(extension);
    let fits = |other: &str| other == extension || is_same(&is_gltf, other) || is_same(&is_vtk, other);
    match MODELS.iter().find(|(magic, ..)| begins(magic)) {
        Some((_, what, other)) if !fits(other) => Err(FileError::whole(format!(
            "the file is {what}, and its extension is .{extension}: rename it to .{other}"
        ))),
        _ => Ok(()),
    }
}
