//! Parses `--uniform name=value[,value…]`, `name=camera`, `name=direction` and `name=texture.part`: values of a description's uniforms. The default is 0.
//!
//! Input: names and texts, the description, and the view that it is drawn with. Output: values, or a message with the types and names that the
//! description declares.

use fragbuf::Variant;
use fragbuf_frame::Value;
use fragbuf_model::{Diagnostic, Uniform, UniformType, codes, nearest_name};
use fragbuf_scene::Eye;

use super::output::{self, Failure};
use super::view::SceneView;

/// Checks the values by the types that the description declares, before a scene is loaded.
pub(crate) fn check(given: &[(String, String)], variant: &Variant) -> Result<(), Failure> {
    given.iter().try_for_each(|(name, text)| parse(name, text, variant).map(drop))
}

/// Returns the values for a view.
pub(crate) fn values(
    given: &[(String, String)],
    variant: &Variant,
    view: &SceneView,
) -> Result<Vec<(String, Value)>, Failure> {
    let value = |(name, text): &(String, String)| {
        let value = match parse(name, text, variant)? {
            Given::Value(value) => value,
            Given::Viewpoint(viewpoint) => Value::Vec3(viewpoint.value(name, view)?),
            Given::Texture(texture) => texture.value(name, view)?,
        };
        Ok((name.clone(), value))
    };
    given.iter().map(value).collect()
}

/// A value of the command line.
enum Given {
    Value(Value),
    Viewpoint(Viewpoint),
    Texture(TextureCamera),
}

/// A value of the camera of a texture that another description draws: `shadow.camera`, its position, and `shadow.x`, `.y`, `.z` and `.w`, the rows of
/// its matrix from the coordinates of the model to clip space.
struct TextureCamera {
    texture: String,
    part: &'static str,
}

/// The parts of such a camera, and their types.
const CAMERA_PARTS: [(&str, UniformType); 5] = [
    ("camera", UniformType::Vec3),
    ("x", UniformType::Vec4),
    ("y", UniformType::Vec4),
    ("z", UniformType::Vec4),
    ("w", UniformType::Vec4),
];

impl TextureCamera {
    fn value(&self, uniform: &str, view: &SceneView) -> Result<Value, Failure> {
        let TextureCamera { texture, part } = self;
        let camera = view.texture_cameras.iter().find(|(name, _)| name == texture).map(|(_, camera)| camera);
        let camera = camera.ok_or_else(|| {
            Failure::Usage(format!(
                "uniform `{uniform}`: no description draws the texture `{texture}`: write `--texture {texture}=rendered:FILE,camera=…`"
            ))
        })?;
        let placement = view.scene.placement;
        let Some(row) = ["x", "y", "z", "w"].iter().position(|name| name == part) else {
            return match camera.eye {
                Eye::At(eye) => Ok(Value::Vec3(placement.model_position(eye))),
                Eye::Along(_) => Err(Failure::Usage(format!(
                    "uniform `{uniform}` has no value: the camera of the texture `{texture}` is infinitely far away"
                ))),
            };
        };
        // A position of the model is `origin + unit * position`.
        let [x, y, z, w]: [f64; 4] = std::array::from_fn(|column| f64::from(camera.view_projection[4 * column + row]));
        let scaled = [x, y, z].map(|value| value / placement.unit);
        let moved: f64 = scaled.iter().zip(placement.origin).map(|(value, origin)| value * origin).sum();
        Ok(Value::Vec4([scaled[0], scaled[1], scaled[2], w - moved].map(|value| value as f32)))
    }
}

/// Returns the part of a texture's camera that a text names.
fn texture_camera(text: &str, variant: &Variant) -> Option<(TextureCamera, UniformType)> {
    let (texture, part) = text.split_once('.')?;
    let is_texture = variant.textures.iter().any(|known| known.name.value == texture);
    let (part, kind) = CAMERA_PARTS.into_iter().find(|(known, _)| *known == part && is_texture)?;
    Some((TextureCamera { texture: texture.to_owned(), part }, kind))
}

/// A value of the view, by its name.
#[derive(Clone, Copy)]
enum Viewpoint {
    /// The position of the camera, in the coordinates of the model.
    Camera,
    /// The unit vector from the centre of the scene to the camera.
    Direction,
}

/// The names of the values of a view, each a `vec3`.
const VIEWPOINTS: [(&str, Viewpoint); 2] = [("camera", Viewpoint::Camera), ("direction", Viewpoint::Direction)];

impl Viewpoint {
    fn value(self, uniform: &str, SceneView { scene, camera, .. }: &SceneView) -> Result<[f32; 3], Failure> {
        match (self, camera.eye) {
            (Viewpoint::Camera, Eye::At(eye)) => Ok(scene.placement.model_position(eye)),
            (Viewpoint::Camera, Eye::Along(_)) => Err(Failure::Usage(format!(
                "uniform `{uniform}` has no value: with `--camera clip` the camera is infinitely far away: write `--uniform \
                 {uniform}=direction` for the direction to it, or choose another camera"
            ))),
            (Viewpoint::Direction, Eye::At(eye)) => Ok(scene.direction_to(eye)),
            (Viewpoint::Direction, Eye::Along(ray)) => Ok(ray.map(|value| -value)),
        }
    }
}

/// Parses a value by the type that the description declares.
fn parse(name: &str, text: &str, variant: &Variant) -> Result<Given, Failure> {
    let Some(uniform) = variant.uniforms.iter().find(|uniform| uniform.name.value == *name) else {
        return Err(unknown("the description has no", name, "it has", &[variant]));
    };
    let kind = uniform.kind.value;
    let viewpoint = VIEWPOINTS.iter().find(|(word, _)| *word == text);
    if let Some((_, viewpoint)) = viewpoint.filter(|_| kind == UniformType::Vec3) {
        return Ok(Given::Viewpoint(*viewpoint));
    }
    if let Some((camera, wanted)) = texture_camera(text, variant) {
        let message = format!("`{text}` is the value of a {0}: declare `{name}: {0}`", wanted.keyword());
        return if kind == wanted { Ok(Given::Texture(camera)) } else { Err(Failure::Usage(message)) };
    }
    let words = VIEWPOINTS.map(|(word, _)| word);
    let help = match (viewpoint, nearest_name(text, &words)) {
        (Some(_), _) => format!("; `{text}` is the value of a vec3: declare `{name}: vec3`"),
        (None, Some(nearest)) if kind == UniformType::Vec3 => format!("; did you mean `{nearest}`?"),
        _ => String::new(),
    };
    read(text, kind)
        .map(Given::Value)
        .ok_or_else(|| Failure::Usage(format!("uniform `{name}` takes {}, not `{text}`{help}", expected(kind))))
}

/// Warns of uniforms that the description reads and `given` does not set, with the options that set them.
pub(crate) fn warn_unset(description: &str, given: &[(String, String)], variant: &Variant) {
    warn_unset_as(description, "--uniform ", given, variant);
}

/// Warns of them as [`warn_unset`] does. `option`: what precedes a name and its value where they are set.
pub(crate) fn warn_unset_as(description: &str, option: &str, given: &[(String, String)], variant: &Variant) {
    let prefix = option;
    let is_read = |uniform: &&Uniform| {
        let is_unread =
            |warning: &Diagnostic| warning.code == codes::UNUSED_UNIFORM && warning.span == uniform.name.span;
        !variant.warnings.iter().any(is_unread)
    };
    let is_set = |uniform: &Uniform| given.iter().any(|(name, _)| *name == uniform.name.value);
    let unset: Vec<&Uniform> = variant.uniforms.iter().filter(is_read).filter(|uniform| !is_set(uniform)).collect();
    let option = |uniform: &&Uniform| {
        let value = match uniform.kind.value {
            UniformType::F32 | UniformType::U32 | UniformType::I32 => "NUMBER",
            UniformType::Vec2 => "X,Y",
            UniformType::Vec3 => "X,Y,Z",
            UniformType::Vec4 => "X,Y,Z,W",
        };
        format!("{prefix}{}={value}", uniform.name.value)
    };
    let options: Vec<String> = unset.iter().map(option).collect();
    let names: Vec<String> = unset.iter().map(|uniform| format!("`{}`", uniform.name.value)).collect();
    let what = match names.as_slice() {
        [] => return,
        [one] => format!("the uniform {one} has no value and is 0: set it with"),
        several => format!("the uniforms {} have no values and are 0: set them with", several.join(", ")),
    };
    output::warn(&format!("{description}: {what} `{}`", options.join(" ")));
}

/// Returns the values for each of the descriptions that have the uniform. `Err`: none of them has it.
pub(crate) fn shared(
    given: &[(String, String)],
    variants: [&Variant; 2],
) -> Result<[Vec<(String, String)>; 2], Failure> {
    let has = |variant: &Variant, name: &str| variant.uniforms.iter().any(|uniform| uniform.name.value == name);
    if let Some((name, _)) = given.iter().find(|(name, _)| !variants.iter().any(|variant| has(variant, name))) {
        return Err(unknown("neither description has a", name, "they have", &variants));
    }
    Ok(variants.map(|variant| given.iter().filter(|(name, _)| has(variant, name)).cloned().collect()))
}

/// Returns the failure for a uniform that none of the descriptions has.
fn unknown(missing: &str, name: &str, they_have: &str, variants: &[&Variant]) -> Failure {
    let mut names: Vec<&str> = Vec::new();
    for uniform in variants.iter().flat_map(|variant| &variant.uniforms) {
        if !names.contains(&uniform.name.value.as_str()) {
            names.push(&uniform.name.value);
        }
    }
    // `u.cut`, as in closures.
    let plain = name.rsplit('.').next().unwrap_or(name);
    let known = match (nearest_name(plain, &names), names.is_empty()) {
        (_, true) => format!("{they_have} none"),
        (Some(nearest), false) => format!("did you mean `{nearest}`? {they_have} {}", names.join(", ")),
        (None, false) => format!("{they_have} {}", names.join(", ")),
    };
    Failure::Usage(format!("{missing} uniform `{name}`: {known}"))
}

fn read(text: &str, kind: UniformType) -> Option<Value> {
    let parts: Vec<&str> = text.split(',').map(str::trim).collect();
    let floats: Option<Vec<f32>> =
        parts.iter().map(|part| part.parse().ok().filter(|value: &f32| value.is_finite())).collect();
    match kind {
        UniformType::U32 => parts.first().filter(|_| parts.len() == 1)?.parse().ok().map(Value::U32),
        UniformType::I32 => parts.first().filter(|_| parts.len() == 1)?.parse().ok().map(Value::I32),
        UniformType::F32 => <[f32; 1]>::try_from(floats?).ok().map(|[value]| Value::F32(value)),
        UniformType::Vec2 => floats?.try_into().ok().map(Value::Vec2),
        UniformType::Vec3 => floats?.try_into().ok().map(Value::Vec3),
        UniformType::Vec4 => floats?.try_into().ok().map(Value::Vec4),
    }
}

fn expected(kind: UniformType) -> &'static str {
    match kind {
        UniformType::F32 => "one number",
        UniformType::U32 => "one whole number, 0 or more",
        UniformType::I32 => "one whole number",
        UniformType::Vec2 => "2 numbers, separated by commas",
        UniformType::Vec3 => "3 numbers, separated by commas, or `camera` or `direction`",
        UniformType::Vec4 => "4 numbers, separated by commas",
    }
}
