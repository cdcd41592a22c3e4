//! `fragbuf render`: renders a scene through one description and prints the statistics of its frame.

use std::path::PathBuf;

use fragbuf::Registry;
use fragbuf::vocabulary::Row;
use fragbuf_frame::LaggedValues;
use fragbuf_templates::SHOWN_LAYER;
use serde_json::Value;

use super::animated_image::AnimatedImage;
use super::animation::Animation;
use super::assignment::{assignment, uniform};
use super::attributes::{check_sources, model_attributes};
#[cfg(feature = "playground")]
use super::device::DeviceRequest;
use super::effects::{self, Effect, MissingFragments};
use super::input::Input;
use super::output::{self, Failure};
use super::picture;
use super::progress::Progress;
use super::rendering::textures::check_names;
use super::rendering::{DeviceSelection, RenderRequest, RenderResult, render, select};
use super::statistics::statistics;
use super::uniforms;
use super::view::{SceneView, View, scenes};
use super::watch::watch;

#[derive(clap::Args)]
#[command(after_help = format!("{}\n{}", scenes(), effects::help()))]
pub(crate) struct Render {
    /// Technique key, .fragbuf file, or `-` for a description on stdin
    #[arg(required_unless_present = "effect", conflicts_with = "effect")]
    description: Option<String>,
    /// Draw an effect with its description and its default arguments, which others replace. `list --effects` prints them
    #[arg(long, value_name = "NAME", value_parser = effects::parse)]
    effect: Option<&'static Effect>,
    /// Change the description: axis=value, axis.option=value or k=8
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = assignment)]
    set: Vec<(String, String)>,
    /// Set a uniform of the description [default: 0]
    #[arg(long = "uniform", value_name = "NAME=VALUE[,VALUE]", value_parser = uniform)]
    uniforms: Vec<(String, String)>,
    /// Show one layer alone: a fragment of each pixel, from 0 at the front, or with peeling what iteration N stores (the guide has the numbers
    /// where an iteration has several slots). Sets `resolve=layer` and `resolve.number`
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=65_535))]
    layer: Option<u32>,
    #[command(flatten)]
    view: View,
    /// Render again whenever the description, a user file that it names, a model or a file that a model names changes. Ctrl-C ends
    #[arg(long)]
    watch: bool,
    #[command(flatten)]
    animation: Animation,
    /// The text of an example of this program, which is not read from its file.
    #[arg(skip)]
    text: Option<&'static str>,
}

impl Render {
    pub(crate) fn run(&self) -> Result<(), Failure> {
        self.view.check()?;
        if self.animation.is_given() {
            return self.animate();
        }
        if !self.watch {
            return self.render(&mut Vec::new());
        }
        if picture::is_stdout(&self.view.out) {
            return Err(Failure::Usage("`--watch` writes many images: give a file to `--out`".to_owned()));
        }
        let is_file = self.effect.is_none() && Input::is_file(self.description(), &Registry::builtin());
        let description = is_file.then(|| PathBuf::from(self.description()));
        let files = description.into_iter().chain(self.view.files()).collect();
        watch(files, "give a .fragbuf file, or a model to `--scene`", |files| self.render(files))
    }

    /// Renders the frames of an animation, and prints a line per frame.
    fn animate(&self) -> Result<(), Failure> {
        if self.watch {
            return Err(Failure::Usage("`--watch` renders one image again and again: leave out `--frames`".to_owned()));
        }
        let views = self.animation.views(&self.view)?;
        let mut statistics = Vec::new();
        let mut sequence = Sequence { lagged: None, image: self.animation.image(&self.view) };
        for (number, view) in (0..).zip(views) {
            let found = self.frame(&view, &mut sequence, &mut Vec::new())?;
            match view.json {
                true => statistics.push(found),
                false => output::print(&line(number, &found))?,
            }
        }
        sequence.image.map_or(Ok(()), AnimatedImage::finish)?;
        match self.view.json {
            true => output::print(&output::json(&statistics.into())),
            false => Ok(()),
        }
    }

    /// Renders once, and adds the files that it reads to `files`.
    fn render(&self, files: &mut Vec<PathBuf>) -> Result<(), Failure> {
        let found = self.frame(&self.view, &mut Sequence::default(), files)?;
        match self.view.json {
            true => output::print(&output::json(&found)),
            false => Ok(()),
        }
    }

    /// Returns the changes of the description.
    fn changes(&self, registry: &Registry) -> Vec<(String, String)> {
        let shown = |row: &&Row| row.parameters.iter().any(|parameter| parameter.constant == SHOWN_LAYER);
        let layer = self.layer.zip(registry.rows().iter().find(shown)).map(|(number, row)| {
            let parameters = row.parameters.iter().filter(|parameter| parameter.constant == SHOWN_LAYER);
            let numbers = parameters.map(|parameter| (format!("{}.{}", row.axis, parameter.name), number.to_string()));
            std::iter::once((row.axis.clone(), row.key.clone())).chain(numbers).collect::<Vec<_>>()
        });
        layer.into_iter().flatten().chain(self.set.iter().cloned()).collect()
    }

    /// Returns the description as given, or the path of the effect's.
    fn description(&self) -> &str {
        let path = self.effect.map(|effect| effect.path);
        path.or(self.description.as_deref()).unwrap_or_default()
    }

    /// Reads the description.
    fn input(&self, registry: &Registry) -> Result<Input, Failure> {
        match self.text.or(self.effect.map(|effect| effect.text)) {
            Some(text) => Ok(Input::text(self.description(), text)),
            None => Input::read(self.description(), registry),
        }
    }

    /// Renders the next frame of a sequence, adds the files that it reads to `files`, and returns the statistics of the frame.
    fn frame(&self, view: &View, sequence: &mut Sequence, files: &mut Vec<PathBuf>) -> Result<Value, Failure> {
        let progress = Progress::new();
        let Drawn { result, selection, scene } = self.draw(view, sequence.lagged.as_ref(), files, &progress)?;
        progress.set_message(format!("writing {}", view.out.display()));
        match &mut sequence.image {
            Some(image) => image.append(&mut shown(&result, view))?,
            None => picture::write(&view.out, view.size, &mut shown(&result, view), view.linear)?,
        }
        let mut statistics = statistics(self.description(), &result, &selection, &scene);
        if let Some(effect) = self.effect {
            let missing = MissingFragments::of(effect, &result);
            missing.warn(self.description());
            statistics["effect"] = missing.json();
        }
        sequence.lagged = result.stats.lagged;
        Ok(statistics)
    }

    /// Draws a frame, and adds the files that it reads to `files`.
    fn draw(
        &self,
        view: &View,
        lagged: Option<&LaggedValues>,
        files: &mut Vec<PathBuf>,
        progress: &Progress,
    ) -> Result<Drawn, Failure> {
        progress.set_message(format!("loading {}", view.scene));
        let registry = Registry::builtin();
        let mut input = self.input(&registry)?;
        let set = self.changes(&registry);
        let variant = input.variant(&set, &registry);
        files.extend_from_slice(input.files());
        let variant = variant?;
        // Before the scene is loaded and a device is selected.
        uniforms::check(&self.uniforms, &variant)?;
        check_names(&[&variant], &self.view.textures)?;
        if !view.is_later_frame {
            uniforms::warn_unset(self.description(), &self.uniforms, &variant);
        }
        let (scene, opaque) = view.scene_views(&model_attributes(&[&variant], &view.attributes)?)?;
        files.extend(view.importance.clone());
        files.extend([Some(&scene), opaque.as_ref()].into_iter().flatten().flat_map(|view| view.scene.files.clone()));
        check_sources(&[&variant], &scene.scene, &view.attributes)?;
        uniforms::values(&self.uniforms, &variant, &scene)?;
        let request = RenderRequest {
            description: self.description(),
            set: &set,
            uniforms: &self.uniforms,
            count_all: view.json || self.animation.is_given() || self.effect.is_some() && variant.keep.is_some(),
            opaque: opaque.as_ref(),
            held: 0,
            lagged,
            words: &[],
        };
        let mut selection = select(view, &scene, &mut [(&request, &mut input)])?;
        let result = render(&request, &mut input, (view, &mut selection), &scene, progress)?;
        Ok(Drawn { result, selection, scene })
    }
}

#[cfg(feature = "playground")]
impl Render {
    /// Returns the command with an example of this program as its description.
    pub(crate) fn with_text(self, text: &'static str) -> Self {
        Render { text: Some(text), ..self }
    }

    /// Returns the size of the image.
    pub(crate) fn size(&self) -> (u32, u32) {
        self.view.size
    }

    /// Returns the image as a PNG instead of writing it. The CPU device draws it.
    pub(crate) fn png(&self) -> Result<Vec<u8>, Failure> {
        let mut view = self.view.clone();
        view.device = DeviceRequest::Cpu;
        let Drawn { result, .. } = self.draw(&view, None, &mut Vec::new(), &Progress::new())?;
        picture::bytes(view.size, &mut shown(&result, &view), view.linear)
    }
}

/// A frame, and what it was drawn with.
struct Drawn {
    result: RenderResult,
    selection: DeviceSelection,
    scene: SceneView,
}

/// Returns the colours of an image as a PNG has them.
fn shown<'a>(result: &'a RenderResult, view: &'a View) -> impl Iterator<Item = [f32; 4]> + 'a {
    let shown = |pixel: &[f32; 4]| picture::displayed(*pixel, view.background, view.linear);
    result.stats.pixels.iter().map(shown)
}

/// What the frames of an animation pass on.
#[derive(Default)]
struct Sequence {
    /// The decisions of the previous frame.
    lagged: Option<LaggedValues>,
    /// The image of all frames; `None` if each has its own.
    image: Option<AnimatedImage>,
}

/// Returns the line of a frame: k, bytes and hit ratio, as far as the description has them, and whether an earlier frame decided k.
fn line(number: u32, found: &Value) -> String {
    let value = |name: &str| match &found[name] {
        Value::Null => "-".to_owned(),
        value => value.to_string(),
    };
    let ratio = found["hit_ratio"].as_f64().map_or_else(|| "-".to_owned(), |ratio| format!("{ratio:.4}"));
    let lagged = if found["k_lagged"] == true { ", k lags" } else { "" };
    format!("frame {number}: k = {}, {} bytes, hit ratio {ratio}{lagged}\n", value("k"), value("bytes"))
}
