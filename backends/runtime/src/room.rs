//! Room for fragments whose number no one knows when the frame is allocated.

use fragbuf_codegen::Plan;

use crate::action::{Action, actions};
use crate::memory::checked_sizes;
use crate::symbols::{Symbols, counted_symbols};
use crate::{Error, Settings, Sizing};

/// What is counted, as it stands before the first frame, and whether host steps will count it.
fn counted(plan: &Plan, actions: &[Action], settings: &Settings) -> Result<(Vec<(String, u64)>, bool), Error> {
    let names = counted_symbols(plan);
    let decided = |name: &String| actions.iter().any(|action| matches!(action, Action::Host(host) if host.sets(name)));
    let exact = match settings.sizing {
        Sizing::Auto => names.iter().all(decided),
        Sizing::Exact => true,
        Sizing::Reserve { .. } => false,
    };
    if let Some(name) = names.iter().find(|name| exact && !decided(name)) {
        return Err(Error::Unsupported {
            what: format!("exact sizing of `{name}`, which no step of this plan counts"),
            hint: "reserve: `Sizing::Reserve { fragments }`".to_owned(),
        });
    }
    let room = match settings.sizing {
        _ if exact => 0,
        Sizing::Reserve { fragments } => fragments.into(),
        Sizing::Auto | Sizing::Exact => automatic_room(settings.width, settings.height),
    };
    Ok((names.into_iter().map(|name| (name, room)).collect(), exact))
}

/// The symbols of the first frame, and whether host steps will count.
pub(crate) fn symbols(plan: &Plan, actions: &[Action], settings: &Settings) -> Result<(Symbols, bool), Error> {
    let k = plan.frame.iter().any(|field| field == "k").then_some(plan.variant.keep).flatten();
    let (counted, exact) = counted(plan, actions, settings)?;
    Ok((Symbols { width: settings.width, height: settings.height, k, counted }, exact))
}

/// The greatest height, up to that of the settings, at which every buffer is within the limits.
pub(crate) fn fitting_height(plan: &Plan, settings: &Settings, limits: &wgpu::Limits) -> Result<u32, Error> {
    let actions = actions(plan)?;
    let attempt = |height: u32| {
        let (symbols, _) = symbols(plan, &actions, &Settings { height, ..settings.clone() })?;
        checked_sizes(plan, &symbols, limits)
    };
    // Not even one row: the error says what is too large.
    attempt(1)?;
    let (mut fits, mut beyond) = (1, settings.height.min(limits.max_texture_dimension_2d).saturating_add(1));
    while fits + 1 < beyond {
        let middle = fits + (beyond - fits) / 2;
        if attempt(middle).is_ok() { fits = middle } else { beyond = middle }
    }
    Ok(fits)
}

/// Fragments that there is room for when nobody counts them and nobody says.
pub(crate) fn automatic_room(width: u32, height: u32) -> u64 {
    u64::from(width) * u64::from(height) * u64::from(Sizing::AUTO_PER_PIXEL)
}
