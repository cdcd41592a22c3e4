//! A technique for every row of every axis. The tests of hosts share this file.
//!
//! Input: a function that draws a variant and compares its image. Output: rows that nothing draws, and rows that are drawn although
//! the host's table leaves them out.

use fragbuf_model::Variant;
use fragbuf_templates::Registry;

use super::technique::{k_of, variant};

/// Draws a variant with its k and compares. Fails with what the target, the driver or the host lacks.
pub type Draw<'a> = dyn Fn(&str, &Variant, Option<u32>) -> Result<(), String> + 'a;

/// Returns a part of the message of a row that runs neither as the only change of a technique nor, where none takes it so, as one of
/// two. [`NO_TECHNIQUE`]: none takes it.
pub type LeftOut<'a> = dyn Fn(&str, &str) -> Option<String> + 'a;

/// The reason of a row that no technique takes.
pub const NO_TECHNIQUE: &str = "no technique takes it";

/// Draws one technique per row: the first that takes the row as its only change, or as one of two. A row that is left out is tried
/// with every technique. Returns what is wrong.
pub fn draw_rows(draw: &Draw<'_>, left_out: &LeftOut<'_>) -> Vec<String> {
    let registry = Registry::builtin();
    let axes = || registry.axes().iter().filter(|axis| axis.chosen);
    let rows = || axes().flat_map(|axis| registry.rows_of(axis.key).map(|row| (axis.key, row.key.as_str())));
    let others: Vec<Option<(&str, &str)>> = rows().chain([("k", "1")]).map(Some).collect();
    let mut wrong = Vec::new();
    for row in rows() {
        let reason = left_out(row.0, row.1);
        let mut taken = taking_row(draw, row, &[None]);
        if taken.as_ref().is_err_and(|failed| reason.is_none() || failed.is_empty()) {
            let others: Vec<_> =
                others.iter().copied().filter(|other| other.is_none_or(|(axis, _)| axis != row.0)).collect();
            taken = taking_row(draw, row, &others);
        }
        match (taken, reason) {
            (taken, Some(reason)) => wrong.extend(contradiction(row, &taken, &reason)),
            (Ok(what), None) => println!("{what}"),
            (Err(failed), None) => wrong.push(format!("nothing draws {row:?}: {failed:?}")),
        }
    }
    wrong
}

/// Returns the first technique that takes a row and another setting, and is drawn; otherwise why each that takes them is not.
fn taking_row(draw: &Draw<'_>, row: (&str, &str), others: &[Option<(&str, &str)>]) -> Result<String, Vec<String>> {
    let registry = Registry::builtin();
    let mut failed = Vec::new();
    for (technique, other) in registry.techniques().iter().flat_map(|one| others.iter().map(move |other| (one, other)))
    {
        let k = if *other == Some(("k", "1")) { Some(1) } else { k_of(technique) };
        let number = k.map(|k| k.to_string());
        let set: Vec<(&str, &str)> =
            std::iter::once(row).chain(*other).chain(number.iter().map(|k| ("k", k.as_str()))).collect();
        let Some(variant) = variant(&technique.key, &set) else { continue };
        let what = format!("{} with {set:?}", technique.key);
        match draw(&what, &variant, k) {
            Ok(()) => return Ok(what),
            Err(why) => failed.push(format!("{what}: {why}")),
        }
    }
    Err(failed)
}

/// Returns what contradicts the reason why a row is left out.
fn contradiction(row: (&str, &str), taken: &Result<String, Vec<String>>, reason: &str) -> Option<String> {
    let why = match taken {
        Ok(what) => format!("it is drawn: {what}"),
        Err(failed) if failed.is_empty() != (reason == NO_TECHNIQUE) => format!("{} techniques take it", failed.len()),
        Err(failed) if failed.is_empty() || failed.iter().any(|why| why.contains(reason)) => return None,
        Err(failed) => format!("no technique fails for this reason: {failed:?}"),
    };
    Some(format!("{row:?} is left out ({reason}): {why}"))
}
