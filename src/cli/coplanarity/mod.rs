//! Fragment coplanarity: how many fragments of a pixel have equal depths (D13, Fig. 13).
//!
//! Input: the view of a scene. Output: two counts per pixel, C_p, and a heat map in the paper's colours. An A-buffer whose effect counts runs on
//! the device of the command, so nothing here rasterises. All fragments of the scene take part: constraints of a description do not.
//!
//! D13 calls C_p "the average probability for a pixel p to suffer from fragment coplanarity when rendering with the F2B". F2B keeps one
//! fragment per depth, so a pixel suffers if two or more of its fragments have equal depths, and loses the others. Pixels without fragments have
//! nothing to lose. So C_p is the number of pixels with fragments of equal depths over the number of pixels with fragments. Depths are equal if
//! all of their 32 bits are, as for a depth test of floats.

use super::input::Input;
use super::output::Failure;
use super::progress::Progress;
use super::rendering::{DeviceSelection, RenderRequest, render_quietly, select};
use super::view::{SceneView, View};

/// The coplanarity of the pixels of a view.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Coplanarity {
    /// Row after row; `None`: the pixel has no fragment.
    pixels: Vec<Option<PixelCoplanarity>>,
    /// The fragments of the view.
    pub(crate) fragments: u64,
}

/// The fragments of a pixel that have the depth of another one.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct PixelCoplanarity {
    /// All of them: the paper's total fragment coplanarity, which is 0 or at least 2.
    shared: u32,
    /// All but one of each depth.
    missed: u32,
}

/// The frame that counts.
const REQUEST: RenderRequest<'static> = RenderRequest { count_all: true, ..RenderRequest::new("coplanarity") };

fn input() -> Input {
    Input::text(REQUEST.description, include_str!("coplanarity.fragbuf"))
}

impl Coplanarity {
    /// Counts the fragments of a view on the device that `--device` selects.
    pub(crate) fn measure(view: &View, scene: &SceneView, progress: &Progress) -> Result<Self, Failure> {
        let mut selection = select(view, scene, &mut [(&REQUEST, &mut input())])?;
        Coplanarity::measure_on((view, &mut selection), scene, progress)
    }

    /// Counts the fragments of a view on a selected device.
    pub(crate) fn measure_on(
        (view, selection): (&View, &mut DeviceSelection),
        scene: &SceneView,
        progress: &Progress,
    ) -> Result<Self, Failure> {
        // The description has no attribute that the command line could set.
        let mut view = view.clone();
        view.attributes.clear();
        let result = render_quietly(&REQUEST, &mut input(), (&view, selection), scene, progress)?;
        let counters = result.stats.counters.as_ref();
        let (generated, lost) = counters.map_or((0, 0), |all| (all.get("generated"), all.lost()));
        if lost > 0 {
            return Err(Failure::Device(format!(
                "{lost} fragments do not fit into the pixels that count them: use a larger image, or a scene of fewer layers"
            )));
        }
        let pixels = result.stats.pixels.iter().map(|pixel| PixelCoplanarity::of_channels(*pixel)).collect();
        Ok(Coplanarity { pixels, fragments: generated.into() })
    }

    /// Returns the pixels with fragments.
    pub(crate) fn covered(&self) -> u64 {
        self.covered_pixels().count() as u64
    }

    /// Returns the pixels with fragments of equal depths.
    pub(crate) fn coplanar(&self) -> u64 {
        self.covered_pixels().filter(|pixel| pixel.shared > 0).count() as u64
    }

    /// Returns C_p, from 0 to 1; 0 without fragments.
    pub(crate) fn probability(&self) -> f64 {
        self.coplanar() as f64 / self.covered().max(1) as f64
    }

    /// Returns the fragments that a method with one fragment per depth and pixel does not miss.
    #[cfg(feature = "figures")]
    pub(crate) fn depths(&self) -> u64 {
        self.fragments.saturating_sub(self.covered_pixels().map(|pixel| u64::from(pixel.missed)).sum())
    }

    /// Returns the pixels with fragments by their number of fragments that share a depth: element `i` is the number of pixels with `i`.
    pub(crate) fn histogram(&self) -> Vec<u64> {
        let mut bins = Vec::new();
        for PixelCoplanarity { shared, .. } in self.covered_pixels() {
            let bin = shared as usize;
            bins.resize(bins.len().max(bin + 1), 0);
            if let Some(count) = bins.get_mut(bin) {
                *count += 1;
            }
        }
        bins
    }

    /// Returns the heat map: the colours of [`COLORS`], and white where no fragment is, as sRGB values from 0 to 1.
    pub(crate) fn heat(&self) -> impl Iterator<Item = [f32; 4]> {
        let color = |pixel: &Option<PixelCoplanarity>| pixel.map_or([0xff; 3], |pixel| color(pixel.shared));
        self.pixels.iter().map(move |pixel| {
            let [r, g, b] = color(pixel).map(|channel| f32::from(channel) / 255.0);
            [r, g, b, 1.0]
        })
    }

    fn covered_pixels(&self) -> impl Iterator<Item = PixelCoplanarity> {
        self.pixels.iter().copied().flatten()
    }
}

impl PixelCoplanarity {
    /// Returns the numbers that the effect of the description divides among the channels.
    fn of_channels([shared, shared_high, missed, missed_high]: [f32; 4]) -> Option<Self> {
        let number = |low: f32, high: f32| low as u32 + 1024 * high as u32;
        let is_covered = missed_high >= 1.0;
        is_covered.then(|| PixelCoplanarity {
            shared: number(shared, shared_high),
            missed: number(missed, missed_high - 1.0),
        })
    }
}

/// The colours of D13, Fig. 13, with the least number of fragments that they stand for. The last stands for more, too.
pub(crate) const COLORS: [(u32, &str, [u8; 3]); 9] = [
    (0, "gray", [0x80, 0x80, 0x80]),
    (2, "red", [0xff, 0x00, 0x00]),
    (3, "blue", [0x00, 0x00, 0xff]),
    (4, "green", [0x00, 0x80, 0x00]),
    (5, "cyan", [0x00, 0xff, 0xff]),
    (6, "aquamarine", [0x7f, 0xff, 0xd4]),
    (7, "fuchsia", [0xff, 0x00, 0xff]),
    (8, "yellow", [0xff, 0xff, 0x00]),
    (9, "brown", [0xa5, 0x2a, 0x2a]),
];

/// Returns the colour of a number of fragments.
fn color(shared: u32) -> [u8; 3] {
    COLORS.iter().rev().find(|(least, ..)| *least <= shared).map_or([0xff; 3], |(.., color)| *color)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(pixels: &[Option<(u32, u32)>], fragments: u64) -> Coplanarity {
        let pixel = |(shared, missed)| PixelCoplanarity { shared, missed };
        Coplanarity { pixels: pixels.iter().map(|found| found.map(pixel)).collect(), fragments }
    }

    #[test]
    fn pixels_without_fragments_do_not_take_part() {
        // Depths: none; 1; 1 1; 1 1 1 2; 1 1 2 2.
        let found = of(&[None, Some((0, 0)), Some((2, 1)), Some((3, 2)), Some((4, 2))], 11);
        assert_eq!((found.covered(), found.coplanar(), found.depths()), (4, 3, 6));
        assert_eq!(found.probability(), 0.75);
        assert_eq!(found.histogram(), [1, 0, 1, 1, 1]);
        assert_eq!((of(&[None], 0).probability(), of(&[None], 0).histogram()), (0.0, Vec::new()));
    }

    #[test]
    fn colors_are_those_of_the_paper() {
        let names = |shared: u32| COLORS.iter().find(|row| row.2 == color(shared)).map(|row| row.1);
        let expected = ["gray", "red", "blue", "green", "cyan", "aquamarine", "fuchsia", "yellow", "brown"];
        let found: Vec<&str> = [0, 2, 3, 4, 5, 6, 7, 8, 9].into_iter().filter_map(names).collect();
        assert_eq!(found, expected);
        assert_eq!(names(400), Some("brown"));
        let found = of(&[None, Some((2, 1))], 2);
        assert_eq!(found.heat().collect::<Vec<_>>(), [[1.0; 4], [1.0, 0.0, 0.0, 1.0]]);
    }

    #[test]
    fn channels_hold_large_numbers() {
        let channels = |shared: u32, missed: u32| {
            [shared % 1024, shared / 1024, missed % 1024, missed / 1024 + 1].map(|channel| channel as f32)
        };
        for (shared, missed) in [(0, 0), (2, 1), (1023, 1000), (1024, 1023), (4096, 4095)] {
            let found = PixelCoplanarity::of_channels(channels(shared, missed));
            assert_eq!(found, Some(PixelCoplanarity { shared, missed }));
        }
        assert_eq!(PixelCoplanarity::of_channels([0.0; 4]), None);
    }
}
