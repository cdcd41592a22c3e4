//! The way of a frame through the actions of its plan: slice after slice, loops as often as they want.
//!
//! In: where a frame stands. Out: the steps up to where the host must read something, or to the end. Nothing is recorded
//! here, and what can fail has failed before anything is.

use fragbuf_frame::Decision;
use fragbuf_templates::vocabulary::Kind;

use crate::action::{Action, Again};
use crate::texture::at_most;
use crate::{Error, Renderer};

/// Where a frame stands.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Place {
    slice: u32,
    /// The next action.
    action: usize,
    /// The round of a loop whose end is found out on the device.
    round: u32,
}

/// What is recorded at once.
pub(crate) struct Segment<'a> {
    pub(crate) steps: Vec<Step<'a>>,
    /// What the host must read after it; `None`: the frame is whole.
    pub(crate) question: Option<Question>,
    /// Where the frame stands then.
    pub(crate) end: Place,
}

/// One action in one slice and round.
pub(crate) struct Step<'a> {
    pub(crate) slice: u32,
    pub(crate) round: u32,
    pub(crate) action: &'a Action,
    /// Workgroups of a compute pass; nothing for any other action.
    pub(crate) groups: [u32; 3],
    /// The stencil's reference of a pass that has one.
    pub(crate) reference: u32,
    pub(crate) ends: Ends,
}

/// What is over after a step.
pub(crate) enum Ends {
    Nothing,
    Slice,
}

/// Why a frame is cut, and what goes on depends on.
#[derive(Clone, Debug)]
pub(crate) enum Question {
    /// What a host function makes of the words.
    Decision(Decision),
    /// Whether a loop goes on: its only word, and whether the bound allows another round.
    Round(Again, Bound),
}

/// Whether a loop may have another round.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Bound {
    Below,
    Reached,
}

/// The steps from `place` on, up to a question or to the end.
pub(crate) fn segment(renderer: &Renderer, mut place: Place) -> Result<Segment<'_>, Error> {
    let actions = &renderer.made().actions.list;
    let mut steps = Vec::new();
    while place.slice < renderer.slices() {
        let Some(action) = actions.get(place.action) else {
            place = Place { slice: place.slice + 1, ..Place::default() };
            continue;
        };
        let question = match action {
            Action::Host(decision) => {
                place.action += 1;
                Some(Question::Decision(decision.clone()))
            }
            Action::Again(again) => {
                let bound = bound(renderer, again, place.round)?;
                // Without the host nobody knows whether it is over: the rounds are drawn to the bound.
                if !renderer.exact {
                    place = place.after(again, bound);
                }
                Some(Question::Round(again.clone(), bound))
            }
            _ => {
                place.action += 1;
                let ends = if place.action == actions.len() { Ends::Slice } else { Ends::Nothing };
                let (groups, reference) = (groups(renderer, action)?, reference(renderer, action, place.round)?);
                steps.push(Step { slice: place.slice, round: place.round, action, groups, reference, ends });
                None
            }
        };
        if let Some(question) = question.filter(|_| renderer.exact) {
            return Ok(Segment { steps, question: Some(question), end: place });
        }
    }
    Ok(Segment { steps, question: None, end: place })
}

impl Place {
    /// After a round of a loop that goes on unless its bound is reached.
    fn after(self, again: &Again, bound: Bound) -> Self {
        match bound {
            Bound::Below => Place { action: again.first, round: self.round + 1, ..self },
            Bound::Reached => Place { action: self.action + 1, round: 0, ..self },
        }
    }

    /// After a round of a loop whose word is `word`.
    pub(crate) fn answered(self, again: &Again, bound: Bound, word: u32) -> Self {
        self.after(again, if word == 0 { Bound::Reached } else { bound })
    }
}

fn bound(renderer: &Renderer, again: &Again, round: u32) -> Result<Bound, Error> {
    let most = renderer.live().evaluate(renderer.plan(), &again.at_most, "the rounds of a loop")?;
    let most = most.min(renderer.made().actions.rounds.into());
    Ok(if u64::from(round) + 1 < most { Bound::Below } else { Bound::Reached })
}

fn reference(renderer: &Renderer, action: &Action, round: u32) -> Result<u32, Error> {
    let Action::Pass(run) = action else { return Ok(0) };
    let prepared = renderer.made().passes.get(run.pass);
    let Some(stencil) = prepared.and_then(|prepared| prepared.pass.state.stencil.as_ref()) else { return Ok(0) };
    at_most(renderer.plan(), &stencil.reference, Some(run.round + round), "the stencil's reference of a pass")
}

fn groups(renderer: &Renderer, action: &Action) -> Result<[u32; 3], Error> {
    let Action::Pass(run) = action else { return Ok([0; 3]) };
    let Some(prepared) = renderer.made().passes.get(run.pass) else { return Ok([0; 3]) };
    let Kind::Compute { groups } = &prepared.pass.kind else { return Ok([0; 3]) };
    let what = format!("pass `{}`", prepared.pass.anchor);
    let limit = renderer.device.limits().max_compute_workgroups_per_dimension;
    let mut counts = [0; 3];
    for (count, formula) in counts.iter_mut().zip(groups) {
        let needed = renderer.sized.symbols.evaluate(renderer.plan(), formula, &what)?;
        *count = u32::try_from(needed).ok().filter(|count| *count <= limit).ok_or_else(|| Error::TooLarge {
            what: format!("{what}, in workgroups,"),
            needed,
            limit: limit.into(),
            limit_name: "max_compute_workgroups_per_dimension",
            hint: "take a smaller frame",
        })?;
    }
    Ok(counts)
}
