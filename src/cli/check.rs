//! `fragbuf check`: checks a technique in every interleaving of the fragments of one pixel.
//!
//! Exit code 0: no failure found, or the check is not applicable. 1: a failure, with its schedule. 4: the search ended before
//! every state was visited, so nothing is decided.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use fragbuf::{Form, Registry, Request, TARGETS, Target, select, source_file};
use fragbuf_checker::{Error, Limits, Model, Report, Schedule, ScheduleStep, Shader, check_shader, check_variant};
use fragbuf_model::counted;
use serde_json::{Value, json};

use super::assignment::assignment;
use super::input::Input;
use super::output::{self, Failure};
use super::progress_line::ProgressLine;
use super::targets;

/// The choice that counts events that are not losses too, so that every fragment is accounted for.
const COUNT_ALL: (&str, &str) = ("counters", "all");

/// The checker runs whole programs.
const PROGRAM: Request<'_> = Request { targets: &[], form: Form::Program, prefix: "", group: 0 };

/// The numbers of kept fragments that can be checked.
const ENTRIES: std::ops::RangeInclusive<i64> = 1..=7;

#[derive(clap::Args)]
#[command(group(clap::ArgGroup::new("what").required(true).args(["description", "wgsl"])))]
pub(crate) struct Check {
    /// Technique key, .fragbuf file, or `-` for a description on stdin
    description: Option<String>,
    /// Check a WGSL file instead of a description. If it declares `holds() -> bool`, that function must return true in every
    /// final state
    #[arg(long, value_name = "FILE", requires = "entry", conflicts_with_all = ["set", "target", "k"])]
    wgsl: Option<PathBuf>,
    /// Entry point of the WGSL file
    #[arg(long, value_name = "NAME", requires = "wgsl", conflicts_with = "description")]
    entry: Option<String>,
    /// Initial words of one of the WGSL file's buffers, and channels of its textures: 3, -1, 0x1f or 0.5. Other words are 0, and
    /// other channels 1
    #[arg(long, value_name = "NAME=WORD[,WORD…]", conflicts_with = "description", value_parser = fill)]
    fill: Vec<(String, Vec<u32>)>,
    /// Value of one of the WGSL file's `override` constants
    #[arg(long = "override", value_name = "NAME=VALUE", conflicts_with = "description", value_parser = override_value)]
    overrides: Vec<(String, f64)>,
    /// Number of workgroups of a compute stage [default: as many as the invocations fill]
    #[arg(long, value_name = "N", conflicts_with = "description", value_parser = clap::value_parser!(u32).range(1..=8))]
    workgroups: Option<u32>,
    /// Change the description: axis=value, axis.option=value, or k=2, which is the same as `--k 2`
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = assignment)]
    set: Vec<(String, String)>,
    /// Target whose shaders are checked [default: the first that supports the description]
    #[arg(long, value_name = "TARGET")]
    target: Option<String>,
    /// Number of concurrent fragments or, in a WGSL file, invocations [default: 2 and 3]
    #[arg(long, alias = "invocations", value_name = "N", value_parser = clap::value_parser!(u32).range(1..=8))]
    fragments: Option<u32>,
    /// Number of entries that the pixel keeps, whatever number the description keeps [default: 1, 2 and 3]
    #[arg(long, alias = "entries", value_name = "K", value_parser = clap::value_parser!(u32).range(ENTRIES))]
    k: Option<u32>,
    /// Memory model
    #[arg(long, value_enum, default_value_t = ModelArgument::Sc)]
    model: ModelArgument,
    /// Run this many random schedules per case instead of all interleavings
    #[arg(long, alias = "random", value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    random_schedules: Option<u32>,
    /// Greatest number of states of one case. If there are more, nothing is decided
    #[arg(long, value_name = "N", default_value_t = Limits::default().states, conflicts_with = "random_schedules",
        value_parser = clap::builder::RangedU64ValueParser::<usize>::new().range(1..=1_000_000_000))]
    states: usize,
    /// Print the report as JSON
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum ModelArgument {
    /// Sequential consistency: every access takes effect at once, in the order of the schedule
    Sc,
    /// Relaxed memory: a store may become visible later, and accesses of different words may be reordered; fences, interlock and
    /// pass boundaries order them
    #[value(alias = "late")]
    Relaxed,
}

impl Check {
    pub(crate) fn run(&self) -> Result<ExitCode, Failure> {
        match (&self.wgsl, &self.description) {
            (Some(file), _) => self.check_file(file),
            (None, Some(description)) => self.check_description(description),
            (None, None) => Err(Failure::Usage("give a description, or --wgsl FILE".to_owned())),
        }
    }

    fn check_file(&self, file: &Path) -> Result<ExitCode, Failure> {
        let source = source_file::read(file).map_err(|error| Failure::source(file, &error))?;
        let name = file.display().to_string();
        let entry = self.entry.as_deref().unwrap_or_default();
        let shader = Shader {
            file: &name,
            source: &source,
            entry,
            fill: &self.fill,
            overrides: &self.overrides,
            workgroups: self.workgroups,
        };
        let limits = self.limits();
        let progress = ProgressLine::new(&format!("checking `{entry}` of {name} in every interleaving"));
        let report = check_shader(&shader, &limits).map_err(|error| match error {
            Error::Unable(text) | Error::NotApplicable(text) => Failure::Input(text),
            Error::Description(errors) => Failure::Description(errors, vec![(name.clone(), source.clone())]),
        })?;
        drop(progress);
        self.print_report((&name, entry), &limits, &report)
    }

    fn check_description(&self, description: &str) -> Result<ExitCode, Failure> {
        let registry = Registry::builtin();
        let mut input = Input::read(description, &registry)?;
        let variant = input.variant_with_defaults(&self.set, &[COUNT_ALL], &registry)?;
        let target = self.target(&input, &variant, &registry)?;
        let mut limits = self.limits();
        limits.entries = self.entries(&variant, &limits)?;
        let progress = ProgressLine::new(&format!("checking {description}"));
        let result = check_variant(&variant, target, &registry, &limits, &mut |message| progress.show(message));
        drop(progress);
        match result {
            Ok(report) => self.print_report((description, target.name), &limits, &report),
            Err(Error::NotApplicable(reason)) => self.print_not_applicable(description, target.name, &reason),
            Err(Error::Description(errors)) => Err(input.failure(errors)),
            Err(Error::Unable(text)) => Err(Failure::Input(text)),
        }
    }

    fn print_report(&self, subject: (&str, &str), limits: &Limits, report: &Report) -> Result<ExitCode, Failure> {
        let text = if self.json {
            output::json(&report_json(subject, limits, report))
        } else {
            report_text(subject, limits, report)
        };
        output::print(&text)?;
        Ok(ExitCode::from(match Verdict::of(limits, report) {
            Verdict::Holds | Verdict::Sampled => 0,
            Verdict::Fails => 1,
            Verdict::Undecided => 4,
        }))
    }

    /// Prints that there was nothing to interleave.
    fn print_not_applicable(&self, name: &str, on: &str, reason: &str) -> Result<ExitCode, Failure> {
        let text = match self.json {
            true => output::json(
                &json!({ "description": name, "on": on, "holds": null, "cases": 0, "not_applicable": reason }),
            ),
            false => format!("{name} on {on}: not applicable: {reason}\n"),
        };
        output::print(&text)?;
        Ok(ExitCode::SUCCESS)
    }

    /// Returns the numbers of kept fragments to check: that of `--k` or `--set k=…`, or else those of `limits`.
    fn entries(&self, variant: &fragbuf::Variant, limits: &Limits) -> Result<Vec<u32>, Failure> {
        let set = self.set.iter().rev().find(|(name, _)| name == "k").map(|(_, value)| value.as_str());
        match (self.k, set, variant.keep) {
            (Some(_), _, None) => {
                output::warn("`--k` has no effect: the description keeps all fragments");
                Ok(limits.entries.clone())
            }
            (None, Some(_), Some(k)) if !ENTRIES.contains(&i64::from(k)) => Err(Failure::Usage(format!(
                "`--set k={k}`: k from {} to {} can be checked in every interleaving: leave \
                 it out to check k = {}",
                ENTRIES.start(),
                ENTRIES.end(),
                listed(&limits.entries)
            ))),
            (Some(given), Some(set), Some(k)) if given != k => {
                Err(Failure::Usage(format!("`--k {given}` and `--set k={set}` differ: give one of them")))
            }
            (None, Some(_), Some(k)) => Ok(vec![k]),
            _ => Ok(limits.entries.clone()),
        }
    }

    fn limits(&self) -> Limits {
        let mut limits = Limits::default();
        if let Some(count) = self.fragments {
            limits.fragments = vec![count];
        }
        if let Some(k) = self.k {
            limits.entries = vec![k];
        }
        limits.random_schedules = self.random_schedules;
        limits.states = self.states;
        limits.model = match self.model {
            ModelArgument::Sc => Model::Sequential,
            ModelArgument::Relaxed => Model::Relaxed,
        };
        limits
    }

    /// Returns the target of `--target`, or the first that supports the variant.
    fn target(
        &self,
        input: &Input,
        variant: &fragbuf::Variant,
        registry: &Registry,
    ) -> Result<&'static Target, Failure> {
        let targets = match &self.target {
            Some(name) => vec![targets::named(name)?],
            None => TARGETS.iter().collect(),
        };
        let request = Request { targets: &targets, ..PROGRAM };
        let found = targets.iter().find(|target| select(variant, target, &request).is_ok());
        found.copied().ok_or_else(|| targets::unsupported(input, variant, &request, &self.set, registry))
    }
}

/// Parses `buffer=1,-2,0x3,0.5`.
fn fill(text: &str) -> Result<(String, Vec<u32>), String> {
    let (name, words) = text.split_once('=').ok_or("write NAME=WORD[,WORD…]")?;
    Ok((name.trim().to_owned(), words.split(',').map(|text| word(text.trim())).collect::<Result<_, _>>()?))
}

/// Parses the bits of an unsigned or signed integer or of a float, which has a point or an exponent.
fn word(text: &str) -> Result<u32, String> {
    let hexadecimal = text.strip_prefix("0x").map(|digits| u32::from_str_radix(digits, 16));
    let integer = || text.parse::<u32>().ok().or_else(|| text.parse::<i32>().ok().map(|value| value as u32));
    let float = || text.parse::<f32>().ok().filter(|value| value.is_finite()).map(f32::to_bits);
    let parsed = hexadecimal.map_or_else(|| integer().or_else(float), Result::ok);
    parsed.ok_or_else(|| format!("`{text}` is neither an integer of 32 bits nor a finite float"))
}

/// Parses `name=1.5`. Booleans are 0 and 1.
fn override_value(text: &str) -> Result<(String, f64), String> {
    let (name, value) = text.split_once('=').ok_or("write NAME=VALUE")?;
    let number = match value.trim() {
        "true" => Some(1.0),
        "false" => Some(0.0),
        other => other.parse::<f64>().ok().filter(|value| value.is_finite()),
    };
    Ok((name.trim().to_owned(), number.ok_or_else(|| format!("`{value}` is neither a finite number nor a boolean"))?))
}

/// What a report says about the subject.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Verdict {
    /// No interleaving fails.
    Holds,
    /// No random schedule fails.
    Sampled,
    Fails,
    /// Some states were not visited.
    Undecided,
}

impl Verdict {
    fn of(limits: &Limits, report: &Report) -> Self {
        match (&report.failure, limits.random_schedules) {
            // What was not visited may fail in another way.
            (Some(_), None) if report.is_declared && !report.is_exhaustive => Verdict::Undecided,
            (Some(_), _) => Verdict::Fails,
            // A failure of a part of a workgroup decides nothing.
            (None, Some(_)) if report.has_undecided_failure => Verdict::Undecided,
            (None, Some(_)) => Verdict::Sampled,
            (None, None) if report.is_exhaustive => Verdict::Holds,
            (None, None) => Verdict::Undecided,
        }
    }
}

fn model_name(model: Model) -> &'static str {
    match model {
        Model::Sequential => "sc",
        Model::Relaxed => "relaxed",
    }
}

/// Returns `1, 2, 3`.
fn listed(numbers: &[u32]) -> String {
    numbers.iter().map(u32::to_string).collect::<Vec<_>>().join(", ")
}

fn report_text((name, on): (&str, &str), limits: &Limits, report: &Report) -> String {
    let k = if report.entries.is_empty() { String::new() } else { format!("k = {}; ", listed(&report.entries)) };
    let cases = format!("{k}{}, {}", counted(report.cases, "case"), counted(report.states, "state"));
    let subject = format!("{name} on {on}, {}", model_name(limits.model));
    let notes: String = notes(report).iter().map(|note| format!("  note: {note}\n")).collect();
    let Some(schedule) = &report.failure else {
        let sentence = match (Verdict::of(limits, report), limits.random_schedules) {
            (Verdict::Undecided, _) => {
                format!("NOT DECIDED: no failure found, but {}", undecided((limits, report), &notes))
            }
            (_, Some(count)) => {
                format!("no failure in {} per case; others may fail", counted(count, "random schedule"))
            }
            (_, None) => "no failure in any interleaving".to_owned(),
        };
        return format!("{subject}: {sentence} ({cases})\n{notes}");
    };
    let verdict = match (Verdict::of(limits, report), report.is_declared) {
        (Verdict::Undecided, _) => {
            format!("NOT DECIDED: fails with declared hazards, but {}", undecided((limits, report), &notes))
        }
        (_, true) => "fails with declared hazards".to_owned(),
        (_, false) => "FAILS".to_owned(),
    };
    let mut text = format!("{subject}: {verdict} ({cases})\n\n");
    if report.is_declared {
        for (hazard, description) in &report.hazards {
            text.push_str(&format!("  hazard: {hazard}: {description}\n"));
        }
        text.push('\n');
    } else if !report.hazards.is_empty() {
        let hazards: Vec<&str> = report.hazards.iter().map(|(hazard, _)| hazard.as_str()).collect();
        text.push_str(&format!("  not explained by the declared hazards: {}\n\n", hazards.join(", ")));
    }
    text.push_str(&schedule_text(schedule));
    text.push_str(&notes);
    text
}

/// Returns the notes of a report, and one about what is not checked.
fn notes(report: &Report) -> Vec<&str> {
    let unchecked = "which fragments are kept is not checked: the storage provides neither keeps-all nor keeps-best, and has no `keeps` line; their order is \
         checked if it provides sorted";
    let unchecked = (!report.is_kept_set_checked).then_some(unchecked);
    report.notes.iter().map(String::as_str).chain(unchecked).collect()
}

/// Says why a search decides nothing.
fn undecided((limits, report): (&Limits, &Report), notes: &str) -> String {
    if report.states < limits.states && !notes.is_empty() {
        return "the check does not cover everything: see the notes".to_owned();
    }
    let reason = if notes.is_empty() { "" } else { "see the notes; " };
    format!(
        "not every state was visited ({reason}at most {} states of a case are visited: raise `--states`, or use `--random-schedules`)",
        limits.states
    )
}

fn schedule_text(schedule: &Schedule) -> String {
    let mut text = format!("  case     {}\n", schedule.case);
    for (number, words) in (1..).zip(&schedule.initial_fragments) {
        text.push_str(&format!("  initial  {number}: {words}\n"));
    }
    for (name, words) in &schedule.fragments {
        text.push_str(&format!("  new      {name}: {words}\n"));
    }
    text.push('\n');
    let width = schedule.steps.iter().map(|step| step.action.chars().count()).max().unwrap_or(0);
    for (number, step) in (1..).zip(&schedule.steps) {
        text.push_str(&format!("  {number:3}  {}  {:width$}  {}\n", step.fragment, step.action, step.location));
    }
    text.push_str(&format!("\n  {}\n", schedule.violation));
    text
}

fn report_json((name, on): (&str, &str), limits: &Limits, report: &Report) -> Value {
    let hazard = |(name, description): &(String, String)| json!({ "name": name, "description": description });
    json!({
        "description": name,
        "on": on,
        "model": model_name(limits.model),
        "holds": match Verdict::of(limits, report) {
            Verdict::Undecided if report.failure.is_none() => Value::Null,
            verdict => Value::Bool(matches!(verdict, Verdict::Holds | Verdict::Sampled)),
        },
        "exhaustive": report.is_exhaustive,
        "notes": notes(report),
        "k": report.entries,
        "cases": report.cases,
        "states": report.states,
        "declared_hazard": report.is_declared,
        "hazards": report.hazards.iter().map(hazard).collect::<Vec<_>>(),
        "failure": report.failure.as_ref().map(schedule_json),
    })
}

fn step_json(step: &ScheduleStep) -> Value {
    json!({ "fragment": step.fragment, "action": step.action, "location": step.location })
}

fn schedule_json(schedule: &Schedule) -> Value {
    let steps = schedule.steps.iter().map(step_json);
    json!({
        "case": schedule.case,
        "initial_fragments": schedule.initial_fragments,
        "fragments": schedule.fragments.iter().map(|(name, words)| json!({ "name": name, "words": words })).collect::<Vec<_>>(),
        "steps": steps.collect::<Vec<_>>(),
        "violation": schedule.violation,
        "race": schedule.race.as_ref().map(|race| json!({
            "word": race.word,
            "first": step_json(&race.first),
            "second": step_json(&race.second),
        })),
    })
}
