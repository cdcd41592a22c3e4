//! Textures that another description draws from a camera of its own, such as shadow maps:
//! `--texture shadow=rendered:FILE,camera=…,size=…,uniform=…`. `effect:NAME` instead of the file is an effect of the program.
//!
//! Input: the text of an option. Output: the description, the camera, the size and values of uniforms, or a message.

use super::camera::CameraRequest;
use super::effects::{self, Effect};
use super::output::Failure;
use super::view::{View, size};

/// What precedes the description.
const PREFIX: &str = "rendered:";

/// What precedes the name of an effect of the program in a description.
const EFFECT: &str = "effect:";

/// A texture that another description draws.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct RenderedTexture {
    /// The name in the description that reads it.
    pub(crate) name: String,
    /// The key of a technique, the file of a description, or `effect:` and the name of an effect.
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

    /// Returns the effect of the program that draws the texture; `None`: a technique or a file.
    pub(crate) fn effect(&self) -> Result<Option<&'static Effect>, Failure> {
        let name = self.description.strip_prefix(EFFECT);
        let effect = name.map(effects::parse).transpose();
        effect.map_err(|message| Failure::Usage(format!("`--texture {}`: {message}", self.name)))
    }

    /// Returns the file of the description in the source of a texture; `None`: it is no file.
    pub(crate) fn file(source: &str) -> Option<&str> {
        let description = source.strip_prefix(PREFIX)?.split(',').next()?;
        (!description.starts_with(EFFECT)).then_some(description)
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
                // Also a uniform of the name `camera` or `size`.
                _ => uniforms.push((option.strip_prefix("uniform.").unwrap_or(&option).to_owned(), value)),
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
        assert_eq!((RenderedTexture::file(source), RenderedTexture::file("map.png")), (Some("map.fragbuf"), None));
        for wrong in ["rendered:", "rendered:a", "rendered:a,size=2x2", "rendered:a,camera=up", "rendered:a,4"] {
            assert!(RenderedTexture::parse("shadow", wrong).unwrap().is_err(), "{wrong}");
        }
    }

    #[test]
    fn effects_are_descriptions() {
        let of = |name: &str| {
            let source = format!("rendered:effect:{name},camera=auto");
            assert_eq!(RenderedTexture::file(&source), None);
            RenderedTexture::parse("shadow", &source).and_then(Result::ok).unwrap().effect()
        };
        assert!(of("midpoint").is_ok_and(|effect| effect.is_some_and(|effect| effect.name == "midpoint")));
        let Err(Failure::Usage(message)) = of("midpoints") else { panic!("an effect of this name") };
        assert!(message.contains("--texture shadow") && message.contains("did you mean `midpoint`?"), "{message}");
    }
}
