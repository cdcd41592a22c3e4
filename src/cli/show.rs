//! `fragbuf show`: prints one description at one stage of its generation.

use fragbuf::snapshot::joined;
use fragbuf::{Form, Generation, Registry, Request, TARGETS, Target, generate, manifest, target, tier};

use super::assignment::assignment;
use super::input::Input;
use super::output::{self, Failure};
use super::{page, targets};

#[derive(clap::Args)]
pub(crate) struct Show {
    /// Technique key, .fragbuf file, or `-` for a description on stdin
    description: String,
    /// Change the description: axis=value, axis.option=value or k=8
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = assignment)]
    set: Vec<(String, String)>,
    /// Print the manifest as JSON
    #[arg(long)]
    json: bool,
    /// Print the page of the technique as Markdown
    #[arg(long, conflicts_with_all = ["json", "dump"])]
    page: bool,
    /// Print one stage: plan, manifest, or a target with text files
    #[arg(long, value_name = "STAGE", conflicts_with = "json")]
    dump: Option<String>,
    /// Print the bytes of a frame of this size in pixels, the limits that a device must have for it, and its slices; with `--json` as JSON
    #[cfg(feature = "pictures")]
    #[arg(long, value_name = "WxH", value_parser = super::view::size, conflicts_with_all = ["page", "dump"])]
    size: Option<(u32, u32)>,
    /// Fragments of an average pixel, for storages whose memory depends on them
    #[cfg(feature = "pictures")]
    #[arg(long, value_name = "N", default_value_t = 8, requires = "size", value_parser = clap::value_parser!(u32).range(1..))]
    fragments: u32,
}

impl Show {
    pub(crate) fn run(&self) -> Result<(), Failure> {
        let registry = Registry::builtin();
        let default = match (self.json, self.page) {
            (true, _) => "manifest",
            (_, true) => "page",
            _ => "summary",
        };
        let stage = self.dump.as_deref().unwrap_or(default);
        let one: Vec<&'static Target> = target(stage).into_iter().collect();
        let all: Vec<&'static Target> = TARGETS.iter().collect();
        if one.is_empty() && !["plan", "manifest", "summary", "page"].contains(&stage) {
            let known: Vec<&str> = ["plan", "manifest"].into_iter().chain(targets::names()).collect();
            return Err(Failure::unknown("stage", stage, &known));
        }
        if stage == "spirv" {
            return Err(Failure::Usage("SPIR-V is binary: write it with `generate --target spirv`".to_owned()));
        }
        let mut input = Input::read(&self.description, &registry)?;
        let variant = input.variant(&self.set, &registry)?;
        let targets = if one.is_empty() { &all } else { &one };
        let request = Request { targets, form: Form::Program, prefix: "", group: 0 };
        let generation = generate(&variant, &request, &registry).map_err(|errors| input.failure(errors))?;
        if !one.is_empty() && generation.plans.is_empty() {
            return Err(targets::unsupported(&input, &variant, &request, &self.set, &registry));
        }
        #[cfg(feature = "pictures")]
        if let Some(size) = self.size {
            let frame = super::size::FrameSize { size, per_pixel: self.fragments };
            return output::print(&super::size::sizes(&generation, frame, self.json)?);
        }
        output::print(&match stage {
            "manifest" => output::json(&manifest(&generation, 0)),
            "plan" => plans(&generation),
            "summary" => summary(&generation),
            "page" => page::page(&generation, &registry),
            _ => files(&generation),
        })
    }
}

fn plans(generation: &Generation) -> String {
    generation.plans.iter().map(|planned| planned.plan.to_string()).collect()
}

/// Returns the plans, and the soundness tier of each target.
fn summary(generation: &Generation) -> String {
    let mut text = plans(generation);
    text.push_str("targets\n");
    for planned in &generation.plans {
        for target in &planned.targets {
            text.push_str(&format!(
                "  {:12} {}  {}\n",
                target.name,
                tier(planned.plan.soundness, target),
                target.summary
            ));
        }
    }
    for (target, missing) in &generation.unsupported {
        text.push_str(&format!("  {:12} —   {missing}\n", target.name));
    }
    text
}

/// Returns every text file once, under its path.
fn files(generation: &Generation) -> String {
    let mut text = joined(generation);
    for (target, missing) in &generation.unsupported {
        text.push_str(&format!("// {}: {missing}\n", target.name));
    }
    text
}
