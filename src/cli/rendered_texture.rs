//! Textures that another description draws from a camera of its own, such as shadow maps:
//! `--texture shadow=rendered:FILE,camera=…,size=…,uniform=…`.
//!
//! Input: the text of an option. Output: the description, the camera, the size and values of uniforms, or a message.

use super::camera::CameraRequest;
use super::output::Failure;
use super::view::{View, size};

/// What precedes the description.
const PREFIX: &str = "rendered:";

/// A texture that another description draws.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct RenderedTexture {
    /// The name in the description that reads it.
    pub(crate) name: String,
    /// The key of a technique or the file of a description.
    pub(crate) description: String,
    pub(crate) camera: CameraRequest,
    pub(crate) size: (u32, u32),
    /// Values of uniforms of the description.
    pub(crate) uniforms: Vec<(String, String)>,
}

impl RenderedTexture {
    /// Parses the source of a texture; `None`: another source.
    pub(crate) fn parse(name: &str, source: &str) -> Option<Result<Self, Failure>> {
        Some(Self::parse_rest(name, source.strip_prefix(PREFIX)?).map_err(|message| {
            Failure::Usage(format!(
                "`--texture {name}`: {message}: write `{PREFIX}FILE.fragbuf,camera=orbit:30,60,size=512x512`"
            ))
        }))
    }

    /// Returns the rendered textures among those of a view.
    pub(crate) fn all(view: &View) -> Result<Vec<Self>, Failure> {
        view.textures.iter().filter_map(|(name, source)| RenderedTexture::parse(name, source)).collect()
    }

    fn parse_rest(name: &str, text: &str) -> Result<Self, String> {
        let (description, options) = text.split_once(',').unwrap_or((text, ""));
        if description.is_empty() {
            return Err("the description is missing".to_owned());
        }
        let (mut camera, mut pixels, mut uniforms) = (None, (512, 512), Vec::new());
        for (option, value) in options_of(options)? {
            match option.as_str() {
                "camera" => camera = Some(value.parse::<CameraRequest>()?),
                "size" => pixels = size(&value)?,
                _ => uniforms.push((option, value)),
            }
        }
        let camera = camera.ok_or("`camera` is missing")?;
        Ok(RenderedTexture {
            name: name.to_owned(),
            description: description.to_owned(),
            camera,
            size: pixels,
            uniforms,
        })
    }
}

/// Returns options and their values. A part without `=` continues the value before it, because cameras have commas.
fn options_of(text: &str) -> Result<Vec<(String, String)>, String> {
    let mut options: Vec<(String, String)> = Vec::new();
    for part in text.split(',').filter(|part| !part.is_empty()) {
        match (part.split_once('='), options.last_mut()) {
            (Some((name, value)), _) => options.push((name.to_owned(), value.to_owned())),
            (None, Some((_, value))) => {
                value.push(',');
                value.push_str(part);
            }
            (None, None) => return Err(format!("`{part}` is no option")),
        }
    }
    Ok(options)
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use super::*;

    #[test]
    fn cameras_have_commas() {
        let source = "rendered:map.fragbuf,camera=orbit:30,60,zoom:1.5,size=64x32,near=0.5,eye=1,2,3";
        let parsed = RenderedTexture::parse("shadow", source).and_then(Result::ok).unwrap();
        assert_eq!((parsed.description.as_str(), parsed.size), ("map.fragbuf", (64, 32)));
        let uniforms = [("near", "0.5"), ("eye", "1,2,3")].map(|(name, value)| (name.to_owned(), value.to_owned()));
        assert_eq!(parsed.uniforms, uniforms);
        assert_eq!(parsed.camera, "orbit:30,60,zoom:1.5".parse().unwrap());
        assert!(RenderedTexture::parse("shadow", "map.png").is_none());
        for wrong in ["rendered:", "rendered:a", "rendered:a,size=2x2", "rendered:a,camera=up", "rendered:a,4"] {
            assert!(RenderedTexture::parse("shadow", wrong).unwrap().is_err(), "{wrong}");
        }
    }
}
