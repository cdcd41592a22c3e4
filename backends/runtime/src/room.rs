//! Room for fragments whose number no one knows when the frame is allocated.

use fragbuf_codegen::Plan;

use crate::action::Action;
use crate::symbols::counted_symbols;
use crate::{Error, Settings, Sizing};

/// What is counted, as it stands before the first frame, and whether host steps will count it.
pub(crate) fn counted(
    plan: &Plan,
    actions: &[Action],
    settings: &Settings,
) -> Result<(Vec<(String, u64)>, bool), Error> {
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

/// Fragments that there is room for when nobody counts them and nobody says.
pub(crate) fn automatic_room(width: u32, height: u32) -> u64 {
    u64::from(width) * u64::from(height) * u64::from(Sizing::AUTO_PER_PIXEL)
}
