//! Opens a scene by its name: a path, or `builtin:…`.

use std::path::{Path, PathBuf};

use crate::error::{Error, FileError};
use crate::file::{beside, read};
use crate::limits::Budget;
use crate::warnings::{FileWarnings, Message, WarningKind, Warnings};
use crate::{
    AttributeRequest, BuiltinScene, Limits, Scene, Warning, foreign, gltf, normals, obj, placement, ply, text, vtk,
};

/// Opens the scene `name`. `color` is the colour of parts for which the model gives none: linear, straight alpha.
pub fn open(name: &str, color: [f32; 4], limits: &Limits) -> Result<Scene, Error> {
    open_with(name, color, &[], limits)
}

/// Opens a scene like [`open`], with attributes of its vertices. `Err`: it does not have one of them, which is not optional.
pub fn open_with(
    name: &str,
    color: [f32; 4],
    attributes: &[AttributeRequest],
    limits: &Limits,
) -> Result<Scene, Error> {
    let Some(builtin) = name.strip_prefix("builtin:") else {
        return load_with(Path::new(name), color, attributes, limits);
    };
    builtin.parse::<BuiltinScene>()?.generate_with(attributes, limits)
}

/// Loads a model: OBJ, PLY, glTF, GLB, or VTK (`.vtk`, `.vtu`) by its extension, optionally compressed as `.gz`.
pub fn load(path: &Path, color: [f32; 4], limits: &Limits) -> Result<Scene, Error> {
    load_with(path, color, &[], limits)
}

/// Loads a model like [`load`], with attributes of its vertices. `Err`: it does not have one of them. An OBJ has none.
pub fn load_with(
    path: &Path,
    color: [f32; 4],
    attributes: &[AttributeRequest],
    limits: &Limits,
) -> Result<Scene, Error> {
    let file = path.display().to_string();
    let name = file.to_lowercase();
    let plain = name.strip_suffix(".gz").unwrap_or(&name);
    let extension = Path::new(plain).extension().map(|extension| extension.to_string_lossy().into_owned());
    let extension = extension.as_deref().filter(|extension| EXTENSIONS.contains(extension));
    // What cannot be opened is the same error for every extension.
    let is_regular = std::fs::metadata(path).is_ok_and(|metadata| metadata.is_file());
    let Some(extension) = extension.or(Some("").filter(|_| !is_regular)) else {
        return Err(FileError::whole(
            "unknown extension: use .obj, .ply, .gltf, .glb, .vtk or .vtu, optionally with .gz",
        )
        .in_file(&file));
    };
    let (budget, warnings) = (Budget::with_attributes(limits, attributes), Warnings::default());
    let bytes = read(path, &budget)?;
    foreign::check(&bytes, extension).map_err(|error| error.in_file(&file))?;
    let (objects, attributes) = match extension {
        "obj" => {
            let folder = path.parent().unwrap_or(Path::new(""));
            let libraries =
                |statement: &str, line: usize| libraries(folder, (statement, line), warnings.in_file(&file), &budget);
            none_of(attributes).map_err(|error| error.in_file(&file))?;
            let model = obj::Model { bytes: &bytes, file: &file, libraries: &libraries, warnings: &warnings };
            (obj::parse(&model, color, &budget)?, Vec::new())
        }
        "ply" => {
            let bytes = text::without_mark(&bytes);
            let objects = ply::parse(bytes, (color, attributes), (&budget, warnings.in_file(&file)));
            objects.map_err(|error| error.in_file(&file))?
        }
        "vtk" | "vtu" => {
            let bytes = text::without_mark(&bytes);
            let objects = vtk::parse(bytes, (color, attributes), (&budget, warnings.in_file(&file)));
            objects.map_err(|error| error.in_file(&file))?
        }
        _ => gltf::parse(&bytes, path, (color, attributes), (&budget, warnings.in_file(&file)))?,
    };
    drop(bytes);
    let mut scene = placement::place(objects);
    scene.attributes = attributes;
    scene.warnings = warnings.into_list();
    scene.files = budget.files();
    if scene.triangles() == 0 {
        return Err(without_triangles(&file, &scene.warnings));
    }
    scene.objects.iter_mut().for_each(normals::complete);
    Ok(scene)
}

/// Checks that no attribute is required of a scene that has none.
fn none_of(attributes: &[AttributeRequest]) -> Result<(), FileError> {
    match attributes.iter().find(|request| !request.is_optional) {
        Some(request) => Err(FileError::MissingAttribute(request.clone(), Vec::new(), None)),
        None => Ok(()),
    }
}

/// Returns the error about a model without triangles. The first warning is the most likely reason.
fn without_triangles(file: &str, warnings: &[Warning]) -> Error {
    match warnings.first() {
        None => FileError::whole("the model has no triangles").in_file(file),
        Some(Warning { file, position, message, .. }) => {
            FileError::Malformed(*position, format!("the model has no triangles: {message}")).in_file(file)
        }
    }
}

/// The extensions of models. Without one of them a file is not opened.
const EXTENSIONS: [&str; 6] = ["obj", "ply", "gltf", "glb", "vtk", "vtu"];

/// The greatest number of parts that are removed from the end of a statement to find the name of its first library.
const MAX_PARTS: usize = 16;

/// The greatest number of libraries of a statement.
const MAX_LIBRARIES: usize = 64;

/// Returns the names and the bytes of the material libraries that a statement names. A file that does not exist is a warning.
fn libraries(
    folder: &Path,
    (statement, line): (&str, usize),
    warnings: FileWarnings<'_>,
    budget: &Budget,
) -> Result<Vec<(String, Vec<u8>)>, Error> {
    beside(folder, statement).map_err(|error| error.in_file(warnings.file()))?;
    if !budget.reads_named_files() {
        let name = text::without_comment(statement);
        warnings.line(WarningKind::NotRead, name, line, || {
            let message = format!("files that the model names are not read: {}", text::quoted(name));
            Message::new(message, "its materials have the default colour")
        });
        return Ok(Vec::new());
    }
    let mut found = Vec::new();
    let mut rest = statement;
    while !rest.is_empty() {
        let (path, after) = first_library(folder, rest);
        match path {
            Some(_) if found.len() == MAX_LIBRARIES => {
                let message = format!("more than {MAX_LIBRARIES} libraries in one statement");
                return Err(FileError::line(line, message).in_file(warnings.file()));
            }
            Some(path) => {
                let bytes = read(&path, budget)?;
                found.push((path.display().to_string(), bytes));
                rest = after;
            }
            None => {
                let name = text::without_comment(rest);
                warnings.line(WarningKind::MissingFile, name, line, || {
                    Message::new(format!("no file {}", text::quoted(name)), "its materials have the default colour")
                });
                break;
            }
        }
    }
    Ok(found)
}

/// Returns the path of the first library of a statement, and what follows its name. Names may contain spaces, and are separated by them; a
/// `#` may be part of a name or begin a comment: the longest part that names a file is a name. `None`: there is no such file.
fn first_library<'s>(folder: &Path, statement: &'s str) -> (Option<PathBuf>, &'s str) {
    let shorter = |name: &&'s str| {
        let end = name.rfind(|letter: char| letter.is_whitespace() || letter == '#')?;
        name.get(..end).map(str::trim_end)
    };
    let first_word = statement.split_whitespace().next();
    let names: Vec<&str> = std::iter::successors(Some(statement), shorter).take(MAX_PARTS).chain(first_word).collect();
    let as_written = names.iter().find_map(|name| Some((existing(folder, name)?, *name)));
    // A part before a space may be a whole path, so the shortest is first.
    let found =
        as_written.or_else(|| names.iter().rev().find_map(|name| Some((of_another_computer(folder, name)?, *name))));
    let Some((path, name)) = found else { return (None, "") };
    let rest = statement.get(name.len()..).unwrap_or_default().trim_start();
    (Some(path), if rest.starts_with('#') { "" } else { rest })
}

/// Returns the path of a library if there is such a file: its name as it is, or with the separators of Windows.
fn existing(folder: &Path, name: &str) -> Option<PathBuf> {
    let slashes = name.replace('\\', "/");
    [name, &slashes]
        .into_iter()
        .filter(|name| !name.is_empty())
        .map(|name| folder.join(name))
        .find(|path| is_file(path))
}

/// Returns the path of a library in the folder of the model, if its name is a path of another computer.
fn of_another_computer(folder: &Path, name: &str) -> Option<PathBuf> {
    let last = name.rsplit(['/', '\\']).next().filter(|last| !last.is_empty() && last.len() < name.len())?;
    Some(folder.join(last)).filter(|path| is_file(path))
}

fn is_file(path: &Path) -> bool {
    path.exists() && !path.is_dir()
}
