//! `fragbuf compare`: the same scene through two descriptions. The picture is a heat map of their difference, from black
//! (none) over red and yellow to white (the greatest difference there is).

use serde_json::json;

use super::output::{self, Failure};
use super::paint::{Painted, Wish, paint};
use super::picture;
use super::progress::Progress;
use super::render::{figures, tally};
use super::view::{View, scenes};

#[derive(clap::Args)]
#[command(after_help = scenes())]
pub(crate) struct Compare {
    /// A technique's key, or a .fragbuf file
    first: String,
    /// Another
    second: String,
    /// Changes both descriptions: axis=value, axis.option=value or k=8
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = super::assignment)]
    set: Vec<(String, String)>,
    /// Changes the first description alone
    #[arg(long = "set-first", value_name = "NAME=VALUE", value_parser = super::assignment)]
    set_first: Vec<(String, String)>,
    /// Changes the second description alone
    #[arg(long = "set-second", value_name = "NAME=VALUE", value_parser = super::assignment)]
    set_second: Vec<(String, String)>,
    /// A uniform of both descriptions; those that are not given are 0
    #[arg(long = "uniform", value_name = "NAME=VALUE[,VALUE]", value_parser = super::assignment)]
    uniforms: Vec<(String, String)>,
    #[command(flatten)]
    view: View,
}

impl Compare {
    pub(crate) fn run(&self) -> Result<(), Failure> {
        let view = &self.view;
        view.check()?;
        let progress = Progress::new();
        progress.stage(format!("loading {}", view.scene));
        let (stage, opaque) = view.stages()?;
        let one = |description: &str, own: &[(String, String)]| {
            let set = [&self.set, own].concat();
            // The hit ratio needs every event.
            let opaque = opaque.as_ref();
            let wish = Wish { description, set: &set, uniforms: &self.uniforms, count_all: true, opaque };
            paint(&wish, view, &stage, &progress)
        };
        let (first, second) = (one(&self.first, &self.set_first)?, one(&self.second, &self.set_second)?);
        let shown = |painted: &Painted| picture::displayed(&painted.drawn.pixels, view.background, view.linear);
        let difference = Difference::of(&shown(&first), &shown(&second));
        picture::write(&view.out, view.size, &difference.heat(), true)?;
        drop(progress);
        let hits = [&first, &second].map(|painted| tally(painted).map(|tally| tally.hit_ratio));
        if view.json {
            let [a, b] =
                [(&self.first, &first), (&self.second, &second)].map(|(key, painted)| figures(key, painted, &stage));
            return output::print(&output::json(&json!({
                "psnr": difference.psnr(),
                "max_error": difference.greatest,
                "different_pixels": difference.count,
                "hit_ratio": hits,
                "first": a,
                "second": b,
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

/// How far two pictures are apart.
struct Difference {
    /// The greatest over the channels, by pixel.
    pixels: Vec<f32>,
    greatest: f32,
    /// Pixels that differ in 8 bits.
    count: usize,
    mean_square: f64,
}

impl Difference {
    fn of(first: &[[f32; 4]], second: &[[f32; 4]]) -> Self {
        let apart = |(a, b): (&[f32; 4], &[f32; 4])| {
            std::array::from_fn::<f32, 4, _>(|channel| (a[channel] - b[channel]).abs())
        };
        let channels: Vec<[f32; 4]> = first.iter().zip(second).map(apart).collect();
        let pixels: Vec<f32> = channels.iter().map(|values| values.iter().copied().fold(0.0, f32::max)).collect();
        let greatest = pixels.iter().copied().fold(0.0, f32::max);
        let count = pixels.iter().filter(|value| **value > 0.5 / 255.0).count();
        let squares: f64 = channels.iter().flatten().map(|value| f64::from(*value) * f64::from(*value)).sum();
        Difference { greatest, count, mean_square: squares / (4 * channels.len().max(1)) as f64, pixels }
    }

    /// Peak signal to noise over all channels, in dB; `None`: there is no noise.
    fn psnr(&self) -> Option<f64> {
        (self.mean_square > 0.0).then(|| -10.0 * self.mean_square.log10())
    }

    fn heat(&self) -> Vec<[f32; 4]> {
        let scale = 3.0 / self.greatest.max(1.0e-6);
        let heat = |value: &f32| {
            let channel = |from: f32| (value * scale - from).clamp(0.0, 1.0);
            [channel(0.0), channel(1.0), channel(2.0), 1.0]
        };
        self.pixels.iter().map(heat).collect()
    }
}
