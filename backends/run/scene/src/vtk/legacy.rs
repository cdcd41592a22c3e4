//! Legacy files: statements of a keyword and words, each followed by its numbers.
//!
//! The format of Kitware's "VTK File Formats"; cells of both versions, 3.0 with the number of points before each cell, and 5.1 with offsets.

use super::Grid;
use super::fields::{Field, Wanted};
use super::numbers::Kind;
use super::scan::Scan;
use crate::error::FileError;
use crate::limits::Budget;
use crate::text::quoted;
use crate::warnings::{FileWarnings, WarningKind};

/// The greatest number of arrays of a file.
const MAX_FIELDS: usize = 4096;

struct Reader<'a> {
    scan: Scan<'a>,
    grid: Grid,
    wanted: &'a Wanted<'a>,
    budget: &'a Budget,
    warnings: FileWarnings<'a>,
    /// Whether arrays belong to cells, and their number of points or cells; `None`: arrays belong to the file.
    section: Option<(bool, usize)>,
}

/// Reads a file that begins with the line of a legacy file.
pub(super) fn read(
    bytes: &[u8],
    wanted: &Wanted<'_>,
    budget: &Budget,
    warnings: FileWarnings<'_>,
) -> Result<Grid, FileError> {
    let mut scan = Scan::new(bytes);
    // The version and the title.
    scan.line();
    scan.line();
    let before = scan.clone();
    let encoding = scan.text("`ASCII` or `BINARY`")?;
    scan.is_binary = match encoding.to_ascii_uppercase().as_str() {
        "ASCII" => false,
        "BINARY" => true,
        _ => return Err(before.error(format!("{} is not `ASCII` or `BINARY`", quoted(&encoding)))),
    };
    let mut reader = Reader { scan, grid: Grid::default(), wanted, budget, warnings, section: None };
    while reader.statement()? {}
    let Reader { scan, grid, .. } = reader;
    for (is_there, statement) in [
        (grid.points_at.is_some(), "POINTS"),
        (grid.cells_at.is_some(), "CELLS"),
        (grid.cells_at.is_none() || !grid.types.is_empty() || grid.ends.is_empty(), "CELL_TYPES"),
    ] {
        if !is_there {
            return Err(scan.error(format!("the file ends without the statement `{statement}`")));
        }
    }
    Ok(grid)
}

impl Reader<'_> {
    /// Reads a statement. Returns false at the end of the file.
    fn statement(&mut self) -> Result<bool, FileError> {
        let before = self.scan.clone();
        let Some(word) = self.scan.word() else { return Ok(false) };
        let keyword = String::from_utf8_lossy(word.get(..64).unwrap_or(word)).to_ascii_uppercase();
        match keyword.as_str() {
            "DATASET" => self.dataset()?,
            "POINTS" => {
                self.grid.points_at = Some(before.position());
                let count = self.scan.count("the number of points")?;
                let kind = self.scan.kind()?;
                self.grid.points = self.scan.numbers(3 * count, (kind, "the points"), self.budget)?;
            }
            "CELLS" => {
                self.grid.cells_at = Some(before.position());
                self.cells()?;
            }
            "CELL_TYPES" => {
                let count = self.scan.count("the number of cells")?;
                self.grid.types = self.scan.numbers(count, (Kind::I32, "the types of cells"), self.budget)?;
            }
            "POINT_DATA" | "CELL_DATA" => self.begin_data(keyword == "CELL_DATA", &before)?,
            "METADATA" => {
                // Up to an empty line.
                self.scan.line();
                while !self.scan.line().is_empty() {}
            }
            _ => self.data(&keyword, &before)?,
        }
        Ok(true)
    }

    fn dataset(&mut self) -> Result<(), FileError> {
        let before = self.scan.clone();
        let name = self.scan.text("the kind of the dataset")?;
        if name.eq_ignore_ascii_case("UNSTRUCTURED_GRID") {
            return Ok(());
        }
        let help = "only an UNSTRUCTURED_GRID has tetrahedra; convert it, or give a surface as PLY";
        Err(before.error(format!("the dataset is {}: {help}", quoted(&name))))
    }

    fn cells(&mut self) -> Result<(), FileError> {
        let before = self.scan.clone();
        let (count, length) =
            (self.scan.count("the number of cells")?, self.scan.count("the number of points of cells")?);
        let mut next = self.scan.clone();
        if next.word().is_some_and(|word| word.eq_ignore_ascii_case(b"OFFSETS")) {
            self.scan = next;
            let kind = self.scan.kind()?;
            let ends = self.scan.numbers(count, (kind, "the offsets of cells"), self.budget)?;
            self.grid.ends = ends.into_iter().skip(1).collect();
            let before = self.scan.clone();
            let word = self.scan.text("`CONNECTIVITY`")?;
            if !word.eq_ignore_ascii_case("CONNECTIVITY") {
                return Err(before.error(format!("expected `CONNECTIVITY`, found {}", quoted(&word))));
            }
            let kind = self.scan.kind()?;
            self.grid.connectivity = self.scan.numbers(length, (kind, "the points of cells"), self.budget)?;
            return Ok(());
        }
        let list = self.scan.numbers(length, (Kind::I32, "the points of cells"), self.budget)?;
        self.budget.take(length as u64, 8, "the points of cells")?;
        let mut at = 0;
        for cell in 0..count {
            let points = list.get(at).copied().unwrap_or(-1.0);
            let part = list.get(at + 1..(at + 1).saturating_add(points as usize)).filter(|_| points >= 0.0);
            let Some(part) = part else {
                let message = format!("cell {cell} has {points} points, and the list of cells has {length} numbers");
                return Err(before.error(message));
            };
            self.grid.connectivity.extend_from_slice(part);
            self.grid.ends.push(self.grid.connectivity.len() as f64);
            at += 1 + part.len();
        }
        Ok(())
    }

    fn begin_data(&mut self, is_of_cells: bool, before: &Scan<'_>) -> Result<(), FileError> {
        let count = self.scan.count("the number of points or cells")?;
        let (expected, what) = match is_of_cells {
            true => (self.grid.ends.len(), "cells"),
            false => (self.grid.points.len() / 3, "points"),
        };
        if count != expected {
            return Err(before.error(format!("data of {count} {what}, and the grid has {expected}")));
        }
        self.section = Some((is_of_cells, count));
        Ok(())
    }

    /// Reads a statement of data.
    fn data(&mut self, keyword: &str, before: &Scan<'_>) -> Result<(), FileError> {
        let components = match keyword {
            "SCALARS" | "GLOBAL_IDS" | "PEDIGREE_IDS" | "EDGE_FLAGS" => 1,
            "VECTORS" | "NORMALS" => 3,
            "TENSORS" => 9,
            "TENSORS6" => 6,
            "TEXTURE_COORDINATES" => 0,
            "COLOR_SCALARS" | "LOOKUP_TABLE" => return self.colors(keyword),
            "FIELD" => return self.fields(),
            _ => {
                let help = "the format has no such statement, or the numbers before it are too many";
                return Err(before.error(format!("unknown statement {}: {help}", quoted(keyword))));
            }
        };
        let name = self.scan.text("the name of an array")?;
        let components = if components == 0 { self.scan.count("a number of components")? } else { components };
        let kind = self.scan.kind()?;
        let components = if keyword == "SCALARS" { self.scalars(components)? } else { components };
        let (_, count) = self.section.unwrap_or_default();
        self.array((name, components, count), kind, before)
    }

    /// Returns the number of components of scalars, and reads what is before their numbers.
    fn scalars(&mut self, default: usize) -> Result<usize, FileError> {
        let mut line = self.scan.clone();
        let has_count = line.line().parse::<usize>().is_ok();
        let components = if has_count { self.scan.count("a number of components")? } else { default };
        let mut next = self.scan.clone();
        if next.word().is_some_and(|word| word.eq_ignore_ascii_case(b"LOOKUP_TABLE")) {
            next.text("the name of a table")?;
            self.scan = next;
        }
        Ok(components)
    }

    /// Skips colours, which are bytes in a binary file.
    fn colors(&mut self, keyword: &str) -> Result<(), FileError> {
        self.scan.text("the name of an array")?;
        let size = self.scan.count("a number of colours")?;
        let (_, count) = self.section.unwrap_or_default();
        let numbers = if keyword == "LOOKUP_TABLE" { size.saturating_mul(4) } else { size.saturating_mul(count) };
        self.warnings
            .add(WarningKind::NotRead, "colours", || (self.scan.position(), "colours are not read".to_owned()));
        self.scan.skip(numbers, (Kind::U8, "the colours"))
    }

    /// Reads the arrays of a field.
    fn fields(&mut self) -> Result<(), FileError> {
        self.scan.text("the name of a field")?;
        for _ in 0..self.scan.count("a number of arrays")? {
            let before = self.scan.clone();
            let name = self.scan.text("the name of an array")?;
            let components = self.scan.count("a number of components")?;
            let count = self.scan.count("a number of points or cells")?;
            let before_kind = self.scan.clone();
            if self.scan.text("a type of numbers")?.eq_ignore_ascii_case("string") {
                return Err(before_kind.error("arrays of strings are not read: write the file without them"));
            }
            self.scan = before_kind;
            let kind = self.scan.kind()?;
            let expected = self.section.map_or(count, |(_, count)| count);
            if count != expected {
                let message = format!("the array {} has {count} tuples of {expected}", quoted(&name));
                return Err(before.error(message));
            }
            self.array((name, components, count), kind, &before)?;
        }
        Ok(())
    }

    /// Reads or skips the numbers of an array.
    fn array(
        &mut self,
        (name, components, count): (String, usize, usize),
        kind: Kind,
        before: &Scan<'_>,
    ) -> Result<(), FileError> {
        let numbers = components.saturating_mul(count);
        let Some((is_of_cells, _)) = self.section else { return self.scan.skip(numbers, (kind, "an array")) };
        if self.grid.fields.len() == MAX_FIELDS {
            return Err(before.error(format!("more than {MAX_FIELDS} arrays")));
        }
        let values = match self.wanted.needs(&name, components) {
            true => self.scan.numbers(numbers, (kind, "an array"), self.budget)?,
            false => {
                self.scan.skip(numbers, (kind, "an array"))?;
                Vec::new()
            }
        };
        let position = before.position();
        self.grid.fields.push(Field { name, components, is_of_cells, values, position });
        Ok(())
    }
}
