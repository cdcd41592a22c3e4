//! Checks a variant on a target, with every case.
//!
//! Input: a variant, a target, the limits of the check. Output: a [`Report`]. The first failure that the declared hazards do
//! not permit ends the check.

use fragbuf_model::{Diagnostics, Selection, Variant, counted};
use fragbuf_targets::Target;
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{Capability, Kind};

use crate::case::{Case, cases};
use crate::case_check::{CaseCheck, Task};
use crate::case_setup::SearchOptions;
use crate::fragments::{AttributeValues, Candidates, GENERATED, RANKS};
use crate::frame::Frame;
use crate::kept_set::KeptSet;
use crate::model::Model;
use crate::outside::check_outside;
use crate::pool_case::ample_values;
use crate::report::Schedule;
use crate::subject::{RetryLimit, Subject};

/// The limits of a check.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Numbers of concurrent fragments. For a row that is racy by design, the check stops at the first number that shows a
    /// declared hazard.
    pub fragments: Vec<u32>,
    /// Values of k. Those above the variant's capacity are left out.
    pub entries: Vec<u32>,
    /// The memory model.
    pub model: Model,
    /// The number of random schedules per case, instead of all interleavings.
    pub random_schedules: Option<u32>,
    /// The most states of one case.
    pub states: usize,
    /// Whether steps that do not affect each other are explored in one order only. The verdict is the same without.
    pub reduce: bool,
    /// Whether the schedule of a failure is the shortest. Otherwise it is the first that is found. The verdict is the same.
    pub shortest: bool,
}

impl Default for Limits {
    /// Returns limits of two and three fragments, one to three entries, every interleaving and sequential memory.
    fn default() -> Self {
        Limits {
            fragments: vec![2, 3],
            entries: vec![1, 2, 3],
            model: Model::Sequential,
            random_schedules: None,
            states: 4_000_000,
            reduce: true,
            shortest: true,
        }
    }
}

/// What a check found.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Report {
    /// The numbers of kept fragments that were checked; empty where there is no such number.
    pub entries: Vec<u32>,
    /// Cases that were checked.
    pub cases: usize,
    /// States that were visited, or steps of random schedules.
    pub states: usize,
    /// Whether every interleaving of every case was explored.
    pub is_exhaustive: bool,
    /// The first failure that the declared hazards do not permit. If there is none, the first that they permit.
    pub failure: Option<Schedule>,
    /// The declared hazards, as (name, description).
    pub hazards: Vec<(String, String)>,
    /// Whether the declared hazards permit the failure. Then they permit all failures that were found.
    pub is_declared: bool,
    /// Whether a failure was found that may come from invocations of a workgroup that do not run. It decides nothing.
    pub has_undecided_failure: bool,
    /// What the verdict depends on, in sentences.
    pub notes: Vec<String>,
    /// Whether the rows declare which fragments are kept. Otherwise the set of kept fragments is not checked.
    pub is_kept_set_checked: bool,
}

/// Why there is no report.
#[derive(Clone, Debug)]
pub enum Error {
    /// The description is wrong, or the target cannot express it.
    Description(Diagnostics),
    /// The checker cannot run it, for this reason.
    Unable(String),
    /// No shader shares memory between fragments, for this reason. This is not a failure.
    NotApplicable(String),
}

impl From<Diagnostics> for Error {
    fn from(diagnostics: Diagnostics) -> Self {
        Error::Description(diagnostics)
    }
}

impl Report {
    /// Returns the report of no cases.
    pub(crate) fn new(limits: &Limits) -> Self {
        Report {
            entries: Vec::new(),
            cases: 0,
            states: 0,
            is_exhaustive: limits.random_schedules.is_none(),
            failure: None,
            hazards: Vec::new(),
            is_declared: false,
            has_undecided_failure: false,
            notes: Vec::new(),
            is_kept_set_checked: true,
        }
    }
}

const FIXED_FUNCTION: &str = "fixed-function depth test, stencil test and blending select the fragments in submission order; \
    no storing shader accesses memory that fragments share";

/// Checks a variant on a target. `progress` receives the description of each case before it runs.
pub fn check_variant(
    variant: &Variant,
    target: &Target,
    registry: &Registry,
    limits: &Limits,
    progress: &mut dyn FnMut(&str),
) -> Result<Report, Error> {
    let mut report = Report::new(limits);
    if Selection::first(variant).provides().contains(&Capability::FixedFunction) {
        return Err(Error::NotApplicable(FIXED_FUNCTION.to_owned()));
    }
    for retries in [RetryLimit::AsDeclared, RetryLimit::Minimum] {
        let Some(mut subject) = Subject::new(variant, target, registry, retries)? else { continue };
        choose_values(&mut subject).map_err(Error::Unable)?;
        report.is_kept_set_checked = !KeptSet::new(&subject, None).is_unknown();
        let hazards = subject.plan.hazards.iter();
        report.hazards = hazards.map(|hazard| (hazard.name.to_string(), hazard.description.to_string())).collect();
        check_all(&subject, limits, &mut report, progress).map_err(Error::Unable)?;
        if report.failure.is_some() && !report.is_declared {
            break;
        }
    }
    Ok(report)
}

/// Words of the uniform buffer, in the order in which they are considered: two that alternate, for constraints with a lower and an
/// upper limit. The last are those of integers.
const UNIFORMS: [[u32; 2]; 7] = [
    [1.0_f32.to_bits(); 2],
    [0.0_f32.to_bits(); 2],
    [0.5_f32.to_bits(); 2],
    [(-1.0_f32).to_bits(); 2],
    [0.05_f32.to_bits(), 0.95_f32.to_bits()],
    [0.95_f32.to_bits(), 0.05_f32.to_bits()],
    [1; 2],
];

/// Sets uniforms and attributes to values with which the constraints admit enough fragments.
fn choose_values(subject: &mut Subject) -> Result<(), String> {
    let mut most = 0;
    for attributes in AttributeValues::ALL {
        for uniforms in UNIFORMS {
            (subject.uniforms, subject.attributes) = (uniforms, attributes);
            let mut frame = Frame::new(subject, ample_values(subject)?)?;
            match Candidates::new(subject, &mut frame.memory)? {
                Ok(_) => return Ok(()),
                Err(found) => most = most.max(found),
            }
        }
    }
    Err(format!(
        "the constraints admit at most {most} of {GENERATED} generated fragments with different keys, and a check needs {RANKS}: the attributes were \
         from 0 to 1, from 0 to 1000, and integers of 1, the uniforms from -1 to 1: check the storage with a criterion and constraints for such values"
    ))
}

/// Runs every case, until one fails.
fn check_all(
    subject: &Subject,
    limits: &Limits,
    report: &mut Report,
    progress: &mut dyn FnMut(&str),
) -> Result<(), String> {
    let mut frame = Frame::new(subject, ample_values(subject)?)?;
    let candidates = Candidates::new(subject, &mut frame.memory)?
        .map_err(|found| format!("no more than {} can be admitted", counted(found, "fragment")))?;
    let options = SearchOptions {
        model: limits.model,
        random_schedules: limits.random_schedules,
        limit: limits.states,
        may_time_out: subject.may_time_out,
        one_by_one: false,
        is_reduced: limits.reduce,
        wants_shortest: limits.shortest,
    };
    let has_races = subject.permits().any(|permits| permits.needs_race);
    let searches = [Some(options), has_races.then(|| options.without_races())];
    if !subject.passes.iter().any(|pass| pass.pass.kind == Kind::Geometry) {
        return Err("no pass of the plan draws the scene".to_owned());
    }
    if let Some(failure) = check_outside(subject, &candidates.ranked[NEIGHBOUR])? {
        report.failure = Some(failure);
        report.is_declared = false;
        return Ok(());
    }
    let capacity = subject.plan.capacity();
    let entries: Vec<Option<u32>> = match subject.keeps_best() {
        true => limits.entries.iter().copied().filter(|k| *k <= capacity).map(Some).collect(),
        false => vec![None],
    };
    if entries.is_empty() {
        let given: Vec<String> = limits.entries.iter().map(u32::to_string).collect();
        return Err(format!(
            "k = {} is more than the {capacity} fragments that the description keeps: check a k up to {capacity}",
            given.join(", ")
        ));
    }
    for &count in &limits.fragments {
        let mut tasks = Vec::new();
        let mut error = Ok(());
        for &k in &entries {
            match cases(subject, &candidates, (count, k), options.may_time_out) {
                Ok(cases) => tasks.extend(cases.into_iter().flat_map(|case| tasks_of(&case, &searches))),
                Err(text) => {
                    error = Err(text);
                    break;
                }
            }
        }
        CaseCheck::new(subject, &candidates.ranked[NEIGHBOUR], &tasks, limits.states).run(report, progress)?;
        if report.failure.is_some() && !report.is_declared {
            return Ok(());
        }
        error?;
        // Few fragments show races, and more fragments have too many interleavings.
        if subject.is_racy() && report.failure.is_some() {
            return Ok(());
        }
    }
    Ok(())
}

/// Returns the searches of a case.
fn tasks_of(case: &Case, searches: &[Option<SearchOptions>]) -> Vec<Task> {
    let k = case.k.map_or(String::new(), |k| format!("k = {k}, "));
    let case = Case { description: format!("{k}{}", case.description), ..case.clone() };
    let tasks = searches.iter().flatten().enumerate();
    tasks.map(|(number, options)| Task { case: case.clone(), options: *options, is_first: number == 0 }).collect()
}

/// The rank of the neighbour's fragment, which no case uses.
const NEIGHBOUR: usize = 11;
