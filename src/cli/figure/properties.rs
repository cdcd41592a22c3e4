//! Compares properties of techniques that a paper states with those of the plans.
//!
//! Input: the paper's rows and the registry. Output: a CSV file with one line per property, and an SVG table. Techniques that the paper does
//! not have may follow, with the values of their plans alone. Nothing is rendered or timed.

use fragbuf::Registry;

use super::Figure;
use super::claim::{Finding, sentence};
use super::csv::{self, Row};
use super::experiment::{self, Experiment};
use super::svg::{Anchor, Svg};
use crate::cli::output::Failure;
use crate::cli::paper_table::{Cell, Properties, both, properties};

const COLUMNS: [&str; 7] = ["technique", "key", "property", "paper", "fragbuf", "agrees", "reason"];

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
    let header = [
        format!("fragbuf {}, figure {}", env!("CARGO_PKG_VERSION"), experiment.name),
        format!("{}: {}", experiment.paper, experiment.title),
        "computed from the registry and the plans; nothing is rendered".to_owned(),
    ];
    // A table of reasons has one for every difference.
    let has_reasons = row.table.rows.iter().any(|paper| !paper.reasons.is_empty());
    let columns = if has_reasons { &COLUMNS[..] } else { &COLUMNS[..COLUMNS.len() - 1] };
    let lines = |(technique, _): &(Properties, bool)| -> Vec<Row> {
        technique.cells.iter().map(|cell| line(technique, cell, has_reasons)).collect()
    };
    let lines: Vec<Row> = all.iter().flat_map(lines).collect();
    let file = |extension: &str| options.out.join(format!("{}.{extension}", experiment.name));
    csv::write(&file("csv"), &header, columns, &lines)?;
    csv::write_text(&file("svg"), &table(experiment, row, &all))?;
    let findings: Vec<(&str, Finding)> =
        row.compared.iter().map(|(heading, statement)| (*statement, finding(heading, &all))).collect();
    Ok(sentence(experiment.paper, "every target", &findings))
}

/// Returns whether a plan agrees with the paper; `None`: the paper has no legible value. A paper's second value is that of packed attributes.
fn agrees(cell: &Cell) -> Option<bool> {
    let paper = cell.paper.filter(|paper| !["?", "–"].contains(paper))?;
    Some(paper.split("; ").any(|value| value == cell.plan))
}

fn line(technique: &Properties, cell: &Cell, has_reasons: bool) -> Row {
    let verdict = agrees(cell);
    let agrees = match verdict {
        Some(true) => "yes",
        Some(false) => "no",
        None => "not compared",
    };
    let [paper, plan] = [cell.paper.unwrap_or(""), &cell.plan].map(str::to_owned);
    let cells =
        [technique.name.clone(), technique.key.clone(), cell.heading.to_owned(), paper, plan, agrees.to_owned()];
    let reason = cell.reason.filter(|_| verdict == Some(false)).unwrap_or("").to_owned();
    cells.into_iter().chain(has_reasons.then_some(reason)).collect()
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
        true => Finding::Differs(format!(
            "{same} of {count} techniques agree, and the CSV file has the reasons of the others"
        )),
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

/// Returns the table as SVG.
fn table(experiment: &Experiment, row: &experiment::Properties, all: &[(Properties, bool)]) -> String {
    let widths = || std::iter::once(NAMES).chain(row.widths.iter().copied());
    let (width, lines) = (2 * LEFT + widths().sum::<u32>(), all.len() as u32 + 1);
    let mut svg = Svg::new(width, TOP + LINE * lines + 16);
    svg.text([LEFT, 24], (17, "#000000", Anchor::Start), &format!("{}: {}", experiment.paper, experiment.title));
    let note =
        "paper → plan, or one value. Green: they agree; orange: they differ; grey: the paper has no legible value.";
    let others = if row.has_others { " Below: techniques that the table does not have" } else { "" };
    svg.text([LEFT, 44], (12, "#5f5f5f", Anchor::Start), &format!("{note}{others}"));
    let mut line = |number: u32, texts: &[(String, Option<&str>)]| {
        let (mut x, y) = (LEFT, TOP + LINE * number);
        for ((text, color), width) in texts.iter().zip(widths()) {
            if let Some(color) = color {
                svg.rectangle([x, y, width - 2, LINE - 2], color);
            }
            svg.text([x + 4, y + 14], (11, "#000000", Anchor::Start), text);
            x += width;
        }
    };
    let headings = all.first().map(|(first, _)| first.cells.iter().map(|cell| cell.heading));
    let headings = std::iter::once("technique").chain(headings.into_iter().flatten());
    line(0, &headings.map(|heading| (heading.to_owned(), None)).collect::<Vec<_>>());
    for (number, (technique, _)) in (1..).zip(all) {
        let cell = |cell: &Cell| {
            let color = match agrees(cell) {
                Some(true) => AGREES,
                Some(false) => DIFFERS,
                None => OURS,
            };
            (both(cell), Some(color))
        };
        let name = (technique.name.clone(), None);
        line(number, &std::iter::once(name).chain(technique.cells.iter().map(cell)).collect::<Vec<_>>());
    }
    svg.finish()
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
