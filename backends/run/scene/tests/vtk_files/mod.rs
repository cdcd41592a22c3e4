//! The same grid of two tetrahedra in every encoding of VTK.

use std::io::Write as _;

use base64::Engine as _;

/// Two tetrahedra that share a face, and a triangle, which is not read.
pub const ASCII: &str = "# vtk DataFile Version 3.0\ntwo tetrahedra\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 float\n\
    0 0 0 1 0 0 0 1 0\n0 0 1\n1 1 1\nCELLS 3 14\n4 0 1 2 3\n4 1 2 3 4\n3 0 1 2\nCELL_TYPES 3\n10\n10\n5\n\
    POINT_DATA 5\nSCALARS heat float 1\nLOOKUP_TABLE default\n0 0.25 0.5 0.75 1\nVECTORS flow double\n1 0 0 0 1 0 0 0 1 1 1 1 2 2 2\n\
    CELL_DATA 3\nFIELD data 2\nlabel 1 3 int\n7 9 11\nweights 2 3 float\n1 2 3 4 5 6\n";

/// The same grid in a binary file of the version 5.1, big-endian.
fn binary() -> Vec<u8> {
    let mut bytes =
        b"# vtk DataFile Version 5.1\ntwo tetrahedra\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 double\n".to_vec();
    let points = [0.0_f64, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0];
    bytes.extend(points.map(f64::to_be_bytes).concat());
    bytes.extend(b"\nMETADATA\nINFORMATION 0\n\nCELLS 4 11\nOFFSETS vtktypeint64\n");
    bytes.extend([0_i64, 4, 8, 11].map(i64::to_be_bytes).concat());
    bytes.extend(b"\nCONNECTIVITY vtktypeint64\n");
    bytes.extend([0_i64, 1, 2, 3, 1, 2, 3, 4, 0, 1, 2].map(i64::to_be_bytes).concat());
    bytes.extend(b"\nCELL_TYPES 3\n");
    bytes.extend([10_i32, 10, 5].map(i32::to_be_bytes).concat());
    bytes.extend(b"\nPOINT_DATA 5\nSCALARS heat float\nLOOKUP_TABLE default\n");
    bytes.extend([0.0_f32, 0.25, 0.5, 0.75, 1.0].map(f32::to_be_bytes).concat());
    bytes.extend(b"\nVECTORS flow short\n");
    bytes.extend([1_i16, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2].map(i16::to_be_bytes).concat());
    bytes.extend(b"\nCELL_DATA 3\nSCALARS label unsigned_char 1\nLOOKUP_TABLE default\n\x07\x09\x0b\nFIELD more 1\nweights 2 3 float\n");
    bytes.extend([1.0_f32, 2.0, 3.0, 4.0, 5.0, 6.0].map(f32::to_be_bytes).concat());
    bytes
}

/// How an XML file stores its numbers.
#[derive(Clone, Copy, PartialEq)]
pub enum Storage {
    Words,
    Inline { is_joined: bool },
    Compressed,
    Raw,
    AppendedBase64,
}

/// Returns the same grid as XML.
pub fn xml(storage: Storage) -> Vec<u8> {
    let base64 = |bytes: &[u8]| base64::engine::general_purpose::STANDARD.encode(bytes);
    let mut appended: Vec<u8> = Vec::new();
    let mut array = |attributes: &str, numbers: &[f64], bytes: Vec<u8>| {
        let length = (bytes.len() as u64).to_le_bytes();
        let (format, text) = match storage {
            Storage::Words => {
                let words: Vec<String> = numbers.iter().map(f64::to_string).collect();
                ("ascii".to_owned(), words.join(" "))
            }
            Storage::Inline { is_joined: true } => ("binary".to_owned(), base64(&[&length[..], &bytes].concat())),
            Storage::Inline { .. } => ("binary".to_owned(), base64(&length) + &base64(&bytes)),
            Storage::Compressed => {
                let half = bytes.len().div_ceil(2);
                let blocks: Vec<Vec<u8>> = bytes
                    .chunks(half)
                    .map(|block| {
                        let mut encoder = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::default());
                        encoder.write_all(block).unwrap();
                        encoder.finish().unwrap()
                    })
                    .collect();
                let mut header = vec![blocks.len() as u64, half as u64, (bytes.len() % half) as u64];
                header.extend(blocks.iter().map(|block| block.len() as u64));
                let header: Vec<u8> = header.iter().flat_map(|number| number.to_le_bytes()).collect();
                ("binary".to_owned(), base64(&header) + &base64(&blocks.concat()))
            }
            Storage::Raw | Storage::AppendedBase64 => {
                let offset = appended.len();
                let data = [&length[..], &bytes].concat();
                appended.extend(if storage == Storage::Raw { data } else { base64(&data).into_bytes() });
                (format!("appended\" offset=\"{offset}"), String::new())
            }
        };
        format!("<DataArray {attributes} format=\"{format}\">\n{text}\n</DataArray>\n")
    };
    let of_f32 = |numbers: &[f64]| numbers.iter().flat_map(|number| (*number as f32).to_le_bytes()).collect();
    let of_i64 = |numbers: &[f64]| numbers.iter().flat_map(|number| (*number as i64).to_le_bytes()).collect();
    let of_u8 = |numbers: &[f64]| numbers.iter().map(|number| *number as u8).collect();
    let mut float = |name: &str, components: usize, numbers: &[f64]| {
        let attributes = format!("type=\"Float32\" Name=\"{name}\" NumberOfComponents=\"{components}\"");
        array(&attributes, numbers, of_f32(numbers))
    };
    let points = float("Points", 3, &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0]);
    let heat = float("heat", 1, &[0.0, 0.25, 0.5, 0.75, 1.0]);
    let flow = float("flow", 3, &[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0, 2.0, 2.0, 2.0]);
    let weights = float("weights", 2, &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
    let mut whole =
        |name: &str, numbers: &[f64]| array(&format!("type=\"Int64\" Name=\"{name}\""), numbers, of_i64(numbers));
    let connectivity = whole("connectivity", &[0.0, 1.0, 2.0, 3.0, 1.0, 2.0, 3.0, 4.0, 0.0, 1.0, 2.0]);
    let offsets = whole("offsets", &[4.0, 8.0, 11.0]);
    let label = whole("label", &[7.0, 9.0, 11.0]);
    let types = array("type=\"UInt8\" Name=\"types\"", &[10.0, 10.0, 5.0], of_u8(&[10.0, 10.0, 5.0]));
    let compressor = if storage == Storage::Compressed { " compressor=\"vtkZLibDataCompressor\"" } else { "" };
    let mut file = format!(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\"{compressor}>\n\
         <UnstructuredGrid><Piece NumberOfPoints=\"5\" NumberOfCells=\"3\">\n<PointData>{heat}{flow}</PointData>\n<CellData>{label}{weights}</CellData>\n\
         <Points>{points}</Points>\n<Cells>{connectivity}{offsets}{types}</Cells>\n</Piece></UnstructuredGrid>\n"
    )
    .into_bytes();
    if !appended.is_empty() {
        let encoding = if storage == Storage::Raw { "raw" } else { "base64" };
        file.extend(format!("<AppendedData encoding=\"{encoding}\">\n_").bytes());
        file.extend(appended);
        file.extend(b"\n</AppendedData>\n");
    }
    file.extend(b"</VTKFile>\n");
    file
}

const STORAGES: [Storage; 6] = [
    Storage::Words,
    Storage::Inline { is_joined: true },
    Storage::Inline { is_joined: false },
    Storage::Compressed,
    Storage::Raw,
    Storage::AppendedBase64,
];

/// Returns every file with the grid.
pub fn files() -> Vec<(&'static str, Vec<u8>)> {
    let legacy = [("g.vtk", ASCII.into()), ("g.vtk", ASCII.replace('\n', "\r\n").into()), ("g.vtk", binary())];
    legacy.into_iter().chain(STORAGES.map(|storage| ("g.vtu", xml(storage)))).collect()
}
