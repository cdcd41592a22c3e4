//! Compares properties of techniques that a paper states with those of the plans.
//!
//! Input: the paper's rows and the registry. Output: a CSV file with one line per property, and an SVG table. Techniques that the paper does
//! not have follow, with the values of their plans alone. Nothing is rendered or timed.

use fragbuf::Registry;

use super::Figure;
use super::claim::{Finding, sentence};
use super::csv::{self, Row};
use super::experiment::{self, Experiment};
use super::svg::{Anchor, Svg};
use crate::cli::output::Failure;
use crate::cli::table_1::{Cell, Properties, both, properties};

const COLUMNS: [&str; 6] = ["technique", "key", "property", "paper", "fragbuf", "agrees"];

/// Runs an experiment and returns its sentence.
pub(super) fn run(row: &experiment::Properties, options: &Figure, experiment: &Experiment) -> Result<String, Failure> {
    let registry = Registry::builtin();
    let mut all: Vec<(Properties, bool)> = Vec::new();
    for paper in row.rows {
        all.extend(properties(paper.key, paper.name, Some(paper), &registry)?.map(|found| (found, true)));
    }
    for technique in registry.techniques() {
        if !row.rows.iter().any(|paper| paper.key == technique.key) {
            all.extend(properties(&technique.key, technique.title, None, &registry)?.map(|found| (found, false)));
        }
    }
    let header = [
        format!("fragbuf {}, figure {}", env!("CARGO_PKG_VERSION"), experiment.name),
        format!("{}: {}", experiment.paper, experiment.title),
        "computed from the registry and the plans; nothing is rendered".to_owned(),
    ];
    let lines = |(technique, _): &(Properties, bool)| -> Vec<Row> {
        technique.cells.iter().map(|cell| line(technique, cell)).collect()
    };
    let lines: Vec<Row> = all.iter().flat_map(lines).collect();
    let file = |extension: &str| options.out.join(format!("{}.{extension}", experiment.name));
    csv::write(&file("csv"), &header, &COLUMNS, &lines)?;
    csv::write_text(&file("svg"), &table(experiment, &all))?;
    let findings: Vec<(&str, Finding)> =
        row.compared.iter().map(|(heading, statement)| (*statement, finding(heading, &all))).collect();
    Ok(sentence(experiment.paper, "every target", &findings))
}

/// Returns whether a plan agrees with the paper; `None`: the paper has no legible value. A paper's second value is that of packed attributes.
fn agrees(cell: &Cell) -> Option<bool> {
    let paper = cell.paper.filter(|paper| !["?", "–"].contains(paper))?;
    Some(paper.split("; ").any(|value| value == cell.plan))
}

fn line(technique: &Properties, cell: &Cell) -> Row {
    let agrees = match agrees(cell) {
        Some(true) => "yes",
        Some(false) => "no",
        None => "not compared",
    };
    let [paper, plan] = [cell.paper.unwrap_or(""), &cell.plan].map(str::to_owned);
    vec![technique.name.clone(), technique.key.clone(), cell.heading.to_owned(), paper, plan, agrees.to_owned()]
}

fn finding(heading: &str, all: &[(Properties, bool)]) -> Finding {
    let cells = || all.iter().flat_map(|(technique, _)| technique.cells.iter().map(move |cell| (technique, cell)));
    let compared = || cells().filter(|(_, cell)| cell.heading == heading && agrees(cell).is_some());
    let differing: Vec<String> = compared()
        .filter(|(_, cell)| agrees(cell) == Some(false))
        .map(|(technique, cell)| format!("{}: {}", technique.name, both(cell)))
        .collect();
    let (count, same) = (compared().count(), compared().count() - differing.len());
    match differing.is_empty() {
        _ if count == 0 => Finding::Missing("no legible value".to_owned()),
        true => Finding::Agrees(format!("{same} of {count} techniques")),
        false => Finding::Differs(format!("{same} of {count} techniques agree; {}", differing.join(", "))),
    }
}

/// The widths of the columns of the table, and the height of a line.
const WIDTHS: [u32; 8] = [150, 110, 110, 110, 90, 480, 110, 50];
const LINE: u32 = 22;
const LEFT: u32 = 16;
const TOP: u32 = 62;

/// The colours of cells that agree, that differ, and that have no value of the paper.
const AGREES: &str = "#d9eddb";
const DIFFERS: &str = "#fbe3c0";
const OURS: &str = "#f2f2f2";

/// Returns the table as SVG.
fn table(experiment: &Experiment, all: &[(Properties, bool)]) -> String {
    let (width, lines) = (2 * LEFT + WIDTHS.iter().sum::<u32>(), all.len() as u32 + 1);
    let mut svg = Svg::new(width, TOP + LINE * lines + 16);
    svg.text([LEFT, 24], (17, "#000000", Anchor::Start), &format!("{}: {}", experiment.paper, experiment.title));
    let note = "paper → plan, or one value. Green: they agree; orange: they differ; grey: the paper has no legible value. Below: techniques \
                that the table does not have";
    svg.text([LEFT, 44], (12, "#5f5f5f", Anchor::Start), note);
    let mut line = |number: u32, texts: &[(String, Option<&str>)]| {
        let (mut x, y) = (LEFT, TOP + LINE * number);
        for ((text, color), width) in texts.iter().zip(WIDTHS) {
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
        let cell = |heading| Cell { heading, paper, plan: plan.to_owned() };
        let cells = ["words", "a", "b", "c", "d", "e", "f"].map(cell);
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
    }
}
