//! Unstructured grids of VTK: both formats, each encoding, the division of cells, attributes, and malformed files.
#![allow(missing_docs, reason = "tests are read, not documented")]
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use fragbuf_scene::{AttributeRequest, Error, FilePosition, Limits, Object, Scene, load_with};

use vtk_files::{ASCII, Storage, files, xml};

mod vtk_files;

const COLOR: [f32; 4] = [0.5, 0.5, 0.5, 0.25];

fn attribute(name: &str, components: usize, is_integer: bool) -> AttributeRequest {
    AttributeRequest { name: name.to_owned(), components, is_integer, is_optional: false }
}

fn read(name: &str, bytes: &[u8], attributes: &[AttributeRequest]) -> Result<Scene, Error> {
    let folder = tempfile::TempDir::new().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).unwrap();
    load_with(&path, COLOR, attributes, &Limits::default())
}

/// Returns the position and the message of an error.
fn malformed(name: &str, text: &str) -> (FilePosition, String) {
    match read(name, text.as_bytes(), &[]) {
        Err(Error::Malformed { position, message, .. }) => (position, message),
        other => panic!("{text}: {other:?}"),
    }
}

fn floats(words: &[u32]) -> Vec<f32> {
    words.iter().map(|word| f32::from_bits(*word)).collect()
}

#[test]
fn every_encoding_has_the_same_faces_and_attributes() {
    let requests = [
        attribute("heat", 1, false),
        attribute("flow", 3, false),
        attribute("boundary", 1, true),
        attribute("heat_gradient", 3, false),
    ];
    for (index, (name, bytes)) in files().into_iter().enumerate() {
        let scene = read(name, &bytes, &requests).unwrap_or_else(|error| panic!("file {index}: {error}"));
        let [object] = scene.objects.as_slice() else { panic!("{scene:?}") };
        // Six faces of the surface with five points, and one face inside with three of its own.
        assert_eq!((object.triangles.len(), object.positions.len()), (7, 8), "file {index}");
        assert_eq!(object.colors, [COLOR; 8]);
        let [heat, flow, boundary, gradient] = object.attributes.as_slice() else { panic!("file {index}") };
        for (at, position) in object.positions.iter().enumerate() {
            let corner = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0; 3]];
            let corner = corner.iter().position(|corner| corner == position).unwrap();
            assert_eq!(f32::from_bits(heat[at]), 0.25 * corner as f32, "file {index}");
            let expected = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0; 3], [2.0; 3]][corner];
            assert_eq!(floats(&flow[3 * at..3 * at + 3]), expected, "file {index}");
        }
        let surface = object.triangles.iter().filter(|corners| boundary[corners[0] as usize] == 1).count();
        assert_eq!(surface, 6, "file {index}");
        assert!(floats(gradient).iter().all(|axis| (0.0..1.0).contains(axis)), "file {index}: {gradient:?}");
        assert_eq!(scene.warnings.len(), 1, "{:?}", scene.warnings);
        assert!(scene.warnings[0].message.contains("cells of the type 5"), "{:?}", scene.warnings);
    }
}

#[test]
fn data_of_cells_has_a_vertex_per_face() {
    for (name, bytes) in files() {
        let scene = read(name, &bytes, &[attribute("label", 1, true), attribute("weights", 2, false)]).unwrap();
        let object = &scene.objects[0];
        assert_eq!((object.triangles.len(), object.positions.len()), (7, 21));
        // The face inside belongs to the first tetrahedron.
        assert_eq!(object.attributes[0], [[7; 12].as_slice(), &[9; 9]].concat());
        let weights: Vec<[f32; 2]> = [[[1.0, 2.0]; 12].as_slice(), &[[3.0, 4.0]; 9]].concat();
        assert_eq!(floats(&object.attributes[1]), weights.concat());
    }
}

#[test]
fn missing_attributes_list_those_of_the_file() {
    for (name, bytes) in files() {
        let error = read(name, &bytes, &[attribute("speed", 1, false)]);
        let Err(Error::MissingAttribute { available, .. }) = error else { panic!("{error:?}") };
        let names: Vec<&str> = available.iter().map(|attribute| attribute.name.as_str()).collect();
        assert_eq!(names, ["heat", "heat_gradient", "flow", "label", "weights", "boundary"]);
    }
}

/// Returns the volume that the triangles of the surface enclose.
fn volume(object: &Object) -> f64 {
    let one = |corners: &[u32; 3]| {
        let [a, b, c] = corners.map(|index| object.positions[index as usize].map(f64::from));
        a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])
    };
    let boundary = &object.attributes[0];
    let surface = object.triangles.iter().filter(|corners| boundary[corners[0] as usize] == 1);
    surface.map(one).sum::<f64>() / 6.0
}

/// Cells of every shape, whose points are numbered in different orders: their tetrahedra fill them, and neighbours share faces.
#[test]
fn other_cells_are_divided_into_tetrahedra() {
    // Two unit cubes side by side, the second divided into a pyramid of its left side and two wedges in its right half.
    let points: [[f64; 3]; 13] = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [1.0, 0.0, 1.0],
        [1.0, 1.0, 1.0],
        [0.0, 1.0, 1.0],
        [2.0, 0.0, 0.0],
        [2.0, 1.0, 0.0],
        [2.0, 0.0, 1.0],
        [2.0, 1.0, 1.0],
        [3.0, 0.5, 0.5],
    ];
    // A hexahedron or a voxel, two wedges, and a pyramid on the right.
    let hexahedron = (12, vec![0, 1, 2, 3, 4, 5, 6, 7]);
    let voxel = (11, vec![0, 1, 3, 2, 4, 5, 7, 6]);
    let wedges = [(13, vec![1, 8, 2, 5, 10, 6]), (13, vec![8, 9, 2, 10, 11, 6])];
    let pyramid = (14, vec![8, 9, 11, 10, 12]);
    let expected = 1.0 + 1.0 + 1.0 / 3.0;
    for first in [hexahedron, voxel] {
        let cells = [vec![first], wedges.to_vec(), vec![pyramid.clone()]].concat();
        // Rotated numbers of points change which point is the least.
        for turn in 0..13 {
            let index = |at: usize| (at + turn) % 13;
            let mut turned = [[0.0; 3]; 13];
            points.iter().enumerate().for_each(|(at, point)| turned[index(at)] = *point);
            let lines: String = turned.iter().map(|[x, y, z]| format!("{x} {y} {z}\n")).collect();
            let size: usize = cells.iter().map(|(_, corners)| corners.len() + 1).sum();
            let list: String = cells
                .iter()
                .map(|(_, corners)| {
                    let words: Vec<String> = corners.iter().map(|at| index(*at).to_string()).collect();
                    format!("{} {}\n", corners.len(), words.join(" "))
                })
                .collect();
            let types: String = cells.iter().map(|(number, _)| format!("{number}\n")).collect();
            let text = format!(
                "# vtk DataFile Version 2.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 13 float\n{lines}CELLS {} {size}\n{list}CELL_TYPES {}\n{types}",
                cells.len(),
                cells.len()
            );
            let scene = read("g.vtk", text.as_bytes(), &[attribute("boundary", 1, true)]).unwrap();
            let object = &scene.objects[0];
            assert!((volume(object) - expected).abs() < 1.0e-6, "turn {turn}: {}", volume(object));
            // The outside of the three bodies: 5 + 4 sides of quadrilaterals, and 4 triangles of the pyramid.
            let surface = object.triangles.iter().filter(|corners| object.attributes[0][corners[0] as usize] == 1);
            assert_eq!(surface.count(), 2 * 9 + 4, "turn {turn}");
        }
    }
}

#[test]
fn malformed_files_are_errors_with_positions() {
    let change = |from: &str, to: &str| {
        assert!(ASCII.contains(from), "{from}");
        ASCII.replace(from, to)
    };
    let cases = [
        (change("ASCII", "TEXT"), 3, "`TEXT` is not `ASCII` or `BINARY`"),
        (change("UNSTRUCTURED_GRID", "POLYDATA"), 4, "only an UNSTRUCTURED_GRID has tetrahedra"),
        (change("POINTS 5", "POINTS 4000000000"), 6, "12000000000 numbers are declared for the points"),
        (change("POINTS 5 float", "POINTS 5 half"), 5, "`half` is not a type of numbers"),
        (change("POINTS 5", "POINTS -5"), 5, "`-5` is not the number of points"),
        (change("0 0 1\n1 1 1", "0 0 one\n1 1 1"), 7, "`one` is not a number"),
        (change("0 0 1\n1 1 1", "0 0 inf\n1 1 1"), 5, "point 3 is not finite"),
        (change("4 1 2 3 4", "4 1 2 3 5"), 9, "cell 1 has no point 5: the grid has 5"),
        (change("4 1 2 3 4", "4 1 2 3 -1"), 9, "cell 1 has no point -1"),
        (change("3 0 1 2\n", "30 1 2 3\n"), 9, "cell 2 has 30 points, and the list of cells has 14 numbers"),
        (change("10\n10\n5", "5\n5\n5"), 9, "the grid has no tetrahedra: give a grid of tetrahedra"),
        (change("10\n10\n5", "10\n12\n5"), 9, "cell 1 of the type 12 has 4 points of 8"),
        (change("CELL_TYPES 3\n10\n10\n5", "CELL_TYPES 2\n10\n10"), 9, "3 cells have 2 types"),
        (change("POINT_DATA 5", "POINT_DATA 6"), 17, "data of 6 points, and the grid has 5"),
        (change("VECTORS flow", "ARROWS flow"), 21, "unknown statement `ARROWS`"),
        (change("label 1 3 int", "label 1 2 int"), 25, "the array `label` has 2 tuples of 3"),
    ];
    for (text, line, part) in cases {
        let (position, message) = malformed("g.vtk", &text);
        assert!(position == FilePosition::Line(line) && message.contains(part), "{position:?}: {message}, not {part}");
    }
    let (_, message) = malformed("g.vtk", ASCII.split("CELLS").next().unwrap());
    assert!(message.contains("ends without the statement `CELLS`"), "{message}");
    let (_, message) = malformed("g.vtk", ASCII.split("CELL_TYPES").next().unwrap());
    assert!(message.contains("ends without the statement `CELL_TYPES`"), "{message}");
}

#[test]
fn malformed_xml_is_an_error_with_a_line() {
    let whole = String::from_utf8(xml(Storage::Words)).unwrap();
    let change = |from: &str, to: &str| {
        assert!(whole.contains(from), "{from}");
        whole.replacen(from, to, 1)
    };
    let cases = [
        (change("</Piece>", ""), "invalid XML"),
        (change("header_type=\"UInt64\"", "header_type=\"Int8\""), "the `header_type` is not"),
        (
            change("header_type=\"UInt64\"", "compressor=\"vtkLZ4DataCompressor\""),
            "write the file with `vtkZLibDataCompressor`",
        ),
        (
            change("type=\"UnstructuredGrid\"", "type=\"PolyData\"").replace("UnstructuredGrid>", "PolyData>"),
            "only an `UnstructuredGrid`",
        ),
        (
            change("NumberOfPoints=\"5\"", "NumberOfPoints=\"6\""),
            "the array `Points`: 18 numbers are declared, and 31 bytes follow",
        ),
        (change("NumberOfPoints=\"5\"", "NumberOfPoints=\"4000000000\""), "numbers are declared"),
        (change("NumberOfCells=\"3\"", "NumberOfCells=\"x\""), "`NumberOfCells` is not a whole number"),
        (change("Name=\"offsets\"", "Name=\"ends\""), "no `DataArray` of the name `offsets`"),
        (change("type=\"UInt8\"", "type=\"Half\""), "`Half` is not a type of numbers"),
        (change("10 10 5", "10 ten 5"), "the array `types`: a word is not a number"),
        (change("format=\"ascii\"", "format=\"hex\"").replace("\"ascii\"", "\"hex\""), "the format `hex` is unknown"),
    ];
    for (text, part) in cases {
        let (position, message) = malformed("g.vtu", &text);
        assert!(
            matches!(position, FilePosition::Line(_)) && message.contains(part),
            "{position:?}: {message}, not {part}"
        );
    }
    let bomb = b"<?xml version=\"1.0\"?><!DOCTYPE a [<!ENTITY b \"cc\"><!ENTITY d \"&b;&b;\">]><VTKFile>&d;</VTKFile>";
    assert!(read("g.vtu", bomb, &[]).is_err_and(|error| error.to_string().contains("DTD")));
    let renamed = read("g.ply", ASCII.as_bytes(), &[]).unwrap_err().to_string();
    assert!(renamed.contains("the file is a VTK file, and its extension is .ply: rename it to .vtk"), "{renamed}");
    let other = read("g.vtk", b"solid cube", &[]).unwrap_err().to_string();
    assert!(other.contains("the file is an STL model"), "{other}");
    let other = read("g.vtu", b"hello", &[]).unwrap_err().to_string();
    assert!(other.contains("the file is no VTK, which begins with `# vtk DataFile`"), "{other}");
}

/// Parsing compares attributes and namespaces with each other, and each line, array and block of data is looked up: none of it takes long.
#[test]
fn large_documents_are_errors_at_once() {
    let start = std::time::Instant::now();
    let whole = String::from_utf8(xml(Storage::Words)).unwrap();
    let cases = [
        (
            whole.replace(
                "<Points>",
                &format!("<Points {}>", (0..200_000).map(|at| format!("a{at}=\"\" ")).collect::<String>()),
            ),
            "an element with more than 128 attributes",
        ),
        (
            whole.replace("<Points>", &(0..60_000).map(|at| format!("<a xmlns:b{at}=\"c{at}\">")).collect::<String>()),
            "more than 16 namespaces",
        ),
        (whole.replace("<Points>", &"<a>".repeat(400_000)), "invalid XML"),
        (
            whole.replace(
                "<Piece",
                &format!("{}<Piece", "<Piece NumberOfPoints=\"0\" NumberOfCells=\"0\"/>\n".repeat(100_000)),
            ),
            "`Piece` has no `Points`",
        ),
    ];
    for (text, part) in cases {
        let (position, message) = malformed("g.vtu", &text);
        assert!(
            matches!(position, FilePosition::Line(_)) && message.contains(part),
            "{position:?}: {message}, not {part}"
        );
    }
    assert!(start.elapsed().as_secs() < 20, "{:?}", start.elapsed());
    // A document takes its memory before it is parsed.
    let folder = tempfile::TempDir::new().unwrap();
    let path = folder.path().join("g.vtu");
    std::fs::write(&path, whole.replace("<Points>", &"<a/>".repeat(100_000))).unwrap();
    let limits = Limits { memory: 4 << 20, ..Limits::default() };
    assert!(matches!(load_with(&path, COLOR, &[], &limits), Err(Error::TooLarge { .. })));
}

/// Pieces follow each other, with points of their own. A piece without an array has zeros.
#[test]
fn pieces_are_one_grid() {
    let whole = String::from_utf8(xml(Storage::Words)).unwrap();
    let (begin, end) = (whole.find("<Piece").unwrap(), whole.find("</Piece>").unwrap() + 8);
    let piece = &whole[begin..end];
    let without = piece.replace("\"heat\"", "\"cold\"").replace("\"label\"", "\"other\"");
    let text = whole.replace(piece, &[&without, piece].concat());
    let scene = read("g.vtu", text.as_bytes(), &[attribute("heat", 1, false), attribute("boundary", 1, true)]).unwrap();
    let object = &scene.objects[0];
    assert_eq!((object.triangles.len(), object.positions.len()), (14, 16));
    assert_eq!(object.attributes[1].iter().filter(|word| **word == 1).count(), 10);
    let sum = |words: &[u32]| floats(words).iter().sum::<f32>();
    // Five points of the surface, and three of the face inside.
    assert_eq!((sum(&object.attributes[0][..8]), sum(&object.attributes[0][8..])), (0.0, 2.5 + 1.5));
    let scene = read("g.vtu", text.as_bytes(), &[attribute("label", 1, true)]).unwrap();
    let labels = [[0; 21].as_slice(), &[7; 12], &[9; 9]].concat();
    assert_eq!(scene.objects[0].attributes[0], labels);
}
