//! `fragbuf compare`: renders a scene with two descriptions and measures the difference between the images. The image that it
//! writes is a heat map of the difference, from black (none) over red and yellow to white (the greatest difference).

use serde_json::json;

use super::assignment::{assignment, uniform};
use super::output::{self, Failure};
use super::picture;
use super::progress::Progress;
use super::rendering::{RenderRequest, render};
use super::statistics::{FragmentCounts, statistics};
use super::view::{View, scenes};

#[derive(clap::Args)]
#[command(after_help = scenes())]
pub(crate) struct Compare {
    /// Technique key or .fragbuf file
    first: String,
    /// Technique key or .fragbuf file to compare it with
    second: String,
    /// Change both descriptions: axis=value, axis.option=value or k=8
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = assignment)]
    set: Vec<(String, String)>,
    /// Change only the first description
    #[arg(long = "set-first", value_name = "NAME=VALUE", value_parser = assignment)]
    set_first: Vec<(String, String)>,
    /// Change only the second description
    #[arg(long = "set-second", value_name = "NAME=VALUE", value_parser = assignment)]
    set_second: Vec<(String, String)>,
    /// Set a uniform of both descriptions [default: 0]
    #[arg(long = "uniform", value_name = "NAME=VALUE[,VALUE]", value_parser = uniform)]
    uniforms: Vec<(String, String)>,
    #[command(flatten)]
    view: View,
}

impl Compare {
    pub(crate) fn run(&self) -> Result<(), Failure> {
        let view = &self.view;
        view.check()?;
        if picture::is_stdout(&view.out) {
            return Err(Failure::Usage("`compare` prints measurements on stdout: give a file to `--out`".to_owned()));
        }
        let progress = Progress::new();
        progress.set_message(format!("loading {}", view.scene));
        let (scene, opaque) = view.scene_views()?;
        let opaque = opaque.as_ref();
        let one = |description: &str, set: &[(String, String)], held: u64| {
            let set = [&self.set, set].concat();
            // The hit ratio needs every event.
            let request =
                RenderRequest { description, set: &set, uniforms: &self.uniforms, count_all: true, opaque, held };
            render(&request, view, &scene, &progress)
        };
        let first = one(&self.first, &self.set_first, view.image_bytes(DIFFERENCE))?;
        let second = one(&self.second, &self.set_second, view.image_bytes(DIFFERENCE + IMAGE))?;
        let shown = |pixel: &[f32; 4]| picture::displayed(*pixel, view.background, view.linear);
        let pixels = first.stats.pixels.iter().map(shown).zip(second.stats.pixels.iter().map(shown));
        let difference = Difference::of(pixels);
        picture::write(&view.out, view.size, &mut difference.heat(), true)?;
        drop(progress);
        let hits = [&first, &second].map(|result| FragmentCounts::of(result).map(|counts| counts.hit_ratio));
        if view.json {
            return output::print(&output::json(&json!({
                "psnr": difference.psnr(),
                "max_error": difference.greatest,
                "different_pixels": difference.count,
                "hit_ratio": hits,
                "first": statistics(&self.first, &first, &scene),
                "second": statistics(&self.second, &second, &scene),
            })));
        }
        let psnr = difference.psnr().map_or("infinite".to_owned(), |psnr| format!("{psnr:.2} dB"));
        let [a, b] = hits.map(|hit| hit.map_or("not counted".to_owned(), |hit| format!("{hit:.4}")));
        output::print(&format!(
            "PSNR       {psnr}\nmax error  {:.2}/255 ({} pixels differ)\nhit ratio  {a} {}, {b} {}\n",
            255.0 * difference.greatest,
            difference.count,
            self.first,
            self.second
        ))
    }
}

/// The bytes per pixel of an image.
const IMAGE: u64 = 16;

/// The bytes per pixel of a [`Difference`].
const DIFFERENCE: u64 = 4;

/// The difference between two images.
struct Difference {
    /// The greatest difference over the channels, by pixel.
    pixels: Vec<f32>,
    greatest: f32,
    /// Pixels that differ in 8 bits a channel.
    count: usize,
    mean_square: f64,
}

impl Difference {
    fn of(images: impl Iterator<Item = ([f32; 4], [f32; 4])>) -> Self {
        let mut difference = Difference { pixels: Vec::new(), greatest: 0.0, count: 0, mean_square: 0.0 };
        difference.pixels.reserve_exact(images.size_hint().0);
        let mut squares = 0.0;
        for (a, b) in images {
            let channels: [f32; 4] = std::array::from_fn(|channel| (a[channel] - b[channel]).abs());
            let greatest = channels.into_iter().fold(0.0, f32::max);
            squares += channels.iter().map(|value| f64::from(*value) * f64::from(*value)).sum::<f64>();
            difference.greatest = difference.greatest.max(greatest);
            difference.count += usize::from(greatest > 0.5 / 255.0);
            difference.pixels.push(greatest);
        }
        difference.mean_square = squares / (4 * difference.pixels.len().max(1)) as f64;
        difference
    }

    /// Returns the peak signal-to-noise ratio over all channels in dB. `None`: the images are equal.
    fn psnr(&self) -> Option<f64> {
        (self.mean_square > 0.0).then(|| -10.0 * self.mean_square.log10())
    }

    /// Returns the pixels of the heat map.
    fn heat(&self) -> impl Iterator<Item = [f32; 4]> {
        let scale = 3.0 / self.greatest.max(1.0e-6);
        let heat = move |value: &f32| {
            let channel = |from: f32| (value * scale - from).clamp(0.0, 1.0);
            [channel(0.0), channel(1.0), channel(2.0), 1.0]
        };
        self.pixels.iter().map(heat)
    }
}
