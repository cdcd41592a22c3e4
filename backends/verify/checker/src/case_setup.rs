//! The fixed parts of a case: its fragments for every pass, and the specification of its final states.
//!
//! Input: a subject and a case. Output: the inputs of the fragments of each pass, and the specification for a frame.

use std::borrow::Cow;

use fragbuf_templates::vocabulary::{Capability, Kind};

use crate::case::Case;
use crate::fragments::{Fragment, at_pixel, farthest};
use crate::frame::Frame;
use crate::kept_set::KeptSet;
use crate::memory::WIDTH;
use crate::model::Model;
use crate::programs::Runnable;
use crate::specification::Specification;
use crate::subject::Subject;

/// How to search.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SearchOptions {
    pub(crate) model: Model,
    /// The number of random schedules, instead of all interleavings.
    pub(crate) random_schedules: Option<u32>,
    /// The most states.
    pub(crate) limit: usize,
    pub(crate) may_time_out: bool,
    /// Whether fragments run one after the other, in every order, so that no hazard that needs a race is permitted.
    pub(crate) one_by_one: bool,
    /// Whether steps that do not affect each other are followed in one order only.
    pub(crate) is_reduced: bool,
    /// Whether the shortest schedule of a failure or declared hazard is wanted.
    pub(crate) wants_shortest: bool,
}

impl SearchOptions {
    /// Returns the same options without races.
    pub(crate) fn without_races(self) -> SearchOptions {
        SearchOptions { model: Model::Sequential, one_by_one: true, ..self }
    }
}

/// A case of a subject, with everything that does not change while it runs.
pub(crate) struct CaseSetup<'s> {
    pub(crate) subject: &'s Subject,
    pub(crate) case: Case,
    pub(crate) neighbour: Fragment,
    /// The greatest depth of the pixel under test, and a fragment behind it that every pass draws. `None`: no shader reads
    /// opaque depth.
    pub(crate) occluded: Option<(f32, Fragment)>,
    pub(crate) specification: Specification,
    /// Fragments of the pixel that a pass counts, where the rows provide that.
    counted: Option<usize>,
}

impl<'s> CaseSetup<'s> {
    pub(crate) fn new(subject: &'s Subject, case: Case, neighbour: &Fragment, options: &SearchOptions) -> Self {
        let real = case.new.len() - usize::from(case.has_helper);
        let counted = case.prior.len() + real - usize::from(case.pool.has_uncounted);
        let counted = subject.plan.selection.provides().contains(&Capability::Counted).then_some(counted);
        let fragments = case.prior.iter().chain(&case.new[..real]).map(|fragment| fragment.words.clone()).collect();
        let specification = Specification {
            kept_set: KeptSet::new(subject, case.k),
            hazards: subject.permits().filter(|permits| !options.one_by_one || !permits.needs_race).cloned().collect(),
            overflows: case.pool.overflows.clone(),
            may_time_out: options.may_time_out,
            culls: subject.culls(),
            keeps_later: subject.keeps_later(),
            counts_events: subject.plan.selection.provides().contains(&Capability::CountsEvents),
            k_best_only: case.k.filter(|_| subject.accepts_k_best_only()).map(|k| k as usize),
            fragments,
            neighbours: 1,
            neighbours_lost: case.pool.neighbours_lost,
            occluded: u32::from(subject.reads_opaque_depth()),
        };
        let program = &subject.passes[case.pass].program;
        let farthest = farthest(case.prior.iter().chain(&case.new), program);
        let occluded = farthest.filter(|_| subject.reads_opaque_depth());
        CaseSetup { subject, case, neighbour: neighbour.clone(), occluded, specification, counted }
    }

    /// Returns the frame before the first run of the pass under test, after everything that comes before it.
    pub(crate) fn frame(&self) -> Result<Frame<'s>, String> {
        let mut frame = Frame::new(self.subject, self.case.pool.values.clone())?;
        frame.allocation_limit = self.case.pool.allocation_limit;
        if let Some((depth, _)) = self.occluded {
            frame.set_opaque(self.case.pixel, depth);
        }
        let is_last_left_out = self.case.pool.has_uncounted || self.case.has_helper;
        let drawn = &self.case.new[..self.case.new.len() - usize::from(is_last_left_out)];
        match frame.advance(self.runnable(), &|runnable| self.inputs(runnable, drawn))? {
            true => Ok(frame),
            false => Err(format!("the frame does not reach the pass `{}`", self.runnable().pass.name)),
        }
    }

    /// Returns the pass under test.
    pub(crate) fn runnable(&self) -> &'s Runnable {
        &self.subject.passes[self.case.pass]
    }

    /// Returns the new fragments that are no helper invocations.
    pub(crate) fn real_fragments(&self) -> &[Fragment] {
        &self.case.new[..self.case.new.len() - usize::from(self.case.has_helper)]
    }

    /// Returns the case as far as its result depends on it: not on its description and, where nothing depends on their arrival
    /// order, not on the order of the prior fragments.
    pub(crate) fn identity(&self) -> Case {
        let subject = self.subject;
        let mut case = Case { description: String::new(), ..self.case.clone() };
        let geometry = subject.passes.iter().rposition(|pass| pass.pass.kind == Kind::Geometry);
        let is_last = geometry == Some(case.pass) && subject.plan.frame.loops.is_empty();
        if is_last && subject.stream.is_none() && self.specification.kept_set.is_order_free() {
            case.prior.sort_by(|one, other| (&one.words, &one.inputs).cmp(&(&other.words, &other.inputs)));
        }
        case
    }

    /// Returns the specification of a frame at its end.
    pub(crate) fn specification_at_end(&self, frame: &Frame<'_>) -> Cow<'_, Specification> {
        let specification = self.specification_in(frame);
        match self.subject.keeps_later() {
            false => specification,
            true => Cow::Owned(Specification {
                kept_set: specification.kept_set.of_all_iterations(),
                k_best_only: None,
                fragments: self.specification.fragments.clone(),
                ..specification.into_owned()
            }),
        }
    }

    /// Returns the specification of the storage in a frame, whose k a host step may have decided. It is given the fragments that
    /// no earlier iteration has kept.
    pub(crate) fn specification_in(&self, frame: &Frame<'_>) -> Cow<'_, Specification> {
        let mut specification = match frame.decided_k() {
            None => Cow::Borrowed(&self.specification),
            Some(k) => Cow::Owned(Specification {
                kept_set: KeptSet::new(self.subject, Some(k)),
                k_best_only: self.subject.accepts_k_best_only().then_some(k as usize),
                ..self.specification.clone()
            }),
        };
        for kept in frame.gathered(self.case.pixel) {
            let fragments = &mut specification.to_mut().fragments;
            if let Some(at) = fragments.iter().position(|fragment| fragment == kept) {
                fragments.remove(at);
            }
        }
        specification
    }

    /// Returns how many fragments the host must allocate for in a frame, where the rows provide that a pass counts them:
    /// those of the pixel and of the neighbour. Not known where every iteration allocates again.
    pub(crate) fn stored_in(&self, frame: &Frame<'_>) -> Option<u64> {
        let k = frame.decided_k().or(self.case.k);
        let counted = self.counted.filter(|_| !self.subject.keeps_later());
        counted.map(|counted| k.map_or(counted, |k| counted.min(k as usize)) as u64 + 1)
    }

    /// Returns the inputs of the neighbour, the occluded fragment, the prior fragments and `new`.
    pub(crate) fn inputs(&self, runnable: &Runnable, new: &[Fragment]) -> Vec<Vec<Vec<u32>>> {
        let pixel = self.case.pixel;
        let neighbour = (&self.neighbour, WIDTH - 1 - pixel);
        let occluded = self.occluded.iter().map(|(_, behind)| behind);
        let of_pixel = occluded.chain(&self.case.prior).chain(new);
        let all = std::iter::once(neighbour).chain(of_pixel.map(|fragment| (fragment, pixel)));
        all.map(|(fragment, pixel)| at_pixel(fragment, &runnable.program, pixel).inputs).collect()
    }
}
