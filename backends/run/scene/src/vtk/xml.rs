//! XML files: the pieces of an unstructured grid. Data may be in its element, or behind the document in `AppendedData`.

use roxmltree::{Document, Node, ParsingOptions};

use super::Grid;
use super::fields::{Field, Wanted};
use super::numbers::Kind;
use super::xml_data::{Data, DataError, Encoding, numbers};
use crate::error::{FileError, FilePosition};
use crate::limits::Budget;
use crate::text::{foreign_message, quoted};
use crate::warnings::FileWarnings;

/// The memory that an element or an attribute of the document needs, at most.
const NODE: u64 = 160;

/// The greatest number of elements of the document, and of arrays of data.
const MAX_NODES: u32 = 1 << 20;
const MAX_FIELDS: usize = 4096;

/// The greatest number of quotation marks of an element, two per attribute, and of declarations of namespaces: parsing compares each with
/// the others.
const MAX_QUOTES: usize = 256;
const MAX_NAMESPACES: usize = 16;

/// A file without the data behind its document.
struct Xml<'a> {
    /// The offsets of line ends.
    lines: &'a [usize],
    encoding: Encoding,
    /// The data behind the document, and whether it is Base64.
    appended: &'a [u8],
    is_base64: bool,
    budget: &'a Budget,
}

/// Reads a file.
pub(super) fn read(
    bytes: &[u8],
    wanted: &Wanted<'_>,
    budget: &Budget,
    _warnings: FileWarnings<'_>,
) -> Result<Grid, FileError> {
    let (text, appended) = split(bytes);
    let marks = text.iter().filter(|byte| b"<\"'".contains(byte)).count() as u64;
    // Its texts are copied if they have references to characters.
    let _held = budget.hold(1, marks.saturating_mul(NODE) + 3 * text.len() as u64, "the document")?;
    check(text)?;
    let _lines =
        budget.hold(text.iter().filter(|byte| **byte == b'\n').count() as u64, 8, "the lines of the document")?;
    let lines: Vec<usize> = (0..text.len()).filter(|at| text.get(*at) == Some(&b'\n')).collect();
    let mut text = String::from_utf8(text.to_vec()).map_err(|error| {
        let line = 1 + text.iter().take(error.utf8_error().valid_up_to()).filter(|byte| **byte == b'\n').count();
        FileError::line(line, "the text is not UTF-8")
    })?;
    if appended.is_some() {
        text.push_str("</AppendedData></VTKFile>");
    }
    let options = ParsingOptions { nodes_limit: MAX_NODES, ..ParsingOptions::default() };
    let document = Document::parse_with_options(&text, options).map_err(|error| {
        FileError::line(error.pos().row as usize, format!("invalid XML: {}", foreign_message(&error)))
    })?;
    let root = document.root_element();
    let line = |node: Node<'_, '_>| line(&lines, node);
    let grid = root.children().find(|node| node.has_tag_name("UnstructuredGrid"));
    let Some(grid) = grid.filter(|_| root.has_tag_name("VTKFile")) else {
        let kind = root.attribute("type").unwrap_or_else(|| root.tag_name().name());
        let help = "only an `UnstructuredGrid` has tetrahedra; convert it, or give a surface as PLY";
        return Err(FileError::line(line(root), format!("the file has the type {}: {help}", quoted(kind))));
    };
    let element = root.children().find(|node| node.has_tag_name("AppendedData"));
    let is_base64 = element.and_then(|node| node.attribute("encoding")) != Some("raw");
    let encoding = encoding(root).map_err(|message| FileError::line(line(root), message))?;
    let xml = Xml { lines: &lines, encoding, appended: appended.unwrap_or_default(), is_base64, budget };
    let mut whole = Grid::default();
    for piece in grid.children().filter(|node| node.has_tag_name("Piece")) {
        xml.piece(piece, wanted, &mut whole)?;
    }
    if whole.cells_at.is_none() {
        return Err(FileError::line(line(grid), "the grid has no `Piece`"));
    }
    Ok(whole)
}

/// Returns the document without the data behind it, and this data.
fn split(bytes: &[u8]) -> (&[u8], Option<&[u8]>) {
    const BEGIN: &[u8] = b"<AppendedData";
    let Some(begin) = bytes.windows(BEGIN.len()).position(|window| window == BEGIN) else { return (bytes, None) };
    let after = |from: usize, mark: u8| {
        let rest = bytes.get(from..).unwrap_or_default();
        rest.iter().position(|byte| *byte == mark).map(|at| from + at + 1)
    };
    let Some(end) = after(begin, b'>') else { return (bytes, None) };
    let data = after(end, b'_').and_then(|data| bytes.get(data..));
    data.map_or((bytes, None), |data| (bytes.get(..end).unwrap_or(bytes), Some(data)))
}

fn line(lines: &[usize], node: Node<'_, '_>) -> usize {
    1 + lines.partition_point(|end| *end < node.range().start)
}

/// Rejects documents that take too long to parse.
fn check(text: &[u8]) -> Result<(), FileError> {
    let (mut quotes, mut line, mut namespaces) = (0, 1, 0);
    for (at, byte) in text.iter().enumerate() {
        match byte {
            b'\n' => line += 1,
            b'<' => quotes = 0,
            b'"' | b'\'' => quotes += 1,
            b'x' if text.get(at..).is_some_and(|rest| rest.starts_with(b"xmlns")) => namespaces += 1,
            _ => {}
        }
        if quotes > MAX_QUOTES {
            return Err(FileError::line(line, format!("an element with more than {} attributes", MAX_QUOTES / 2)));
        }
        if namespaces > MAX_NAMESPACES {
            return Err(FileError::line(line, format!("more than {MAX_NAMESPACES} namespaces")));
        }
    }
    Ok(())
}

fn encoding(root: Node<'_, '_>) -> Result<Encoding, String> {
    let header = root.attribute("header_type").unwrap_or("UInt32");
    let header = Kind::named(header).filter(|kind| matches!(kind, Kind::U32 | Kind::U64));
    let header = header.ok_or_else(|| "the `header_type` is not `UInt32` or `UInt64`".to_owned())?;
    let compressor = root.attribute("compressor").unwrap_or_default();
    if !["", "vtkZLibDataCompressor"].contains(&compressor) {
        let help = "write the file with `vtkZLibDataCompressor`, or without compression";
        return Err(format!("the compressor {} is not read: {help}", quoted(compressor)));
    }
    let is_big = root.attribute("byte_order") == Some("BigEndian");
    Ok(Encoding { is_big, header, is_compressed: !compressor.is_empty() })
}

impl Xml<'_> {
    fn error(&self, node: Node<'_, '_>, message: impl Into<String>) -> FileError {
        FileError::line(line(self.lines, node), message)
    }

    /// Adds a piece to the grid.
    fn piece(&self, piece: Node<'_, '_>, wanted: &Wanted<'_>, grid: &mut Grid) -> Result<(), FileError> {
        let count = |name: &str| {
            let count = piece.attribute(name).and_then(|count| count.trim().parse::<u32>().ok());
            count
                .map(|count| count as usize)
                .ok_or_else(|| self.error(piece, format!("`{name}` is not a whole number")))
        };
        let (points, cells) = (count("NumberOfPoints")?, count("NumberOfCells")?);
        let (first_point, first_end) = ((grid.points.len() / 3) as f64, grid.connectivity.len() as f64);
        let position = |node: Node<'_, '_>| FilePosition::Line(line(self.lines, node));
        let element = self.child(piece, "Points")?;
        grid.points_at.get_or_insert(position(element));
        let array = element.children().find(|node| node.has_tag_name("DataArray"));
        let array = array.ok_or_else(|| self.error(element, "`Points` has no `DataArray`"))?;
        grid.points.extend(self.numbers(array, points.saturating_mul(3))?);
        let element = self.child(piece, "Cells")?;
        grid.cells_at.get_or_insert(position(element));
        let ends = self.numbers(self.named(element, "offsets")?, cells)?;
        let length = ends.last().copied().unwrap_or_default().max(0.0) as usize;
        let connectivity = self.numbers(self.named(element, "connectivity")?, length)?;
        grid.connectivity.extend(
            connectivity.into_iter().map(|point| if point < points as f64 { point + first_point } else { -1.0 }),
        );
        grid.ends.extend(ends.into_iter().map(|end| end + first_end));
        grid.types.extend(self.numbers(self.named(element, "types")?, cells)?);
        let before = (first_point as usize, grid.types.len() - cells);
        self.fields(piece, wanted, (grid, before), (points, cells))
    }

    /// Adds the data of a piece. `before` are the points and the cells of earlier pieces.
    fn fields(
        &self,
        piece: Node<'_, '_>,
        wanted: &Wanted<'_>,
        (grid, before): (&mut Grid, (usize, usize)),
        (points, cells): (usize, usize),
    ) -> Result<(), FileError> {
        for (tag, is_of_cells) in [("PointData", false), ("CellData", true)] {
            let arrays = piece.children().filter(|node| node.has_tag_name(tag)).flat_map(|node| node.children());
            for array in arrays.filter(|node| node.has_tag_name("DataArray")) {
                let name = array.attribute("Name").unwrap_or_default().to_owned();
                let components = array.attribute("NumberOfComponents").unwrap_or("1").trim().parse::<u32>();
                let components =
                    components.map_err(|_| self.error(array, "`NumberOfComponents` is no whole number"))? as usize;
                let (count, earlier) = if is_of_cells { (cells, before.1) } else { (points, before.0) };
                let values = match wanted.needs(&name, components) {
                    true => self.numbers(array, count.saturating_mul(components))?,
                    false => Vec::new(),
                };
                let is_same = |field: &Field| {
                    field.is_of_cells == is_of_cells && field.name == name && field.components == components
                };
                // Pieces without the array have zeros.
                let index = grid.fields.iter().position(is_same).unwrap_or(grid.fields.len());
                if index == MAX_FIELDS {
                    return Err(self.error(array, format!("more than {MAX_FIELDS} arrays")));
                }
                if index == grid.fields.len() {
                    let position = FilePosition::Line(line(self.lines, array));
                    grid.fields.push(Field { name, components, is_of_cells, values: Vec::new(), position });
                }
                let Some(field) = grid.fields.get_mut(index) else { continue };
                if !values.is_empty() {
                    let earlier = earlier.saturating_mul(components);
                    let missing = earlier.saturating_sub(field.values.len());
                    self.budget.take(missing as u64, 8, "the numbers of an array")?;
                    field.values.resize(earlier, 0.0);
                    field.values.extend(values);
                }
            }
        }
        Ok(())
    }

    fn child<'n>(&self, node: Node<'n, 'n>, tag: &str) -> Result<Node<'n, 'n>, FileError> {
        let child = node.children().find(|child| child.has_tag_name(tag));
        child.ok_or_else(|| self.error(node, format!("`{}` has no `{tag}`", node.tag_name().name())))
    }

    fn named<'n>(&self, node: Node<'n, 'n>, name: &str) -> Result<Node<'n, 'n>, FileError> {
        let child = node.children().find(|child| child.attribute("Name") == Some(name));
        child.ok_or_else(|| self.error(node, format!("`Cells` has no `DataArray` of the name `{name}`")))
    }

    /// Returns the numbers of a `DataArray`.
    fn numbers(&self, array: Node<'_, '_>, count: usize) -> Result<Vec<f64>, FileError> {
        if count == 0 {
            return Ok(Vec::new());
        }
        let kind = array.attribute("type").unwrap_or_default();
        let kind = Kind::named(kind)
            .ok_or_else(|| self.error(array, format!("{} is not a type of numbers: use Float32", quoted(kind))))?;
        let text = array.text().unwrap_or_default();
        let data = match array.attribute("format").unwrap_or("ascii") {
            "ascii" => Data::Words(text),
            "binary" => Data::Base64(text.trim().as_bytes()),
            "appended" => {
                let offset = array.attribute("offset").and_then(|offset| offset.trim().parse::<usize>().ok());
                let data = offset.and_then(|offset| self.appended.get(offset..));
                let data = data.ok_or_else(|| self.error(array, "its `offset` is not in the appended data"))?;
                if self.is_base64 { Data::Base64(data) } else { Data::Bytes(data) }
            }
            other => return Err(self.error(array, format!("the format {} is unknown", quoted(other)))),
        };
        numbers(data, (count, kind), self.encoding, self.budget).map_err(|error| match error {
            DataError::Memory(error) => error,
            DataError::Message(message) => {
                let name = array.attribute("Name").unwrap_or("Points");
                self.error(array, format!("the array {}: {message}", quoted(name)))
            }
        })
    }
}
