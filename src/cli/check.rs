//! `fragbuf check`: every interleaving of the fragments of one pixel. 0: no failure found, or nothing to try; 1: a failure,
//! with its schedule.

use std::io::{IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::{Duration, Instant};

use fragbuf::{Registry, TARGETS, Target, target};
use fragbuf_checker::{Error, Limits, Model, Report, Schedule, Shader, check_shader, check_variant};
use serde_json::{Value, json};

use super::input::Input;
use super::output::{self, Failure};

/// Events that are no losses are counted too, so that every fragment is accounted for.
const EVERYTHING: (&str, &str) = ("counters", "all");

#[derive(clap::Args)]
#[command(group(clap::ArgGroup::new("what").required(true).args(["description", "wgsl"])))]
pub(crate) struct Check {
    /// A technique's key, or a .fragbuf file
    description: Option<String>,
    /// Any shader instead; where it has a function `holds() -> bool`, that must be true at every end
    #[arg(long, value_name = "FILE", requires = "entry", conflicts_with_all = ["set", "target", "entries"])]
    wgsl: Option<PathBuf>,
    /// The shader's entry point
    #[arg(long, value_name = "NAME", requires = "wgsl")]
    entry: Option<String>,
    /// The first words of one of the shader's buffers; the others are zero
    #[arg(long, value_name = "BUFFER=WORD[,WORD…]", requires = "wgsl", value_parser = fill)]
    fill: Vec<(String, Vec<u32>)>,
    /// Changes the description: axis=value, axis.option=value or k=8
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = super::assignment)]
    set: Vec<(String, String)>,
    /// The target whose program runs; the first that can express the description unless said
    #[arg(long, value_name = "TARGET")]
    target: Option<String>,
    /// Fragments that come at once: 2 and 3 unless said
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=4))]
    fragments: Option<u32>,
    /// Entries that the pixel keeps: 1, 2 and 3 unless said
    #[arg(long, value_name = "K", value_parser = clap::value_parser!(u32).range(1..=7))]
    entries: Option<u32>,
    /// How memory behaves
    #[arg(long, value_enum, default_value_t = ModelArgument::Sc)]
    model: ModelArgument,
    /// Single schedules by chance, this many a case, in place of all orders
    #[arg(long, value_name = "SEEDS")]
    random: Option<u32>,
    /// As JSON
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum ModelArgument {
    /// Every access happens at once, in the order of the schedule
    Sc,
    /// Stores become visible late, in any order but per word; fences, interlock and the ends of passes order them
    Late,
}

impl Check {
    pub(crate) fn run(&self) -> Result<ExitCode, Failure> {
        match (&self.wgsl, &self.description) {
            (Some(file), _) => self.shader(file),
            (None, Some(description)) => self.variant(description),
            (None, None) => Err(Failure::Usage("give a description, or --wgsl FILE".to_owned())),
        }
    }

    fn shader(&self, file: &Path) -> Result<ExitCode, Failure> {
        let text = std::fs::read_to_string(file).map_err(|error| Failure::files(file, &error))?;
        let name = file.display().to_string();
        let entry = self.entry.as_deref().unwrap_or_default();
        let shader = Shader { file: &name, text: &text, entry, fill: &self.fill };
        let limits = self.limits();
        let report = check_shader(&shader, &limits).map_err(|error| match error {
            Error::Unable(text) | Error::NothingToTry(text) => Failure::Input(text),
            Error::Description(faults) => Failure::Description(faults, vec![(name.clone(), text.clone())]),
        })?;
        self.tell(&name, entry, &limits, &report)
    }

    fn variant(&self, description: &str) -> Result<ExitCode, Failure> {
        let registry = Registry::builtin();
        let mut input = Input::read(description, &registry)?;
        let variant = input.variant_or(&self.set, &[EVERYTHING], &registry)?;
        let target = self.target(&variant)?;
        let limits = self.limits();
        let mut told = Progress::new();
        let checked = check_variant(&variant, target, &registry, &limits, &mut |what| told.say(what));
        told.end();
        match checked {
            Ok(report) => self.tell(description, target.name, &limits, &report),
            Err(Error::NothingToTry(why)) => self.tell_nothing(description, target.name, &why),
            Err(Error::Description(faults)) => Err(input.failure(faults)),
            Err(Error::Unable(text)) => Err(Failure::Input(text)),
        }
    }

    fn tell(&self, what: &str, on: &str, limits: &Limits, report: &Report) -> Result<ExitCode, Failure> {
        let text = if self.json {
            output::json(&as_json(what, on, limits, report))
        } else {
            as_text(what, on, limits, report)
        };
        output::print(&text)?;
        Ok(ExitCode::from(u8::from(report.failure.is_some())))
    }

    /// Nothing is wrong, and nothing was tried.
    fn tell_nothing(&self, what: &str, on: &str, why: &str) -> Result<ExitCode, Failure> {
        let text = match self.json {
            true => output::json(
                &json!({ "description": what, "on": on, "holds": null, "cases": 0, "nothing_to_try": why }),
            ),
            false => format!("{what} on {on}: nothing to try: {why}\n"),
        };
        output::print(&text)?;
        Ok(ExitCode::SUCCESS)
    }

    fn limits(&self) -> Limits {
        let mut limits = Limits::default();
        if let Some(count) = self.fragments {
            limits.fragments = vec![count];
        }
        if let Some(k) = self.entries {
            limits.entries = vec![k];
        }
        limits.seeds = self.random;
        limits.model = match self.model {
            ModelArgument::Sc => Model::Sequential,
            ModelArgument::Late => Model::Late,
        };
        limits
    }

    fn target(&self, variant: &fragbuf::Variant) -> Result<&'static Target, Failure> {
        let Some(name) = &self.target else {
            let able = TARGETS.iter().find(|target| {
                let mut offers = target.offers.to_vec();
                offers.push(fragbuf_templates::vocabulary::Capability::OwnEntryPoints);
                variant.select(&offers).is_ok()
            });
            return able.ok_or_else(|| Failure::Usage("no target can express the description".to_owned()));
        };
        let known = || TARGETS.iter().map(|target| target.name).collect::<Vec<_>>().join(", ");
        target(name).ok_or_else(|| Failure::Usage(format!("no target `{name}`: give one of {}", known())))
    }
}

/// `buffer=1,2,3`
fn fill(text: &str) -> Result<(String, Vec<u32>), String> {
    let (name, words) = text.split_once('=').ok_or("write BUFFER=WORD[,WORD…]")?;
    let words = words.split(',').map(|word| word.trim().parse::<u32>().map_err(|error| format!("`{word}`: {error}")));
    Ok((name.trim().to_owned(), words.collect::<Result<_, _>>()?))
}

fn model_name(model: Model) -> &'static str {
    match model {
        Model::Sequential => "sc",
        Model::Late => "late",
    }
}

fn as_text(key: &str, on: &str, limits: &Limits, report: &Report) -> String {
    let plural = if report.cases == 1 { "" } else { "s" };
    let cases = format!("{} case{plural}, {} states", report.cases, report.states);
    let head = format!("{key} on {on}, {}", model_name(limits.model));
    let Some(schedule) = &report.failure else {
        let scope = if report.is_whole { "in every order" } else { "in every order tried" };
        let unjudged = "  Which fragments stay is not judged: the storage offers neither keeps-all nor keeps-best, and has no line `keeps`.\n";
        let note = if report.is_judged { "" } else { unjudged };
        return format!("{head}: no failure {scope} ({cases})\n{note}");
    };
    let verdict = if report.is_stated { "fails, as stated" } else { "FAILS" };
    let mut text = format!("{head}: {verdict} ({cases})\n\n");
    if report.is_stated {
        for (name, what) in &report.hazards {
            text.push_str(&format!("  stated: {name}: {what}\n"));
        }
        text.push('\n');
    } else if !report.hazards.is_empty() {
        let names: Vec<&str> = report.hazards.iter().map(|(name, _)| name.as_str()).collect();
        text.push_str(&format!("  beyond what is stated, which is {}\n\n", names.join(", ")));
    }
    text.push_str(&schedule_text(schedule));
    text
}

fn schedule_text(schedule: &Schedule) -> String {
    let mut text = format!("  case    {}\n", schedule.case);
    for (number, words) in (1..).zip(&schedule.prior) {
        text.push_str(&format!("  before  {number}: {words}\n"));
    }
    for (name, words) in &schedule.fragments {
        text.push_str(&format!("  new     {name}: {words}\n"));
    }
    text.push('\n');
    let width = schedule.steps.iter().map(|step| step.action.chars().count()).max().unwrap_or(0);
    for (number, step) in (1..).zip(&schedule.steps) {
        text.push_str(&format!("  {number:3}  {}  {:width$}  {}\n", step.fragment, step.action, step.place));
    }
    text.push_str(&format!("\n  {}\n", schedule.fault));
    text
}

fn as_json(key: &str, on: &str, limits: &Limits, report: &Report) -> Value {
    json!({
        "description": key,
        "on": on,
        "model": model_name(limits.model),
        "holds": report.failure.is_none(),
        "every_order": report.is_whole,
        "cases": report.cases,
        "states": report.states,
        "as_stated": report.is_stated,
        "hazards": report.hazards.iter().map(|(name, what)| json!({ "name": name, "what": what })).collect::<Vec<_>>(),
        "failure": report.failure.as_ref().map(schedule_json),
    })
}

fn schedule_json(schedule: &Schedule) -> Value {
    let steps = schedule
        .steps
        .iter()
        .map(|step| json!({ "fragment": step.fragment, "action": step.action, "place": step.place }));
    json!({
        "case": schedule.case,
        "before": schedule.prior,
        "fragments": schedule.fragments.iter().map(|(name, words)| json!({ "name": name, "words": words })).collect::<Vec<_>>(),
        "steps": steps.collect::<Vec<_>>(),
        "fault": schedule.fault,
    })
}

/// A line on stderr once a second has passed, where somebody watches.
struct Progress {
    since: Instant,
    last: Instant,
    is_shown: bool,
}

impl Progress {
    fn new() -> Self {
        Progress { since: Instant::now(), last: Instant::now(), is_shown: false }
    }

    fn say(&mut self, what: &str) {
        let is_due = self.since.elapsed() > Duration::from_secs(1) && self.last.elapsed() > Duration::from_millis(200);
        if is_due && std::io::stderr().is_terminal() {
            self.last = Instant::now();
            self.is_shown = true;
            // Nobody is left to tell when stderr is gone.
            let _ = write!(std::io::stderr(), "\r\x1b[K{what}");
        }
    }

    fn end(&self) {
        if self.is_shown {
            let _ = write!(std::io::stderr(), "\r\x1b[K");
        }
    }
}
