//! Compares properties of techniques that a paper states with those of the plans.
//!
//! Input: the paper's rows and the registry. Output: a CSV file with one line per property, and an SVG table.
//! Techniques that the paper does not have may follow, with the values of their plans alone. Draws and hit ratios are
//! measured if the row has scenes; nothing is timed.

use fragbuf::Registry;

use super::Figure;
use super::claim::{Finding, sentence};
use super::csv::{self, Row};
use super::experiment::{self, Experiment};
use super::measured::{Measured, MeasuredProperty, measure};
use super::svg::{Anchor, Svg};
use crate::cli::output::Failure;
use crate::cli::paper_table::{Cell, Properties, both, properties};

const COLUMNS: [&str; 7] = ["technique", "key", "property", "paper", "fragbuf", "agrees", "reason"];

/// What follows a number of agreements if each difference has a reason.
const REASONED: &str = ", and the CSV file has the reasons of the others";

/// Runs an experiment and returns its sentence.
pub(super) fn run(row: &experiment::Properties, options: &Figure, experiment: &Experiment) -> Result<String, Failure> {
    let registry = Registry::builtin();
    let mut all: Vec<(Properties, bool)> = Vec::new();
    for paper in row.table.rows {
        all.extend(properties((paper.key, paper.name), row.table, &registry)?.map(|found| (found, true)));
    }
    for technique in registry.techniques().iter().filter(|_| row.has_others) {
        if !row.table.rows.iter().any(|paper| paper.key == technique.key) {
            let found = properties((&technique.key, technique.title), row.table, &registry)?;
            all.extend(found.map(|found| (found, false)));
        }
    }
    let (measured, device) = match &row.measured {
        Some(scenes) => measure(scenes, row.table, (options, experiment))?,
        None => (Vec::new(), "nothing is rendered".to_owned()),
    };
    let rendered = match &row.measured {
        Some(scenes) => {
            let side = options.size.unwrap_or(scenes.side);
            let depths = scenes.depths;
            format!(
                "iterations, draws and R_h of {depths} depths, each of c fragments, {side} x {side} pixels: measured on {device}"
            )
        }
        None => device,
    };
    let header = [
        format!("fragbuf {}, figure {}", env!("CARGO_PKG_VERSION"), experiment.name),
        format!("{}: {}", experiment.paper, experiment.title),
        format!("computed from the registry and the plans; {rendered}"),
    ];
    // A table of reasons has one for every difference.
    let has_reasons = row.table.rows.iter().any(|paper| !paper.reasons.is_empty());
    let columns = if has_reasons { &COLUMNS[..] } else { &COLUMNS[..COLUMNS.len() - 1] };
    let lines = |(technique, _): &(Properties, bool)| -> Vec<Row> {
        technique.cells.iter().map(|cell| line(technique, cell, has_reasons)).collect()
    };
    let lines: Vec<Row> = all.iter().flat_map(lines).chain(measured.iter().map(measured_line)).collect();
    let file = |extension: &str| options.out.join(format!("{}.{extension}", experiment.name));
    csv::write(&file("csv"), &header, columns, &lines)?;
    csv::write_text(&file("svg"), &drawing(experiment, row, &all, &measured))?;
    let findings: Vec<(&str, Finding)> =
        row.compared.iter().map(|(heading, statement)| (*statement, finding(heading, &all))).collect();
    let findings = [findings, measured_findings(&measured)].concat();
    Ok(sentence(experiment.paper, "every target", &findings))
}

/// Returns whether a plan agrees with the paper; `None`: the paper has no legible value. A paper's second value is that
/// of packed attributes.
fn agrees(cell: &Cell) -> Option<bool> {
    let paper = cell.paper.filter(|paper| !["?", "–"].contains(paper))?;
    Some(paper.split("; ").any(|value| value == cell.plan))
}

fn line(technique: &Properties, cell: &Cell, has_reasons: bool) -> Row {
    let verdict = agrees(cell);
    let agrees = in_words(verdict);
    let [paper, plan] = [cell.paper.unwrap_or(""), &cell.plan].map(str::to_owned);
    let cells =
        [technique.name.clone(), technique.key.clone(), cell.heading.to_owned(), paper, plan, agrees.to_owned()];
    let reason = cell.reason.filter(|_| verdict == Some(false)).unwrap_or("").to_owned();
    cells.into_iter().chain(has_reasons.then_some(reason)).collect()
}

fn in_words(verdict: Option<bool>) -> &'static str {
    match verdict {
        Some(true) => "yes",
        Some(false) => "no",
        None => "not compared",
    }
}

fn measured_line(value: &Measured) -> Row {
    let property = format!("{}, c = {}", value.property.heading(), value.coplanar);
    let paper = value.paper.clone().unwrap_or_default();
    let verdict = in_words(value.agrees).to_owned();
    let reason = value.reason.unwrap_or("").to_owned();
    vec![value.name.to_owned(), value.key.to_owned(), property, paper, value.found.clone(), verdict, reason]
}

/// Returns the findings of what was measured, each over all techniques and scenes with a formula.
fn measured_findings(measured: &[Measured]) -> Vec<(&'static str, Finding)> {
    let statements = [
        (MeasuredProperty::Draws, "the measured draws are those of the table's formulas"),
        (MeasuredProperty::HitRatio, "the measured hit ratios are those of the table's formulas"),
    ];
    let finding = |(property, statement): (MeasuredProperty, &'static str)| {
        let compared = || measured.iter().filter(|value| value.property == property && value.agrees.is_some());
        let differing = || compared().filter(|value| value.agrees == Some(false));
        let (count, different) = (compared().count(), differing().count());
        let same = count - different;
        let finding = match differing().all(|value| value.reason.is_some()) {
            _ if different == 0 => Finding::Agrees(format!("{same} of {count} frames")),
            true => Finding::Differs(format!("{same} of {count} frames{REASONED}")),
            false => Finding::Differs(format!("{same} of {count} frames")),
        };
        (statement, finding)
    };
    if measured.is_empty() { Vec::new() } else { statements.map(finding).to_vec() }
}

fn finding(heading: &str, all: &[(Properties, bool)]) -> Finding {
    let cells = || all.iter().flat_map(|(technique, _)| technique.cells.iter().map(move |cell| (technique, cell)));
    let compared = || cells().filter(|(_, cell)| cell.heading == heading && agrees(cell).is_some());
    let differing = || compared().filter(|(_, cell)| agrees(cell) == Some(false));
    // The CSV file has the reasons.
    let unexplained: Vec<String> = differing()
        .filter(|(_, cell)| cell.reason.is_none())
        .map(|(technique, cell)| format!("{}: {}", technique.name, both(cell)))
        .collect();
    let (count, different) = (compared().count(), differing().count());
    let same = count - different;
    match unexplained.is_empty() {
        _ if count == 0 => Finding::Missing("no legible value".to_owned()),
        _ if different == 0 => Finding::Agrees(format!("{same} of {count} techniques")),
        true => Finding::Differs(format!("{same} of {count} techniques agree{REASONED}")),
        false => Finding::Differs(format!("{same} of {count} techniques agree; {}", unexplained.join(", "))),
    }
}

/// The width of the names of techniques, and the height of a line.
const NAMES: u32 = 150;
const LINE: u32 = 22;
const LEFT: u32 = 16;
const TOP: u32 = 62;

/// The colours of cells that agree, that differ, and that have no value of the paper.
const AGREES: &str = "#d9eddb";
const DIFFERS: &str = "#fbe3c0";
const OURS: &str = "#f2f2f2";

/// The space between two tables, and the widths of the columns of measured values.
const GAP: u32 = 34;
const MEASURED: u32 = 104;

/// A cell of a drawing, and its color.
type Drawn = (String, Option<&'static str>);

/// Returns the table as SVG, and below it that of measured values.
fn drawing(
    experiment: &Experiment,
    row: &experiment::Properties,
    all: &[(Properties, bool)],
    measured: &[Measured],
) -> String {
    let widths: Vec<u32> = std::iter::once(NAMES).chain(row.widths.iter().copied()).collect();
    let (above, below) = (table(all), measured_table(row, measured));
    let below_top = TOP + LINE * above.len() as u32 + GAP;
    let height = if below.is_empty() { below_top - GAP } else { below_top + LINE * below.len() as u32 };
    let measured_widths: Vec<u32> = below.first().into_iter().flatten().map(|_| MEASURED).collect();
    let width = widths.iter().sum::<u32>().max(measured_widths.iter().sum());
    let mut svg = Svg::new(2 * LEFT + width, height + 16);
    svg.text([LEFT, 24], (17, "#000000", Anchor::Start), &format!("{}: {}", experiment.paper, experiment.title));
    let note =
        "paper → plan, or one value. Green: they agree; orange: they differ; grey: the paper has no legible value.";
    let others = if row.has_others { " Below: techniques that the table does not have" } else { "" };
    svg.text([LEFT, 44], (12, "#5f5f5f", Anchor::Start), &format!("{note}{others}"));
    draw(&mut svg, TOP, &widths, &above);
    if let Some(scenes) = &row.measured {
        let depths = scenes.depths;
        let note =
            format!("Measured in scenes of {depths} depths, each of c fragments: paper → measured, or one value");
        svg.text([LEFT, below_top - 8], (12, "#5f5f5f", Anchor::Start), &note);
    }
    draw(&mut svg, below_top, &measured_widths, &below);
    svg.finish()
}

/// Draws lines of cells.
fn draw(svg: &mut Svg, top: u32, widths: &[u32], lines: &[Vec<Drawn>]) {
    for (number, line) in (0..).zip(lines) {
        let (mut x, y) = (LEFT, top + LINE * number);
        for ((text, color), width) in line.iter().zip(widths) {
            if let Some(color) = color {
                svg.rectangle([x, y, width - 2, LINE - 2], color);
            }
            svg.text([x + 4, y + 14], (11, "#000000", Anchor::Start), text);
            x += width;
        }
    }
}

fn color(verdict: Option<bool>) -> &'static str {
    match verdict {
        Some(true) => AGREES,
        Some(false) => DIFFERS,
        None => OURS,
    }
}

/// Returns the headings and a line per technique.
fn table(all: &[(Properties, bool)]) -> Vec<Vec<Drawn>> {
    let headings = all.first().map(|(first, _)| first.cells.iter().map(|cell| cell.heading));
    let headings = std::iter::once("technique").chain(headings.into_iter().flatten());
    let headings = headings.map(|heading| (heading.to_owned(), None)).collect();
    let line = |(technique, _): &(Properties, bool)| {
        let cells = technique.cells.iter().map(|cell| (both(cell), Some(color(agrees(cell)))));
        std::iter::once((technique.name.clone(), None)).chain(cells).collect()
    };
    std::iter::once(headings).chain(all.iter().map(line)).collect()
}

/// Returns the headings and a line per technique of measured values; nothing without them.
fn measured_table(row: &experiment::Properties, measured: &[Measured]) -> Vec<Vec<Drawn>> {
    let Some(scenes) = row.measured else { return Vec::new() };
    let columns = || {
        let of = |property| scenes.coplanar.iter().map(move |coplanar| (property, *coplanar));
        MeasuredProperty::ALL.into_iter().flat_map(of)
    };
    let heading = |(property, coplanar): (MeasuredProperty, u32)| format!("{}, c = {coplanar}", property.heading());
    let headings = std::iter::once("technique".to_owned()).chain(columns().map(heading));
    let headings = headings.map(|heading| (heading, None)).collect();
    let cell = |key: &str, (property, coplanar): (MeasuredProperty, u32)| {
        let mut values = measured.iter().filter(|value| value.key == key && value.property == property);
        let Some(value) = values.find(|value| value.coplanar == coplanar) else { return (String::new(), None) };
        let text = match &value.paper {
            Some(paper) if value.agrees == Some(false) => format!("{paper} → {}", value.found),
            _ => value.found.clone(),
        };
        (text, Some(color(value.agrees)))
    };
    let line = |paper: &fragbuf_templates::PaperRow| {
        let cells = columns().map(|column| cell(paper.key, column));
        std::iter::once((paper.name.to_owned(), None)).chain(cells).collect()
    };
    std::iter::once(headings).chain(row.table.rows.iter().map(line)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn technique(name: &str, paper: Option<&'static str>, plan: &str) -> (Properties, bool) {
        let cells = vec![Cell { heading: "words", paper, plan: plan.to_owned(), reason: None }];
        (Properties { key: name.to_owned(), name: name.to_owned(), cells }, paper.is_some())
    }

    #[test]
    fn only_legible_values_are_compared() {
        let same =
            [technique("one", Some("2k; 4k"), "2k"), technique("two", Some("?"), "3k"), technique("three", None, "1")];
        assert_eq!(finding("words", &same), Finding::Agrees("1 of 1 techniques".to_owned()));
        let other = [technique("one", Some("2k"), "2k"), technique("two", Some("3f+6"), "3f+1")];
        let expected = "1 of 2 techniques agree; two: 3f+6 → 3f+1";
        assert_eq!(finding("words", &other), Finding::Differs(expected.to_owned()));
        assert!(matches!(finding("words", &same[1..]), Finding::Missing(_)));
        let [first, (mut second, is_ours)] = other;
        second.cells.iter_mut().for_each(|cell| cell.reason = Some("a reason"));
        let expected = "1 of 2 techniques agree, and the CSV file has the reasons of the others";
        assert_eq!(finding("words", &[first, (second, is_ours)]), Finding::Differs(expected.to_owned()));
    }
}
