//! A whole check: every case of a variant on a target, and the tier that follows from what held.
//!
//! In: a variant, a target, how far to go. Out: a [`Report`]; the first failure that no row states ends it.

use fragbuf_targets::Target;
use fragbuf_model::{Diagnostics, Selection, Variant};
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{Fact, Kind};

use crate::case::{Case, cases};
use crate::fragments::Candidates;
use crate::frame::Frame;
use crate::model::Model;
use crate::promise::Promise;
use crate::report::{Schedule, schedule};
use crate::room::plenty;
use crate::subject::{Subject, Tries};
use crate::trial::{Outcome, Search, Trial};

/// How far to go.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Numbers of fragments that come at once. Of a row that races by design none behind the first with which it fails as
    /// stated is tried.
    pub fragments: Vec<u32>,
    /// Numbers of entries; more than the variant's capacity are left out.
    pub entries: Vec<u32>,
    /// How memory behaves.
    pub model: Model,
    /// This many single schedules by chance in place of all orders.
    pub seeds: Option<u32>,
    /// States of one case.
    pub states: usize,
}

impl Default for Limits {
    /// Two and three fragments, one to three entries, every order, memory at once.
    fn default() -> Self {
        Limits {
            fragments: vec![2, 3],
            entries: vec![1, 2, 3],
            model: Model::Sequential,
            seeds: None,
            states: 4_000_000,
        }
    }
}

/// What a check found.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Report {
    /// Cases that were tried.
    pub cases: usize,
    /// States that were visited, or steps of walks.
    pub states: usize,
    /// Whether every order of every case was tried.
    pub is_whole: bool,
    /// The first failure that no row states; where there is none, the first that one does.
    pub failure: Option<Schedule>,
    /// What can go wrong by design, as (name, what); a failure is then as stated.
    pub hazards: Vec<(String, String)>,
    /// Whether the failure is one of those; then all there are are.
    pub is_stated: bool,
    /// Whether what the storage must keep is known; else that is not judged.
    pub is_judged: bool,
}

/// Why there is no report.
#[derive(Clone, Debug)]
pub enum Error {
    /// The description is at fault, or the target cannot express it.
    Description(Diagnostics),
    /// The checker cannot run it, in words.
    Unable(String),
    /// There is nothing to interleave, and why: not a failure.
    NothingToTry(String),
}

impl From<Diagnostics> for Error {
    fn from(diagnostics: Diagnostics) -> Self {
        Error::Description(diagnostics)
    }
}

impl Report {
    /// Nothing tried, nothing found.
    pub(crate) fn new(limits: &Limits) -> Self {
        Report {
            cases: 0,
            states: 0,
            is_whole: limits.seeds.is_none(),
            failure: None,
            hazards: Vec::new(),
            is_stated: false,
            is_judged: true,
        }
    }

    /// Takes note of what a trial found; whether it is a failure that no row states.
    fn takes_in(&mut self, trial: &Trial<'_>, found: Outcome) -> bool {
        self.states += found.states;
        self.is_whole &= found.is_whole;
        if let Some((round, failure)) = found.failure {
            self.is_stated = false;
            self.failure = Some(schedule(trial, round, &failure));
            return true;
        }
        // What is stated is shown, and the search for what is not goes on.
        if let (None, Some((round, failure))) = (&self.failure, found.stated) {
            self.is_stated = true;
            self.failure = Some(schedule(trial, round, &failure));
        }
        false
    }
}

const LEFT_TO_TESTS: &str = "depth test, stencil and blending decide what stays, in the order of submission, and they are the \
    device's: no shader that stores touches memory that fragments share";

/// Checks a variant on a target. `progress` is told what is being tried.
pub fn check_variant(
    variant: &Variant,
    target: &Target,
    registry: &Registry,
    limits: &Limits,
    progress: &mut dyn FnMut(&str),
) -> Result<Report, Error> {
    let mut report = Report::new(limits);
    if Selection::first(variant).offers().contains(&Fact::FixedFunction) {
        return Err(Error::NothingToTry(LEFT_TO_TESTS.to_owned()));
    }
    for tries in [Tries::AsStated, Tries::Least] {
        let Some(mut subject) = Subject::new(variant, target, registry, tries)? else { continue };
        admit_some(&mut subject).map_err(Error::Unable)?;
        report.is_judged = !Promise::new(&subject, None).is_unknown();
        let hazards = subject.plan.hazards.iter();
        report.hazards = hazards.map(|hazard| (hazard.name.to_string(), hazard.what.to_string())).collect();
        try_all(&subject, limits, tries, &mut report, progress).map_err(Error::Unable)?;
        if report.failure.is_some() && !report.is_stated {
            break;
        }
    }
    Ok(report)
}

/// Values of uniforms that are tried, until the description's constraints admit fragments enough.
const UNIFORMS: [f32; 4] = [1.0, 0.0, 0.5, -1.0];

/// Gives the uniforms a value by which the constraints admit fragments enough.
fn admit_some(subject: &mut Subject) -> Result<(), String> {
    let mut problem = String::new();
    for uniform in UNIFORMS {
        subject.uniform = uniform;
        let mut frame = Frame::new(subject, plenty(subject)?)?;
        match Candidates::new(subject, &mut frame.memory) {
            Ok(_) => return Ok(()),
            Err(error) => problem = error,
        }
    }
    Err(format!(
        "{problem}, whether uniforms are {}: check the storage with constraints that admit more",
        UNIFORMS.map(|uniform| uniform.to_string()).join(", ")
    ))
}

fn try_all(
    subject: &Subject,
    limits: &Limits,
    tries: Tries,
    report: &mut Report,
    progress: &mut dyn FnMut(&str),
) -> Result<(), String> {
    let mut frame = Frame::new(subject, plenty(subject)?)?;
    let candidates = Candidates::new(subject, &mut frame.memory)?;
    let search = Search {
        model: limits.model,
        seeds: limits.seeds,
        limit: limits.states,
        may_give_up: tries == Tries::Least,
        one_by_one: false,
    };
    let races = subject.permits().any(|permits| permits.needs_race);
    let searches = [Some(search), races.then(|| search.without_races())];
    let drawn = subject.passes.iter().filter(|pass| pass.pass.kind == Kind::Geometry).count();
    if drawn == 0 {
        return Err("no pass of the plan draws the scene".to_owned());
    }
    let capacity = subject.plan.capacity();
    let entries: Vec<Option<u32>> = match subject.keeps_best() {
        true => limits.entries.iter().copied().filter(|k| *k <= capacity).map(Some).collect(),
        false => vec![None],
    };
    for &count in &limits.fragments {
        for &k in &entries {
            for case in cases(subject, &candidates, (count, k), search.may_give_up)? {
                let k = k.map_or(String::new(), |k| format!("k = {k}, "));
                progress(&format!("{k}{}", case.what));
                let case = Case { what: format!("{k}{}", case.what), ..case };
                report.cases += 1;
                for search in searches.iter().flatten() {
                    let mut trial = Trial::new(subject, case.clone(), &candidates.ranked[11], search)?;
                    let found = trial.run(search)?;
                    if report.takes_in(&trial, found) {
                        return Ok(());
                    }
                }
            }
        }
        // Races show with few fragments, and more of them have orders beyond counting.
        if subject.is_racy() && report.failure.is_some() {
            return Ok(());
        }
    }
    Ok(())
}
