//! Warnings about limits of WebGPU: portable WGSL that no device without further requests can run.
//!
//! Input: a generation, and the manifests of the other buffers in the same shader. Output: one warning per limit that is exceeded,
//! with the numbers.

use std::path::Path;

use fragbuf::{Generation, Limit, Needed, Sharing, source_file};
use serde_json::Value;

use super::output::{self, Failure};

/// The limits in the manifest of another buffer: name and number.
pub(super) struct OtherLimits {
    file: String,
    numbers: Vec<(String, u64)>,
}

/// Reads the limits of a manifest. Formulas are left out, and limits that WebGPU does not have.
pub(super) fn read(path: &Path) -> Result<OtherLimits, Failure> {
    let file = path.display().to_string();
    let text = source_file::read(path).map_err(|error| Failure::files(path, &error))?;
    let unknown =
        |what: &str| Failure::Usage(format!("`{file}` {what}: `--with` needs a manifest.json of `fragbuf generate`"));
    let manifest: Value = serde_json::from_str(&text).map_err(|error| unknown(&format!("is not JSON ({error})")))?;
    let limits = manifest["limits"].as_array().ok_or_else(|| unknown("has no `limits`"))?;
    let number = |limit: &Value| Some((limit["webgpu"].as_str()?.to_owned(), limit["needed"].as_u64()?));
    Ok(OtherLimits { numbers: limits.iter().filter_map(number).collect(), file })
}

/// Warns about limits that portable WGSL exceeds, alone or with the other buffers.
pub(super) fn warn(generation: &Generation, group: u32, others: &[OtherLimits]) {
    let portable = generation.plans.iter().filter(|planned| planned.targets.iter().any(|target| target.name == "wgsl"));
    for planned in portable {
        for limit in fragbuf::limits(&planned.plan, group, &planned.workgroups) {
            if let Some(warning) = warning(&limit, others) {
                output::warn(&warning);
            }
        }
    }
}

fn warning(limit: &Limit, others: &[OtherLimits]) -> Option<String> {
    let (Needed::Number(own), Some(webgpu)) = (&limit.needed, limit.webgpu) else { return None };
    let other =
        |other: &OtherLimits| other.numbers.iter().find(|(name, _)| name == webgpu.name).map(|(_, number)| *number);
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
