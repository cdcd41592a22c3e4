//! Parses `name=value` arguments of `--set`, `--uniform`, `--attribute` and `--texture`.

/// Parses `axis=value`, `axis.option=value` or `k=8`.
pub(crate) fn assignment(text: &str) -> Result<(String, String), String> {
    match text.split_once('=') {
        Some((name, value)) if !name.trim().is_empty() => Ok((name.trim().to_owned(), value.trim().to_owned())),
        _ => Err("write name=value: an axis (sort=none), an option (sync.limit=9), or k=8".to_owned()),
    }
}

/// Parses `name=value` of a uniform.
#[cfg(feature = "pictures")]
pub(crate) fn uniform(text: &str) -> Result<(String, String), String> {
    match text.split_once('=') {
        Some((name, value)) if !name.trim().is_empty() => Ok((name.trim().to_owned(), value.trim().to_owned())),
        _ => Err(
            "write name=value: a uniform of the description and its value, as `cut=0.5`, or `tint=1,0,0` for a vector"
                .to_owned(),
        ),
    }
}

/// Parses `name=value` of an attribute.
#[cfg(feature = "pictures")]
pub(crate) fn attribute(text: &str) -> Result<(String, String), String> {
    match text.split_once('=') {
        Some((name, value)) if !name.trim().is_empty() => Ok((name.trim().to_owned(), value.trim().to_owned())),
        _ => Err(
            "write name=value: an attribute of the fragments and its value, as `heat=0.3`, or `flow=0,1` for a vector"
                .to_owned(),
        ),
    }
}

/// Parses `name=source` of a texture.
#[cfg(feature = "pictures")]
pub(crate) fn texture(text: &str) -> Result<(String, String), String> {
    match text.split_once('=') {
        Some((name, source)) if !name.trim().is_empty() && !source.trim().is_empty() => {
            Ok((name.trim().to_owned(), source.trim().to_owned()))
        }
        _ => Err("write name=FILE: a texture of the description and an image, as `lut=colors.png`".to_owned()),
    }
}
