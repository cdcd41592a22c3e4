//! The statements of a paper, and whether the measured points agree with them.
//!
//! Input: claims and points. Output: findings, and one sentence that reports them. A difference within the spread of the repeats decides
//! nothing.

use super::experiment::{Panel, Passes};
use super::point::{Measurement, Outcome, Point};
use super::spread::{Spread, exponent, ratios, spread};

/// A statement of a paper.
#[derive(Clone, Copy)]
pub(super) struct Claim {
    /// What the paper states, as a clause.
    pub(super) statement: &'static str,
    pub(super) check: Check,
}

/// How a statement is checked on the points of a panel.
#[derive(Clone, Copy)]
pub(super) enum Check {
    /// A series takes less time in some passes than another one, at each of these values; an empty list: at every value.
    Faster { panel: &'static str, series: &'static str, than: &'static str, passes: Passes, at: &'static [u32] },
    /// The buffers of a series need less memory than those of another one, at each of these values; an empty list: at every value.
    Smaller { panel: &'static str, series: &'static str, than: &'static str, at: &'static [u32] },
    /// The quotient of the times of two series changes between the least and the greatest value.
    Changes { panel: &'static str, series: &'static str, over: &'static str, change: Change },
    /// The time of a frame is a power of the value, with an exponent in this range: that of each repeat is fitted.
    Exponent { panel: &'static str, series: &'static str, range: [f64; 2] },
}

/// The direction of a change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Change {
    Rises,
    Falls,
}

/// The result of a check, with the numbers in words.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Finding {
    Agrees(String),
    Differs(String),
    /// The difference is within the spread of the repeats.
    Undecided(String),
    /// The reason why nothing was compared.
    Missing(String),
}

/// Checks the claims on the points of panels.
pub(super) fn findings(claims: &[Claim], panels: &[Panel], points: &[Point]) -> Vec<(&'static str, Finding)> {
    claims.iter().map(|claim| (claim.statement, finding(claim.check, panels, points))).collect()
}

/// Returns the sentence that compares findings with a paper.
pub(super) fn sentence(paper: &str, device: &str, findings: &[(&str, Finding)]) -> String {
    let part = |heading: &str, conjunction: &str, pick: fn(&Finding) -> Option<&str>| {
        let clauses: Vec<String> = findings
            .iter()
            .filter_map(|(statement, finding)| Some(format!("{conjunction}{statement} ({})", pick(finding)?)))
            .collect();
        (!clauses.is_empty()).then(|| format!("{heading}{}", clauses.join(", and ")))
    };
    let parts = [
        part("as in the paper, ", "", |finding| match finding {
            Finding::Agrees(text) => Some(text),
            _ => None,
        }),
        part("unlike in the paper, it does not hold ", "that ", |finding| match finding {
            Finding::Differs(text) => Some(text),
            _ => None,
        }),
        part("the spread of the repeats does not decide ", "whether ", |finding| match finding {
            Finding::Undecided(text) => Some(text),
            _ => None,
        }),
        missing(findings),
    ];
    let parts: Vec<String> = parts.into_iter().flatten().collect();
    format!("{paper}, on {device}: {}.", parts.join("; "))
}

/// Returns the part of a sentence about what was not measured: statements with the same reason share it.
fn missing(findings: &[(&str, Finding)]) -> Option<String> {
    let mut by_reason: Vec<(&str, Vec<String>)> = Vec::new();
    for (statement, finding) in findings {
        let Finding::Missing(reason) = finding else { continue };
        let statement = format!("whether {statement}");
        match by_reason.iter_mut().find(|(known, _)| known == reason) {
            Some((_, statements)) => statements.push(statement),
            None => by_reason.push((reason, vec![statement])),
        }
    }
    let clause = |(reason, statements): (&str, Vec<String>)| format!("{} ({reason})", statements.join(", and "));
    let clauses: Vec<String> = by_reason.into_iter().map(clause).collect();
    (!clauses.is_empty()).then(|| format!("it is not measured {}", clauses.join(", and ")))
}

fn finding(check: Check, panels: &[Panel], points: &[Point]) -> Finding {
    let symbol = |name: &str| panels.iter().find(|panel| panel.name == name).map_or("x", |panel| panel.axis.symbol);
    match check {
        Check::Faster { panel, series, than, passes, at } => {
            let mut quotients = quotients(points, panel, (series, than), passes);
            if let Ok(quotients) = &mut quotients {
                quotients.retain(|(x, _)| at.is_empty() || at.contains(x));
            }
            faster(quotients, symbol(panel))
        }
        Check::Smaller { panel, series, than, at } => smaller(points, panel, (series, than), at, symbol(panel)),
        Check::Changes { panel, series, over, change } => {
            changes(quotients(points, panel, (series, over), Passes::All), change, symbol(panel))
        }
        Check::Exponent { panel, series, range } => powers(points, panel, series, range),
    }
}

/// The quotients of two series: those of the repeats, by the value of the sweep.
type Quotients = Result<Vec<(u32, Vec<f64>)>, String>;

/// Returns the quotients where both series are measured. `Err`: there are none, and the reason.
fn quotients(points: &[Point], panel: &str, (series, over): (&str, &str), passes: Passes) -> Quotients {
    let mut found = Vec::new();
    for (x, measured) in measured(points, panel, series)? {
        let other = measured_at(points, panel, over, x);
        found.extend(other.map(|other| (x, ratios(&measured.samples(passes), &other.samples(passes)))));
    }
    found.retain(|(_, quotients): &(u32, Vec<f64>)| !quotients.is_empty());
    match found.is_empty() {
        true => Err(measured(points, panel, over).err().unwrap_or_else(|| "no common value".to_owned())),
        false => Ok(found),
    }
}

/// Returns the measurements of a series. `Err`: there are none, and the reason.
fn measured<'a>(points: &'a [Point], panel: &str, series: &str) -> Result<Vec<(u32, &'a Measurement)>, String> {
    let of = || points.iter().filter(|point| point.panel == panel && point.series == series);
    let mut reason = None;
    let mut found = Vec::new();
    for point in of() {
        match &point.outcome {
            Outcome::Measured(measured) => found.push((point.x, measured)),
            Outcome::Unavailable(text) => reason = Some(text.clone()),
        }
    }
    match found.is_empty() {
        true => Err(reason.unwrap_or_else(|| format!("no point of {series}"))),
        false => Ok(found),
    }
}

fn measured_at<'a>(points: &'a [Point], panel: &str, series: &str, x: u32) -> Option<&'a Measurement> {
    let found = measured(points, panel, series).ok()?;
    found.into_iter().find(|(value, _)| *value == x).map(|(_, measured)| measured)
}

fn faster(quotients: Quotients, symbol: &str) -> Finding {
    let quotients = match quotients {
        Ok(quotients) => quotients,
        Err(reason) => return Finding::Missing(reason),
    };
    let spreads: Vec<(u32, Spread)> =
        quotients.iter().filter_map(|(x, quotients)| Some((*x, spread(quotients)?))).collect();
    if spreads.is_empty() {
        return Finding::Missing("no common value".to_owned());
    }
    let text = format!("quotient of times {}", numbers(&spreads, symbol));
    if spreads.iter().all(|(_, spread)| spread.quartiles[1] < 1.0) {
        Finding::Agrees(text)
    } else if spreads.iter().any(|(_, spread)| spread.quartiles[0] > 1.0) {
        Finding::Differs(text)
    } else {
        Finding::Undecided(text)
    }
}

/// Compares the bytes of two series. They are no measurements with a spread.
fn smaller(points: &[Point], panel: &str, (series, than): (&str, &str), at: &[u32], symbol: &str) -> Finding {
    let found = match measured(points, panel, series) {
        Ok(found) => found,
        Err(reason) => return Finding::Missing(reason),
    };
    let quotient = |(x, one): (u32, &Measurement)| {
        let other = measured_at(points, panel, than, x).filter(|other| other.bytes > 0)?;
        let quotient = one.bytes as f64 / other.bytes as f64;
        Some((x, Spread { median: quotient, quartiles: [quotient; 2] }))
    };
    let chosen = found.into_iter().filter(|(x, _)| at.is_empty() || at.contains(x));
    let quotients: Vec<(u32, Spread)> = chosen.filter_map(quotient).collect();
    if quotients.is_empty() {
        let reason = measured(points, panel, than).err();
        return Finding::Missing(reason.unwrap_or_else(|| "no common value".to_owned()));
    }
    let text = format!("quotient of bytes {}", numbers(&quotients, symbol));
    match quotients.iter().all(|(_, quotient)| quotient.median < 1.0) {
        true => Finding::Agrees(text),
        false => Finding::Differs(text),
    }
}

/// Returns the medians in words: each of up to two, or the range of more.
fn numbers(spreads: &[(u32, Spread)], symbol: &str) -> String {
    let medians = || spreads.iter().map(|(_, spread)| spread.median);
    match spreads {
        [(from, _), .., (to, _)] if spreads.len() > 2 => {
            let (least, greatest) = (medians().fold(f64::INFINITY, f64::min), medians().fold(0.0, f64::max));
            format!("{least:.2} to {greatest:.2} at {symbol} = {from} … {to}")
        }
        few => {
            let each = few.iter().map(|(x, spread)| format!("{:.2} at {symbol} = {x}", spread.median));
            each.collect::<Vec<_>>().join(", ")
        }
    }
}

fn changes(quotients: Quotients, change: Change, symbol: &str) -> Finding {
    let quotients = match quotients {
        Ok(quotients) => quotients,
        Err(reason) => return Finding::Missing(reason),
    };
    let least = quotients.iter().min_by_key(|(x, _)| *x);
    let greatest = quotients.iter().max_by_key(|(x, _)| *x);
    let (Some((from, first)), Some((to, last))) = (least, greatest) else {
        return Finding::Missing("no common value".to_owned());
    };
    let (Some(first), Some(last)) = (spread(first).filter(|_| from < to), spread(last)) else {
        return Finding::Missing("one value".to_owned());
    };
    let text =
        format!("quotient of times {:.2} at {symbol} = {from}, {:.2} at {symbol} = {to}", first.median, last.median);
    let rises = last.quartiles[0] > first.quartiles[1];
    let falls = last.quartiles[1] < first.quartiles[0];
    match (change, rises, falls) {
        (Change::Rises, true, _) | (Change::Falls, _, true) => Finding::Agrees(text),
        (_, false, false) => Finding::Undecided(text),
        _ => Finding::Differs(text),
    }
}

/// Fits an exponent to each repeat, and compares their quartiles with the range.
fn powers(points: &[Point], panel: &str, series: &str, [least, greatest]: [f64; 2]) -> Finding {
    let measured = match measured(points, panel, series) {
        Ok(measured) => measured,
        Err(reason) => return Finding::Missing(reason),
    };
    let samples: Vec<(f64, Vec<f64>)> =
        measured.iter().map(|(x, measured)| (f64::from(*x), measured.samples(Passes::All))).collect();
    let repeats = samples.iter().map(|(_, times)| times.len()).min().unwrap_or(0);
    let fitted = |repeat: usize| {
        let points: Vec<(f64, f64)> = samples.iter().filter_map(|(x, times)| Some((*x, *times.get(repeat)?))).collect();
        exponent(&points)
    };
    let exponents: Vec<f64> = (0..repeats).filter_map(fitted).collect();
    let Some(Spread { median, quartiles: [low, high] }) = spread(&exponents) else {
        return Finding::Missing("one value".to_owned());
    };
    let text = format!("exponent {median:.2}, quartiles {low:.2} to {high:.2}");
    if least <= low && high <= greatest {
        Finding::Agrees(text)
    } else if high < least || greatest < low {
        Finding::Differs(text)
    } else {
        Finding::Undecided(text)
    }
}

#[cfg(test)]
mod tests;
