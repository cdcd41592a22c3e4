//! Parses `--camera` and places the camera.
//!
//! Input: `auto`, `clip`, `orbit:AZIMUTH,ELEVATION` or `eye:X,Y,Z`; the last two may be followed by fields such as `fov:30` or `zoom:2`.
//! Output: a camera for scenes. No form needs quotes in a shell.

use std::str::FromStr;

use fragbuf_scene::{Camera, CameraError, FIELD_OF_VIEW, Scene};

/// The value of `--camera`. Angles are in degrees, points in the coordinates of the model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum CameraRequest {
    /// A three-quarter view of the whole scene.
    Auto,
    /// Positions are clip-space positions.
    Clip,
    /// A view of the whole scene from an azimuth and an elevation.
    Orbit { angles: [f64; 2], field_of_view: f64, zoom: f64 },
    /// A view from a point to another, the centre of the scene if there is none.
    Eye { eye: [f64; 3], target: Option<[f64; 3]>, field_of_view: f64, zoom: f64 },
}

/// The fields of view that a projection of 32 bits represents.
const FIELDS_OF_VIEW: std::ops::RangeInclusive<f64> = 0.1..=179.0;

/// The magnifications.
const ZOOMS: std::ops::RangeInclusive<f64> = 0.01..=1000.0;

const FORMS: &str = "write auto, clip, orbit:AZIMUTH,ELEVATION or eye:X,Y,Z; the last two also with a field of view and a zoom, as \
                     orbit:30,20,fov:50,zoom:2, and eye with a target, as eye:0,1,4,target:0,0,0";

impl CameraRequest {
    /// Returns the camera for a frame with this aspect, width over height.
    pub(crate) fn place(&self, scenes: &[&Scene], aspect: f32) -> Result<Camera, CameraError> {
        match *self {
            CameraRequest::Auto => Ok(Camera::framing(scenes, aspect)),
            CameraRequest::Clip => Ok(Camera::clip()),
            CameraRequest::Orbit { angles, field_of_view, zoom } => {
                Ok(Camera::orbit(scenes, aspect, angles, field_of_view).magnified(zoom))
            }
            CameraRequest::Eye { eye, target, field_of_view, zoom } => {
                let camera = Camera::looking(scenes, f64::from(aspect), (eye, target), field_of_view)?;
                Ok(camera.magnified(zoom))
            }
        }
    }

    /// Returns the view after an orbit of so many degrees around the scene; `None` for views that do not frame the scene.
    pub(crate) fn turned(self, degrees: f64) -> Option<Self> {
        let (angles, field_of_view, zoom) = match self {
            CameraRequest::Auto => (Camera::framing_angles(), FIELD_OF_VIEW, 1.0),
            CameraRequest::Orbit { angles, field_of_view, zoom } => (angles, field_of_view, zoom),
            CameraRequest::Clip | CameraRequest::Eye { .. } => return None,
        };
        let [azimuth, elevation] = angles;
        Some(CameraRequest::Orbit { angles: [azimuth + degrees, elevation], field_of_view, zoom })
    }
}

impl FromStr for CameraRequest {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        match text {
            "auto" => return Ok(CameraRequest::Auto),
            "clip" => return Ok(CameraRequest::Clip),
            _ => {}
        }
        let mut fields = fields(text)?;
        let field_of_view = match take(&mut fields, "fov")? {
            None => FIELD_OF_VIEW,
            Some([degrees]) if FIELDS_OF_VIEW.contains(&degrees) => degrees,
            Some([degrees]) => return Err(format!("`fov:{degrees}`: the field of view is from 0.1 to 179 degrees")),
        };
        let zoom = match take(&mut fields, "zoom")? {
            None => 1.0,
            Some([zoom]) if ZOOMS.contains(&zoom) => zoom,
            Some([zoom]) => return Err(format!("`zoom:{zoom}`: the image is magnified by 0.01 to 1000")),
        };
        let request = match (take(&mut fields, "orbit")?, take(&mut fields, "eye")?) {
            (Some([_, elevation]), None) if !(-90.0..=90.0).contains(&elevation) => {
                return Err(format!("the elevation {elevation} is not from -90 to 90 degrees"));
            }
            (Some(angles), None) => CameraRequest::Orbit { angles, field_of_view, zoom },
            (None, Some(eye)) => {
                let target = take(&mut fields, "target")?;
                if target == Some(eye) {
                    return Err(CameraError::NoDirection.to_string());
                }
                CameraRequest::Eye { eye, target, field_of_view, zoom }
            }
            _ => return Err(FORMS.to_owned()),
        };
        match fields.first() {
            None => Ok(request),
            Some((name, _)) => Err(format!("unknown or repeated field `{name}`: {FORMS}")),
        }
    }
}

/// Splits `name:1,2,name:3` into fields.
fn fields(text: &str) -> Result<Vec<(&str, Vec<f64>)>, String> {
    let mut fields: Vec<(&str, Vec<f64>)> = Vec::new();
    for item in text.split(',') {
        let number = match item.split_once(':') {
            Some((name, number)) => {
                fields.push((name.trim(), Vec::new()));
                number
            }
            None => item,
        };
        let (_, numbers) = fields.last_mut().ok_or(FORMS)?;
        let value = number.trim().parse().ok().filter(|value: &f64| value.is_finite());
        numbers.push(value.ok_or_else(|| format!("`{}` is not a finite number: {FORMS}", number.trim()))?);
    }
    Ok(fields)
}

/// Removes the first field of this name and returns its numbers.
fn take<const COUNT: usize>(fields: &mut Vec<(&str, Vec<f64>)>, name: &str) -> Result<Option<[f64; COUNT]>, String> {
    let Some(index) = fields.iter().position(|(field, _)| *field == name) else { return Ok(None) };
    let (_, numbers) = fields.remove(index);
    let plural = if COUNT == 1 { "" } else { "s" };
    let count = numbers.len();
    let numbers = <[f64; COUNT]>::try_from(numbers);
    numbers.map(Some).map_err(|_| format!("`{name}` takes {COUNT} number{plural}, not {count}: {FORMS}"))
}
