//! `fragbuf compare`: renders a scene with two descriptions and measures the difference between the images. The image that it
//! writes is a heat map of the difference: black is 0, red a third of the greatest difference, yellow two thirds, white all of it.

use std::collections::BTreeMap;

use fragbuf::{Registry, Variant};
use serde_json::json;

use super::assignment::{assignment, uniform};
use super::attributes::{check_sources, model_attributes};
use super::input::Input;
use super::output::{self, Failure};
use super::picture;
use super::progress::Progress;
use super::rendering::textures::check_names;
use super::rendering::{RenderRequest, render, select};
use super::statistics::{FragmentCounts, statistics};
use super::uniforms;
use super::view::{SceneView, View, scenes};

#[derive(clap::Args)]
#[command(after_help = scenes())]
pub(crate) struct Compare {
    /// Technique key, .fragbuf file, or `-` for a description on stdin
    first: String,
    /// The one to compare it with, in the same way
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
    /// Set a uniform of each description that has it [default: 0]
    #[arg(long = "uniform", value_name = "NAME=VALUE[,VALUE]", value_parser = uniform)]
    uniforms: Vec<(String, String)>,
    /// Set a uniform of the first description, after `--uniform`
    #[arg(long = "uniform-first", value_name = "NAME=VALUE[,VALUE]", value_parser = uniform)]
    uniforms_first: Vec<(String, String)>,
    /// Set a uniform of the second description, after `--uniform`
    #[arg(long = "uniform-second", value_name = "NAME=VALUE[,VALUE]", value_parser = uniform)]
    uniforms_second: Vec<(String, String)>,
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
        let [mut first, mut second] = self.sides()?;
        let attributes = model_attributes(&[&first.variant, &second.variant], &view.attributes)?;
        let (scene, opaque) = view.scene_views(&attributes)?;
        check_sources(&[&first.variant, &second.variant], &scene.scene, &view.attributes)?;
        for side in [&first, &second] {
            uniforms::values(&side.uniforms, &side.variant, &scene)?;
        }
        let opaque = opaque.as_ref();
        let mut selection = {
            let ((first, first_input), (second, second_input)) = (first.request(opaque, 0), second.request(opaque, 0));
            select(view, &scene, &mut [(&first, first_input), (&second, second_input)])?
        };
        let mut one = |side: &mut Side<'_>, held: u64| {
            let (request, input) = side.request(opaque, held);
            render(&request, input, (view, &mut selection), &scene, &progress)
        };
        let mut left = one(&mut first, view.image_bytes(DIFFERENCE))?;
        let right = one(&mut second, view.image_bytes(DIFFERENCE + IMAGE))?;
        if left.device != right.device {
            // The second rendering has left a device that could not draw it.
            left = one(&mut first, view.image_bytes(DIFFERENCE + IMAGE))?;
        }
        let (first, second) = (left, right);
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
                "heat_map": COLORS.into_iter().zip(difference.scale()).collect::<BTreeMap<_, _>>(),
                "hit_ratio": hits,
                "first": statistics(&self.first, &first, &selection, &scene),
                "second": statistics(&self.second, &second, &selection, &scene),
            })));
        }
        let psnr = difference.psnr().map_or("infinite".to_owned(), |psnr| format!("{psnr:.2} dB"));
        let [a, b] = hits.map(|hit| hit.map_or("not counted".to_owned(), |hit| format!("{hit:.4}")));
        let colors = COLORS.into_iter().zip(difference.scale());
        let colors: Vec<String> = colors.map(|(color, value)| format!("{color} {value:.4}")).collect();
        output::print(&format!(
            "PSNR       {psnr}\nmax error  {:.4} ({:.2}/255), {} pixels differ\nheat map   {}\nhit ratio  {a} {}, {b} {}\n",
            difference.greatest,
            255.0 * difference.greatest,
            difference.count,
            colors.join(", "),
            self.first,
            self.second
        ))
    }

    /// Reads both descriptions with their changes and uniforms.
    fn sides(&self) -> Result<[Side<'_>; 2], Failure> {
        let registry = Registry::builtin();
        let side = |description, set: &[(String, String)], option| {
            let mut input = Input::read(description, &registry)?.with_option_after(self.set.len(), option);
            let set = [&self.set, set].concat();
            let variant = input.variant(&set, &registry)?;
            Ok::<_, Failure>(Side { description, input, variant, set, uniforms: Vec::new() })
        };
        let mut first = side(&self.first, &self.set_first, "--set-first")?;
        let mut second = side(&self.second, &self.set_second, "--set-second")?;
        let [shared_first, shared_second] = uniforms::shared(&self.uniforms, [&first.variant, &second.variant])?;
        first.uniforms = [&shared_first[..], &self.uniforms_first].concat();
        second.uniforms = [&shared_second[..], &self.uniforms_second].concat();
        // Before the first image is rendered.
        for side in [&first, &second] {
            uniforms::check(&side.uniforms, &side.variant)?;
            check_names(&[&first.variant, &second.variant], &self.view.textures)?;
            uniforms::warn_unset(side.description, &side.uniforms, &side.variant);
        }
        Ok([first, second])
    }
}

/// One of the two descriptions.
struct Side<'a> {
    description: &'a str,
    input: Input,
    /// The variant without the choices that a rendering adds.
    variant: Variant,
    set: Vec<(String, String)>,
    uniforms: Vec<(String, String)>,
}

impl Side<'_> {
    /// Returns the request to render it while `held` bytes of other images are in memory.
    fn request<'a>(&'a mut self, opaque: Option<&'a SceneView>, held: u64) -> (RenderRequest<'a>, &'a mut Input) {
        let Side { description, input, set, uniforms, .. } = self;
        // The hit ratio needs every event.
        let request = RenderRequest::new(description);
        (RenderRequest { set, uniforms, count_all: true, opaque, held, ..request }, input)
    }
}

/// The colours of the heat map at equal distances.
const COLORS: [&str; 4] = ["black", "red", "yellow", "white"];

/// The bytes per pixel of an image.
const IMAGE: u64 = 16;

/// The bytes per pixel of a [`Difference`].
const DIFFERENCE: u64 = 4;

/// Returns the difference of two channels. What is not a number differs from every number by 1, and equals what is not a number.
fn distance(a: f32, b: f32) -> f32 {
    match (a.is_nan(), b.is_nan()) {
        (true, true) => 0.0,
        (false, false) if a == b => 0.0,
        (false, false) => (a - b).abs(),
        _ => 1.0,
    }
}

/// The difference between two images.
pub(super) struct Difference {
    /// The greatest difference over the channels, by pixel.
    pixels: Vec<f32>,
    pub(super) greatest: f32,
    /// Pixels that differ in 8 bits a channel.
    pub(super) count: usize,
    mean_square: f64,
}

impl Difference {
    pub(super) fn of(images: impl Iterator<Item = ([f32; 4], [f32; 4])>) -> Self {
        let mut difference = Difference { pixels: Vec::new(), greatest: 0.0, count: 0, mean_square: 0.0 };
        difference.pixels.reserve_exact(images.size_hint().0);
        let mut squares = 0.0;
        for (a, b) in images {
            let channels: [f32; 4] = std::array::from_fn(|channel| distance(a[channel], b[channel]));
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
    pub(super) fn psnr(&self) -> Option<f64> {
        (self.mean_square > 0.0).then(|| -10.0 * self.mean_square.log10())
    }

    /// Returns the difference that each of [`COLORS`] shows.
    fn scale(&self) -> [f32; 4] {
        [0.0, 1.0, 2.0, 3.0].map(|third| third / 3.0 * self.greatest)
    }

    /// Returns the pixels of the heat map, in which white is the greatest difference.
    fn heat(&self) -> impl Iterator<Item = [f32; 4]> {
        self.heat_up_to(self.greatest)
    }

    /// Returns the pixels of the heat map, in which white is a given difference.
    pub(super) fn heat_up_to(&self, greatest: f32) -> impl Iterator<Item = [f32; 4]> {
        let scale = 3.0 / greatest.max(1.0e-6);
        let heat = move |value: &f32| {
            let channel = |from: f32| (value * scale - from).clamp(0.0, 1.0);
            [channel(0.0), channel(1.0), channel(2.0), 1.0]
        };
        self.pixels.iter().map(heat)
    }
}
