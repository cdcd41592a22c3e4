//! The frames of an animation: views of the same scene from an orbit around it, each with an image of its own.

use std::path::{Path, PathBuf};

use fragbuf_frame::Decisions;

use super::animated_image::AnimatedImage;
use super::output::Failure;
use super::picture;
use super::view::View;

#[derive(clap::Args)]
pub(crate) struct Animation {
    /// Render so many frames, and print k, bytes and hit ratio of each. The number of a frame, from 0, follows the name in `--out`:
    /// `out.png` becomes `out-000.png` and so on
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=10_000))]
    frames: Option<u32>,
    /// Degrees by which the camera orbits the scene over all frames; the last is one step before the end
    #[arg(long, value_name = "DEGREES", default_value_t = 360.0, requires = "frames", allow_negative_numbers = true)]
    orbit: f64,
    /// Render as an application does that never waits for the device: a frame uses the k that the previous frame predicted. A k grows at
    /// once, and shrinks after eight frames that need less
    #[arg(long, requires = "frames")]
    lagged: bool,
    /// Write the frames to one animated PNG, `--out`, instead of numbered images
    #[arg(long, requires = "frames")]
    animated: bool,
    /// Milliseconds for which an animated PNG shows each frame
    #[arg(long, value_name = "MS", default_value_t = 100, requires = "animated", value_parser = clap::value_parser!(u16).range(1..))]
    delay: u16,
}

impl Animation {
    pub(crate) fn is_given(&self) -> bool {
        self.frames.is_some()
    }

    /// Returns the animated PNG for the frames of `views`, if there is to be one.
    pub(crate) fn image(&self, view: &View) -> Option<AnimatedImage> {
        let frames = self.frames.filter(|_| self.animated)?;
        Some(AnimatedImage::new(&view.out, view.size, frames, self.delay, view.linear))
    }

    /// Returns the view of each frame.
    pub(crate) fn views(&self, view: &View) -> Result<Vec<View>, Failure> {
        let frames = self.frames.unwrap_or(1);
        if !self.orbit.is_finite() {
            return Err(Failure::Usage("`--orbit` is not a finite number of degrees".to_owned()));
        }
        if picture::is_stdout(&view.out) {
            return Err(Failure::Usage(
                "`--frames` prints a line per frame on stdout: give a file to `--out`".to_owned(),
            ));
        }
        let step = self.orbit / f64::from(frames);
        let one = |number: u32| {
            let camera = view.camera.turned(f64::from(number) * step).ok_or_else(|| {
                let text = "`--frames` orbits the scene: use `--camera auto` or `--camera orbit:AZIMUTH,ELEVATION`";
                Failure::Usage(text.to_owned())
            })?;
            let mut one = view.clone();
            one.decisions = if self.lagged { Decisions::LAGGED } else { Decisions::Immediate };
            (one.camera, one.out, one.is_later_frame) = (camera, numbered(&view.out, number), number > 0);
            Ok(one)
        };
        (0..frames).map(one).collect()
    }
}

/// Returns `folder/name-007.png` for `folder/name.png`.
fn numbered(path: &Path, number: u32) -> PathBuf {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let extension = path.extension().map(|extension| format!(".{}", extension.to_string_lossy())).unwrap_or_default();
    path.with_file_name(format!("{stem}-{number:03}{extension}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_have_numbers() {
        assert_eq!(numbered(Path::new("a/b.png"), 7), Path::new("a/b-007.png"));
        assert_eq!(numbered(Path::new("b"), 1234), Path::new("b-1234"));
    }
}
