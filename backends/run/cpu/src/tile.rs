//! Tiles: the triangles that overlap each part of a slice of the frame, and the pixels that a triangle covers.
//!
//! Lists of triangles keep the submission order.

use std::ops::Range;

use fragbuf_templates::vocabulary::Coverage;

use crate::triangle::{PIXEL_CENTRE, Triangle, sample_positions};

/// The pixels along each side of a tile.
pub(crate) const SIDE: u32 = 16;

/// A part of the frame: `x0..x1`, `y0..y1`.
pub(crate) type Rectangle = [u32; 4];

/// The triangles of each tile that has any.
pub(crate) struct Bins {
    pub(crate) tiles: Vec<Bin>,
    /// The number of sorted triangles, the first of the list.
    pub(crate) sorted: usize,
    /// The numbers of triangles, tile after tile.
    numbers: Vec<u32>,
}

/// The range of the list that belongs to one tile.
pub(crate) struct Bin {
    pub(crate) rectangle: Rectangle,
    range: Range<usize>,
}

impl Bins {
    /// The bytes of an entry of the lists.
    pub(crate) const ENTRY: u64 = size_of::<u32>() as u64;

    /// Sorts triangles into the tiles of the rows `slice` of a frame, until the lists of the tiles have `limit` entries or more: a
    /// large frame has many tiles, and a triangle may touch all of them. Entries are counted before their list is allocated.
    pub(crate) fn of(triangles: &[Triangle], (width, height): (u32, u32), slice: &Range<u32>, limit: usize) -> Self {
        let columns = width.div_ceil(SIDE) as usize;
        let rows = (slice.len() as u32).div_ceil(SIDE) as usize;
        let mut ends = vec![0; columns * rows];
        let tile = |column: u32, row: u32| row as usize * columns + column as usize;
        let (mut sorted, mut entries) = (0, 0);
        for triangle in triangles {
            if entries >= limit {
                break;
            }
            sorted += 1;
            touch(triangle, (width, height), slice, |column, row| {
                ends[tile(column, row)] += 1;
                entries += 1;
            });
        }
        let mut begin = 0;
        for end in &mut ends {
            begin += *end;
            *end = begin - *end;
        }
        let mut numbers = vec![0; entries];
        for (number, triangle) in (0..).zip(triangles.iter().take(sorted)) {
            touch(triangle, (width, height), slice, |column, row| {
                let end = &mut ends[tile(column, row)];
                numbers[*end] = number;
                *end += 1;
            });
        }
        let mut tiles = Vec::new();
        let mut begin = 0;
        for (tile, end) in (0..).zip(ends) {
            let (x0, y0) = (tile % columns as u32 * SIDE, slice.start + tile / columns as u32 * SIDE);
            if end > begin {
                let rectangle = [x0, (x0 + SIDE).min(width), y0, (y0 + SIDE).min(slice.end)];
                tiles.push(Bin { rectangle, range: begin..end });
            }
            begin = end;
        }
        Bins { tiles, sorted, numbers }
    }

    /// Returns the bytes of the lists.
    pub(crate) fn bytes(&self) -> usize {
        size_of_val(self.numbers.as_slice())
    }

    /// Returns the numbers of the triangles of a tile, in submission order.
    pub(crate) fn triangles(&self, bin: &Bin) -> &[u32] {
        &self.numbers[bin.range.clone()]
    }
}

fn touch(triangle: &Triangle, size: (u32, u32), slice: &Range<u32>, mut tile: impl FnMut(u32, u32)) {
    let [x0, x1, y0, y1] = triangle.bounds(size);
    let (y0, y1) = (y0.max(slice.start), y1.min(slice.end));
    if x0 >= x1 || y0 >= y1 {
        return;
    }
    let first = slice.start;
    let (columns, rows) = (x0 / SIDE..=(x1 - 1) / SIDE, (y0 - first) / SIDE..=(y1 - 1 - first) / SIDE);
    let is_single = columns.start() == columns.end() && rows.start() == rows.end();
    for row in rows {
        for column in columns.clone() {
            let rectangle = [column * SIDE, (column + 1) * SIDE, first + row * SIDE, first + (row + 1) * SIDE];
            if is_single || triangle.may_touch(rectangle) {
                tile(column, row);
            }
        }
    }
}

/// A covered pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct CoveredPixel {
    pub(crate) x: u32,
    pub(crate) y: u32,
    /// The mask of covered samples.
    pub(crate) mask: u32,
}

/// Calls `pixel` for every pixel of the rectangle with a covered sample, row after row.
pub(crate) fn cover(
    triangle: &Triangle,
    rectangle: Rectangle,
    size: (u32, u32),
    (samples, coverage): (u32, Coverage),
    mut pixel: impl FnMut(CoveredPixel),
) {
    let bounds = triangle.bounds(size);
    let (x0, x1) = (bounds[0].max(rectangle[0]), bounds[1].min(rectangle[1]));
    let (y0, y1) = (bounds[2].max(rectangle[2]), bounds[3].min(rectangle[3]));
    let steps = triangle.steps();
    let by_centre = samples == 1 || coverage == Coverage::WholePixel;
    let all = u32::MAX >> (32 - samples);
    for y in y0..y1 {
        let mut edges = triangle.edges(x0, y, PIXEL_CENTRE);
        for x in x0..x1 {
            let mask = if by_centre {
                if (edges[0] | edges[1] | edges[2]) >= 0 { all } else { 0 }
            } else {
                covered(triangle, x, y, samples)
            };
            if mask != 0 {
                pixel(CoveredPixel { x, y, mask });
            }
            edges.iter_mut().zip(steps).for_each(|(edge, step)| *edge += step);
        }
    }
}

fn covered(triangle: &Triangle, x: u32, y: u32, samples: u32) -> u32 {
    let mut mask = 0;
    for (sample, offset) in sample_positions(samples).iter().enumerate() {
        let [a, b, c] = triangle.edges(x, y, *offset);
        mask |= u32::from((a | b | c) >= 0) << sample;
    }
    mask
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use super::*;
    use crate::triangle::{PIXEL_CENTRE, Vertex};

    const SIZE: (u32, u32) = (40, 24);

    /// Returns a triangle by its corners in pixels.
    fn triangle(corners: [(f32, f32); 3]) -> Option<Triangle> {
        let vertex = |(x, y): (f32, f32)| {
            let position = [2.0 * x / SIZE.0 as f32 - 1.0, 1.0 - 2.0 * y / SIZE.1 as f32, 0.5, 1.0];
            Vertex { position, words: 0 }
        };
        Triangle::new(corners.map(vertex), 0, 0, SIZE)
    }

    fn counts(triangles: &[Triangle], samples: u32) -> Vec<Vec<u32>> {
        let mut counts = vec![vec![0; samples as usize]; (SIZE.0 * SIZE.1) as usize];
        count(triangles, &(0..SIZE.1), usize::MAX, &mut counts);
        counts
    }

    /// Counts the covered samples in a slice, in batches of at most `limit` entries. Returns the number of batches.
    fn count(triangles: &[Triangle], slice: &Range<u32>, limit: usize, counts: &mut [Vec<u32>]) -> usize {
        let (mut rest, mut batches, samples) = (triangles, 0, counts[0].len() as u32);
        while !rest.is_empty() {
            let bins = Bins::of(rest, SIZE, slice, limit);
            for bin in &bins.tiles {
                for number in bins.triangles(bin) {
                    cover(&rest[*number as usize], bin.rectangle, SIZE, (samples, Coverage::PerSample), |covered| {
                        assert!(slice.contains(&covered.y), "row {} is outside of {slice:?}", covered.y);
                        let pixel = &mut counts[(covered.y * SIZE.0 + covered.x) as usize];
                        pixel.iter_mut().enumerate().for_each(|(sample, count)| *count += covered.mask >> sample & 1);
                    });
                }
            }
            rest = &rest[bins.sorted..];
            batches += 1;
        }
        batches
    }

    #[test]
    fn slices_and_divided_batches_cover_the_same_samples() {
        let corners = |seed: u64| {
            let mut number = numbers(seed);
            let mut corner = || (80.0 * number() - 20.0, 48.0 * number() - 12.0);
            [corner(), corner(), corner()]
        };
        let triangles: Vec<Triangle> = (0..60).filter_map(|seed| triangle(corners(seed))).collect();
        for samples in [1, 4] {
            let whole = counts(&triangles, samples);
            for (rows, limit) in [(24, 1), (24, 5), (1, usize::MAX), (7, 3), (16, 50)] {
                let mut sliced = vec![vec![0; samples as usize]; (SIZE.0 * SIZE.1) as usize];
                let slices = (0..SIZE.1).step_by(rows);
                let batches = slices.map(|first| {
                    let slice = first..SIZE.1.min(first + rows as u32);
                    count(&triangles, &slice, limit, &mut sliced)
                });
                let batches: Vec<usize> = batches.collect();
                assert!(sliced == whole, "slices of {rows} rows, batches of {limit} entries");
                assert_eq!(batches.iter().all(|count| *count == 1), limit == usize::MAX, "{batches:?}");
            }
        }
    }

    /// Returns a seeded generator of numbers from 0 to 1.
    fn numbers(seed: u64) -> impl FnMut() -> f32 {
        let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
        move || {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            (state >> 40) as f32 / (1u64 << 24) as f32
        }
    }

    #[test]
    fn triangles_around_a_point_cover_every_sample_once() {
        for seed in 0..200 {
            let mut number = numbers(seed);
            // Corners of the frame, and a point inside: often at the centre or the edge of a pixel.
            let step = [1.0, 2.0, 256.0, 1000.0][seed as usize % 4];
            let point =
                ((number() * SIZE.0 as f32 * step).round() / step, (number() * SIZE.1 as f32 * step).round() / step);
            let frame = [(0.0, 0.0), (SIZE.0 as f32, 0.0), (SIZE.0 as f32, SIZE.1 as f32), (0.0, SIZE.1 as f32)];
            let sides = (0..4).filter_map(|side| triangle([point, frame[side], frame[(side + 1) % 4]]));
            let triangles: Vec<Triangle> = sides.collect();
            for samples in [1, 2, 4, 8] {
                let counts = counts(&triangles, samples);
                assert!(counts.iter().flatten().all(|count| *count == 1), "seed {seed}, {samples} samples, {point:?}");
            }
        }
    }

    #[test]
    fn samples_on_edges_belong_to_top_and_left() {
        // Edges through pixel centres: 10 × 6 pixels are covered, the right column and the lower row are not.
        let corners = [(4.5, 3.5), (14.5, 3.5), (14.5, 9.5), (4.5, 9.5)];
        let halves = [[0, 1, 2], [0, 2, 3]].map(|half| triangle(half.map(|corner: usize| corners[corner])).unwrap());
        let counts = counts(&halves, 1);
        for y in 0..SIZE.1 {
            for x in 0..SIZE.0 {
                let inside = (4..14).contains(&x) && (3..9).contains(&y);
                assert_eq!(counts[(y * SIZE.0 + x) as usize][0], u32::from(inside), "pixel {x}, {y}");
            }
        }
    }

    #[test]
    fn coverage_is_exact_in_256ths() {
        // The centre of pixel (3, 3) is 1/256 inside, then on, then outside a right edge.
        for (edge, covered) in [(3.5 + 1.0 / 256.0, 1), (3.5, 0), (3.5 + 0.4 / 256.0, 0), (3.5 + 0.6 / 256.0, 1)] {
            let triangle = triangle([(edge, -50.0), (edge, 70.0), (-60.0, 10.0)]).unwrap();
            assert_eq!(counts(&[triangle], 1)[(3 * SIZE.0 + 3) as usize][0], covered, "{edge}");
        }
    }

    #[test]
    fn triangles_without_area_cover_nothing() {
        assert!(triangle([(1.0, 1.0), (5.0, 5.0), (9.0, 9.0)]).is_none());
        assert!(triangle([(1.0, 1.0), (1.001, 1.0), (1.0, 1.001)]).is_none());
    }

    #[test]
    fn whole_pixel_coverage_tests_the_centre() {
        let triangle = triangle([(2.6, 0.0), (2.6, 20.0), (-20.0, 10.0)]).unwrap();
        let mut masks = Vec::new();
        cover(&triangle, [0, 16, 8, 9], SIZE, (4, Coverage::WholePixel), |covered| {
            masks.push((covered.x, covered.mask))
        });
        assert_eq!(masks, [(0, 15), (1, 15), (2, 15)]);
        masks.clear();
        cover(&triangle, [0, 16, 8, 9], SIZE, (4, Coverage::PerSample), |covered| {
            masks.push((covered.x, covered.mask))
        });
        // The samples at 3/8 and 1/8 are left of 0.6.
        assert_eq!(masks, [(0, 15), (1, 15), (2, 0b0101)]);
    }

    #[test]
    fn weights_are_the_exact_fractions() {
        let at = |corners: [[f32; 4]; 3], x, y| {
            let triangle = Triangle::new(corners.map(|position| Vertex { position, words: 0 }), 0, 0, (4, 4)).unwrap();
            (triangle.weights(x, y, PIXEL_CENTRE), triangle.is_front)
        };
        // w increases from 1 on the left to 4 on the right; the centre of pixel 1 of 4 is at 3/8 of the screen.
        let corners = [[-1.0, -1.0, 0.0, 1.0], [4.0, -4.0, 4.0, 4.0], [-1.0, 1.0, 0.0, 1.0]];
        let (weights, is_front) = at(corners, 1, 2);
        assert!(is_front);
        // The corners are reordered, so the second weight is that of the right corner.
        let right = 0.375_f64;
        let exact = (right / 4.0) / (1.0 - right + right / 4.0);
        assert!((weights.linear[1] - right).abs() < 1e-12, "{weights:?}");
        assert!((f64::from(weights.perspective[1]) - exact).abs() < 1e-7, "{weights:?}");
        assert!((f64::from(weights.inverse_w) - (1.0 - right + right / 4.0)).abs() < 1e-7);
        assert!((weights.depth - 0.375).abs() < 1e-7, "depth is linear on the screen");
    }
}
