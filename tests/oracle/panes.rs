//! The expected image of the programs of hosts, computed without their code: overlapping panes of glass over white. The tests of
//! hosts share this file.

/// Depth and straight colour of each pane, which reaches from -0.2 to 0.8 and from -0.45 to 0.45 before it is turned.
const PANES: [(f64, [f64; 4]); 6] = [
    (0.6, [0.9, 0.2, 0.2, 0.5]),
    (0.3, [0.2, 0.8, 0.3, 0.5]),
    (0.8, [0.2, 0.3, 0.9, 0.5]),
    (0.1, [0.9, 0.8, 0.2, 0.3]),
    (0.9, [0.6, 0.2, 0.8, 0.6]),
    (0.5, [0.2, 0.8, 0.8, 0.4]),
];

/// Compares the image of a file with the panes. Pixels near an edge are not compared.
pub fn assert_panes(what: &str, (size, pixels): ([u32; 2], &[[u8; 3]]), has_rings: bool) {
    assert_eq!(pixels.len(), (size[0] * size[1]) as usize, "{what}");
    let mut compared = 0;
    for (index, pixel) in (0..).zip(pixels) {
        let (x, y) = (index % size[0], index / size[0]);
        let Some(expected) = expected([x, y], size, has_rings) else { continue };
        compared += 1;
        // Colours have 8 bits in memory and in the file.
        let is_near = pixel.iter().zip(expected).all(|(seen, wanted)| (f64::from(*seen) - 255.0 * wanted).abs() < 2.5);
        assert!(is_near, "{what}: pixel {x}, {y} is {pixel:?}, not {:?}", expected.map(|channel| 255.0 * channel));
    }
    assert!(compared > pixels.len() * 5 / 6, "{what}: {compared} of {} pixels", pixels.len());
}

/// Returns the colour of a pixel, or `None` near an edge. With the material of the example the glass has rings.
fn expected([x, y]: [u32; 2], size: [u32; 2], has_rings: bool) -> Option<[f64; 3]> {
    let [width, height] = size.map(f64::from);
    let [u, v] = [2.0 * (f64::from(x) + 0.5) / width - 1.0, 1.0 - 2.0 * (f64::from(y) + 0.5) / height];
    let mut layers: Vec<(f64, [f64; 4])> = Vec::new();
    for (index, (depth, mut color)) in PANES.into_iter().enumerate() {
        let (sin, cos) = (index as f64 * std::f64::consts::FRAC_PI_3).sin_cos();
        let across = u * width / height;
        let [along, up] = [across * cos + v * sin, v * cos - across * sin];
        let inside = (along + 0.2).min(0.8 - along).min(0.45 - up).min(up + 0.45);
        if inside.abs() < 0.01 {
            return None;
        }
        if inside > 0.0 {
            color[3] *= if has_rings { 0.75 + 0.25 * (60.0 * u.hypot(v)).sin() } else { 1.0 };
            layers.push((depth, color));
        }
    }
    // From the farthest to the nearest, over white.
    layers.sort_by(|one, other| other.0.total_cmp(&one.0));
    Some(layers.iter().fold([1.0; 3], |behind, (_, color)| {
        std::array::from_fn(|channel| color[3] * color[channel] + (1.0 - color[3]) * behind[channel])
    }))
}
