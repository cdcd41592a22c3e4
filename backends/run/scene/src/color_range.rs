//! The range of the colours of a model's vertices. The formats have numbers from 0 to 1; some tools write numbers from 0 to 255.

use crate::error::FilePosition;
use crate::warnings::{FileWarnings, Message, WarningKind};

/// A number above this means that the numbers are from 0 to 255.
const BYTES: f32 = 2.0;

/// The greatest number that is kept, so that all have a finite `f32`.
const GREATEST: f64 = 1.0e9;

/// The numbers of the colours so far.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct ColorRange {
    /// The greatest red, green or blue, and the greatest alpha.
    greatest: (f32, f32),
    /// The first number that is not from 0 to 1, and its position.
    first: Option<(f64, FilePosition)>,
    /// The position of the first colour.
    position: Option<FilePosition>,
    /// The number in the file that is 1 here.
    one: f64,
}

impl ColorRange {
    /// Returns the range of numbers that were divided by `one`, the greatest number of their type in the file.
    pub(crate) fn of_numbers_to(one: f64) -> Self {
        ColorRange { one, ..ColorRange::default() }
    }

    /// Returns a colour as it is in the file, which [`ColorRange::apply`] will change.
    pub(crate) fn add(&mut self, color: [f64; 4], position: FilePosition) -> [f32; 4] {
        let outside = color.iter().copied().find(|value| !(0.0..=1.0).contains(value));
        self.first = self.first.or(outside.map(|value| (value, position)));
        self.position = self.position.or(Some(position));
        let color = color.map(|value| value.clamp(-GREATEST, GREATEST) as f32);
        let [r, g, b, alpha] = color;
        self.greatest = (self.greatest.0.max(r).max(g).max(b), self.greatest.1.max(alpha));
        color
    }

    /// Changes all colours that were added to numbers from 0 to 1, with a warning if this changes any.
    pub(crate) fn apply<'c>(self, colors: impl Iterator<Item = &'c mut [f32; 4]>, warnings: FileWarnings<'_>) {
        // Integers of 16 and 32 bits are often from 0 to 255, too.
        let greatest = f64::from(self.greatest.0) * self.one;
        if let Some(position) = self.position.filter(|_| self.one > 255.0 && greatest > 0.0 && greatest < 255.5) {
            // The number in the file, which rounding may have changed.
            let number = |channel: f32| (f64::from(channel) * self.one).round();
            for [r, g, b, _] in colors {
                [r, g, b].into_iter().for_each(|channel| *channel = (number(*channel) / 255.0).clamp(0.0, 1.0) as f32);
            }
            let message = "colours of vertices are from 0 to 255, although their type has greater numbers".to_owned();
            warnings.add(WarningKind::OutOfRange, "colours", || (position, message));
            return;
        }
        let Some((value, position)) = self.first else { return };
        let scale = |greatest: f32| if greatest > BYTES { 1.0 / 255.0 } else { 1.0 };
        let (color, alpha) = (scale(self.greatest.0), scale(self.greatest.1));
        for channels in colors {
            let [r, g, b, a] = *channels;
            *channels = [r * color, g * color, b * color, a * alpha].map(|channel| channel.clamp(0.0, 1.0));
        }
        let change = if color.min(alpha) < 1.0 { "all are divided by 255" } else { "it is clamped" };
        let message = Message::new(format!("a colour of a vertex, {value}, is not from 0 to 1"), change);
        warnings.add(WarningKind::OutOfRange, "colours", || (position, message));
    }
}
