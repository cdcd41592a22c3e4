//! An animated PNG: frames of one size, each shown for the same time, again and again.
//!
//! The file is written beside its final place and renamed after the last frame, so an error leaves a former file as it was. A frame is
//! encoded from memory: the streams of the crate `png` do not write valid frames.

use std::fs::{self, File};
use std::io::BufWriter;
use std::path::{Path, PathBuf};

use super::output::Failure;
use super::picture::{byte, encoder};

/// An animated PNG that is being written.
pub(crate) struct AnimatedImage {
    path: PathBuf,
    size: (u32, u32),
    frames: u32,
    /// Milliseconds from one frame to the next.
    delay: u16,
    linear: bool,
    /// `None` before the first frame.
    file: Option<PartialFile>,
}

/// The file of an animation that lacks frames. Dropping it removes the file.
struct PartialFile {
    path: PathBuf,
    /// The final place, which is `path` itself for a device or a link.
    target: PathBuf,
    /// `None` after the last frame.
    writer: Option<png::Writer<BufWriter<File>>>,
    is_finished: bool,
}

impl AnimatedImage {
    /// Returns an animation of `frames` frames, which are shown for `delay` milliseconds each. No file exists before the first frame.
    pub(crate) fn new(path: &Path, size: (u32, u32), frames: u32, delay: u16, linear: bool) -> Self {
        AnimatedImage { path: path.to_owned(), size, frames, delay, linear, file: None }
    }

    /// Writes a frame. The pixels are those of [`super::picture::write`].
    pub(crate) fn append(&mut self, pixels: &mut dyn Iterator<Item = [f32; 4]>) -> Result<(), Failure> {
        let file = match &mut self.file {
            Some(file) => file,
            none => none.insert(PartialFile::create(&self.path, self.size, (self.frames, self.delay), self.linear)?),
        };
        let (width, height) = self.size;
        let mut bytes = Vec::new();
        let count = 4 * width as usize * height as usize;
        let out_of_memory =
            |_| Failure::Device(format!("out of memory for a frame of {count} bytes: use a smaller image"));
        bytes.try_reserve_exact(count).map_err(out_of_memory)?;
        bytes.extend(pixels.flatten().map(byte));
        match &mut file.writer {
            Some(writer) => writer.write_image_data(&bytes).map_err(|error| failure(&file.path, &error)),
            None => Ok(()),
        }
    }

    /// Finishes the file after the last frame.
    pub(crate) fn finish(self) -> Result<(), Failure> {
        self.file.map_or(Ok(()), PartialFile::finish)
    }
}

impl PartialFile {
    fn create(target: &Path, size: (u32, u32), (frames, delay): (u32, u16), linear: bool) -> Result<Self, Failure> {
        let is_special = fs::symlink_metadata(target).is_ok_and(|found| !found.is_file());
        let mut path = target.to_owned();
        if !is_special {
            path.as_mut_os_string().push(".partial");
        }
        let file = File::create(&path).map_err(|error| Failure::files(&path, &error))?;
        let mut partial = PartialFile { path, target: target.to_owned(), writer: None, is_finished: false };
        let mut encoder = encoder(BufWriter::new(file), size, linear);
        let animated = encoder.set_animated(frames, 0).and_then(|()| encoder.set_frame_delay(delay, 1000));
        let writer = animated.and_then(|()| encoder.write_header());
        partial.writer = Some(writer.map_err(|error| failure(&partial.path, &error))?);
        Ok(partial)
    }

    fn finish(mut self) -> Result<(), Failure> {
        if let Some(writer) = self.writer.take() {
            writer.finish().map_err(|error| failure(&self.path, &error))?;
        }
        if self.path != self.target {
            fs::rename(&self.path, &self.target).map_err(|error| Failure::files(&self.target, &error))?;
        }
        self.is_finished = true;
        Ok(())
    }
}

impl Drop for PartialFile {
    fn drop(&mut self) {
        if !self.is_finished && self.path != self.target {
            // The error that ends the animation is reported.
            let _ = fs::remove_file(&self.path);
        }
    }
}

fn failure(path: &Path, error: &png::EncodingError) -> Failure {
    Failure::Files(format!("{}: {error}", path.display()))
}
