//! Buffers that share a shader: their limits of WebGPU, their names and their bind groups.
//!
//! Input: a generation, and the manifests of the other buffers in the same shader. Output: one warning per limit that is exceeded,
//! with the numbers, and an error if two buffers have the same names.

use std::path::Path;

use fragbuf::{Form, Generation, Limit, Needed, Sharing, source_file};
use serde_json::Value;

use super::output::{self, Failure};

/// The manifest of another buffer in the same shader.
pub(super) struct OtherBuffer {
    file: String,
    /// Its bind group; `None` if it binds nothing.
    group: Option<u64>,
    /// Its prefix; `None` in the manifest of an earlier version.
    prefix: Option<String>,
    /// Its limits: name and number.
    numbers: Vec<(String, u64)>,
}

/// Reads a manifest. Limits that are formulas are left out, and those that WebGPU does not have.
pub(super) fn read(path: &Path) -> Result<OtherBuffer, Failure> {
    let file = path.display().to_string();
    let text = source_file::read(path).map_err(|error| Failure::files(path, &error))?;
    let unknown =
        |what: &str| Failure::Usage(format!("`{file}` {what}: `--with` needs a manifest.json of `fragbuf generate`"));
    let manifest: Value = serde_json::from_str(&text).map_err(|error| unknown(&format!("is not JSON ({error})")))?;
    let limits = manifest["limits"].as_array().ok_or_else(|| unknown("has no `limits`"))?;
    let number = |limit: &Value| Some((limit["webgpu"].as_str()?.to_owned(), limit["needed"].as_u64()?));
    let resources = manifest["resources"].as_array().into_iter().flatten();
    Ok(OtherBuffer {
        group: resources.filter_map(|resource| resource["group"].as_u64()).next(),
        prefix: manifest["prefix"].as_str().map(str::to_owned),
        numbers: limits.iter().filter_map(number).collect(),
        file,
    })
}

/// Checks that a buffer can be in the same shader as others: its names differ. Warns if its bindings do not.
pub(super) fn check_names(form: Form, prefix: &str, group: u32, others: &[OtherBuffer]) -> Result<(), Failure> {
    for other in others {
        let has_prefix = other.prefix.as_deref() == Some(prefix);
        let has_group = other.group == Some(u64::from(group));
        let file = &other.file;
        if has_prefix && (has_group || form == Form::Module) {
            let name = if prefix.is_empty() { "no prefix".to_owned() } else { format!("the prefix `{prefix}`") };
            let bindings = if has_group { format!(" and the bind group {group}") } else { String::new() };
            let fix = if has_group { "another `--prefix` and another `--group`" } else { "another `--prefix`" };
            return Err(Failure::Usage(format!(
                "the buffer of {file} also has {name}{bindings}, so both declare the same names: give one of them {fix}"
            )));
        }
        if has_group {
            output::warn(&format!(
                "the buffer of {file} also has the bind group {group}, so their bindings have the same numbers: give one of them \
                 another `--group`"
            ));
        }
    }
    Ok(())
}

/// Warns about limits that portable WGSL exceeds, alone or with the other buffers, and about equal numbers in OpenGL, which has no groups.
pub(super) fn warn(generation: &Generation, group: u32, others: &[OtherBuffer]) {
    let mut targets = generation.plans.iter().flat_map(|planned| &planned.targets);
    if let (Some(target), Some(_)) = (targets.find(|target| target.api.0.starts_with("opengl")), others.first()) {
        output::warn(&format!(
            "in {} all buffers have the same binding numbers: number the blocks and textures of one again after linking, by \
             `glShaderStorageBlockBinding`, `glUniformBlockBinding` and `glUniform1i`",
            target.name
        ));
    }
    let portable = generation.plans.iter().filter(|planned| planned.targets.iter().any(|target| target.name == "wgsl"));
    for planned in portable {
        for limit in fragbuf::limits(&planned.plan, group, &planned.workgroups) {
            if let Some(warning) = warning(&limit, others) {
                output::warn(&warning);
            }
        }
    }
}

fn warning(limit: &Limit, others: &[OtherBuffer]) -> Option<String> {
    let (Needed::Number(own), Some(webgpu)) = (&limit.needed, limit.webgpu) else { return None };
    let other =
        |other: &OtherBuffer| other.numbers.iter().find(|(name, _)| name == webgpu.name).map(|(_, number)| *number);
    let shared: Vec<u64> = others.iter().filter_map(other).collect();
    let needed = match limit.sharing {
        Sharing::Sum => shared.iter().fold(*own, |sum, number| sum.saturating_add(*number)),
        Sharing::Greatest => shared.iter().fold(*own, |most, number| most.max(*number)),
    };
    if needed <= webgpu.default {
        return None;
    }
    let with = match others {
        [] => String::new(),
        others => {
            format!(" together with {}", others.iter().map(|other| other.file.as_str()).collect::<Vec<_>>().join(", "))
        }
    };
    Some(format!(
        "a device needs `{}` of {needed}{with}, and WebGPU devices have {} unless the program requests more: request the limit, or use \
         separate shaders and fewer buffers",
        webgpu.name, webgpu.default
    ))
}
