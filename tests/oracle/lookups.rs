//! Effects that read textures, images and neighbours along the ray, and their pictures, computed here in 64 bits from the quads.
#![allow(dead_code, reason = "each test binary uses a part of it")]

use fragbuf_model::{Variant, check};
use fragbuf_templates::Registry;

use super::numbers::Numbers;
use super::scene::{Quad, first_difference, quads};
use super::technique::BACKGROUND;

/// The width and height of the frames: not a multiple of a quad of pixels, of a tile, or of each other.
pub const SIZE: [u32; 2] = [13, 7];

/// A texture: its name in the description, columns, rows and slices, texels.
type TextureOf<'a> = (&'a str, [u32; 3], Vec<[f32; 4]>);

/// An effect with its textures.
pub struct Lookup {
    pub name: &'static str,
    pub variant: Variant,
    /// Name in the description, columns, rows and slices, texels.
    pub textures: Vec<TextureOf<'static>>,
    expected: fn(&Lookup, &Frame<'_>, [i64; 2]) -> Option<[f64; 4]>,
}

/// The quads of a frame.
struct Frame<'a> {
    quads: &'a [Quad],
}

impl Frame<'_> {
    /// Returns the quads over a pixel, nearest first.
    fn sorted(&self, [x, y]: [i64; 2]) -> Vec<&Quad> {
        let mut covering: Vec<&Quad> = self.quads.iter().filter(|quad| quad.covers(x as u32, y as u32)).collect();
        covering.sort_by(|one, other| one.depth.total_cmp(&other.depth));
        covering
    }
}

/// Returns every effect, over several storages.
pub fn lookups() -> Vec<Lookup> {
    let mut all = Vec::new();
    for storage in ["kplus_array", "ab_ll", "kb_ab_array"] {
        all.push(lookup("filters", FILTERS, storage, filtered_textures(), filtered));
        all.push(lookup("images", IMAGES, storage, Vec::new(), from_images));
    }
    for storage in ["kb_stream", "kplus_heap", "ab_sb"] {
        all.push(lookup("between", BETWEEN, storage, Vec::new(), between));
    }
    let tiled = IMAGES.replace("{ // axes", "{ addressing: tiled;");
    all.push(lookup("images in tiles", &tiled, "ab_array", Vec::new(), from_images));
    all
}

/// Returns quads of different depths, so that no tie decides.
pub fn scene(seed: u64) -> Vec<Quad> {
    let mut quads = quads(7, SIZE, &mut Numbers::seeded(seed));
    for (index, quad) in (0..).zip(&mut quads) {
        quad.depth = 0.0625 + 0.125 * ((index * 3) % 7) as f32;
    }
    quads
}

/// Fails if a picture is wrong.
pub fn assert_lookup(what: &str, lookup: &Lookup, seen: &[[f32; 4]], quads: &[Quad]) {
    let [width, height] = SIZE.map(i64::from);
    let frame = Frame { quads };
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| [x, y]));
    let expected: Vec<[f64; 3]> = pixels
        .map(|pixel| match (lookup.expected)(lookup, &frame, pixel) {
            None => BACKGROUND,
            Some([r, g, b, a]) => {
                let over = |channel: f64, behind: f64| channel + (1.0 - a) * behind;
                [over(r, BACKGROUND[0]), over(g, BACKGROUND[1]), over(b, BACKGROUND[2])]
            }
        })
        .collect();
    assert_eq!(first_difference(seen, &expected), None, "{what}: {}", lookup.name);
    let differs = expected.iter().filter(|color| **color != BACKGROUND).count();
    assert!(differs > 10, "{what}: {}: {differs} pixels show the effect", lookup.name);
}

fn lookup(
    name: &'static str,
    text: &str,
    storage: &str,
    textures: Vec<TextureOf<'static>>,
    expected: fn(&Lookup, &Frame<'_>, [i64; 2]) -> Option<[f64; 4]>,
) -> Lookup {
    // No software driver has an interlock, which the technique prefers.
    let keep = match storage {
        "kb_stream" => "keep 8; sync: spin_lock;",
        _ if storage.starts_with("ab_") => "",
        _ => "keep 8;",
    };
    let text = text.replace("STORAGE", storage).replace("KEEP", keep);
    let parsed = fragbuf_syntax::parse(&text, "lookups.fragbuf");
    assert!(parsed.diagnostics.is_empty(), "{}", parsed.diagnostics);
    let variant = check(&parsed.draft.unwrap(), &Registry::builtin()).unwrap_or_else(|errors| panic!("{errors}"));
    Lookup { name, variant, textures, expected }
}

const FILTERS: &str = "buffer Filters from STORAGE {
    KEEP
    texture { lut: 2d, volume: 3d }
    fn flat(d: f32, u: Uniforms) -> Vec4 { u.lut.sample(vec2(1.4 * d - 0.2, 0.3 + 0.5 * d)) }
    resolve |fragments, u| {
        let d = fragments[0].depth;
        let solid = u.volume.sample(vec3(d, 0.9 - d, 1.3 * d));
        let corners = u.lut.load(-3, 1) + u.volume.load(1, 9, 2);
        let nearest = u.lut.sample_nearest(vec2(d, 0.7)) + u.volume.sample_nearest(vec3(0.4, d, 0.9));
        let lengths = (u.lut.width() + 2 * u.lut.height() + 4 * u.volume.depth()) as f32;
        let mixed = 0.3 * flat(d, u) + 0.3 * solid + 0.1 * corners + 0.05 * nearest;
        vec4(mixed.x, mixed.y, 0.5 * mixed.z + 0.02 * lengths, 1.0)
    }
}";

fn filtered_textures() -> Vec<TextureOf<'static>> {
    let mut numbers = Numbers::seeded(77);
    let mut texels = |count: usize| -> Vec<[f32; 4]> {
        (0..count).map(|_| std::array::from_fn(|_| numbers.below(1000) as f32 / 1000.0)).collect()
    };
    vec![("lut", [3, 2, 1], texels(6)), ("volume", [3, 2, 4], texels(24))]
}

fn filtered(lookup: &Lookup, frame: &Frame<'_>, pixel: [i64; 2]) -> Option<[f64; 4]> {
    let d = f64::from(frame.sorted(pixel).first()?.depth);
    let (lut, volume) = (&lookup.textures[0], &lookup.textures[1]);
    let flat = linear(lut, [1.4 * d - 0.2, 0.3 + 0.5 * d, 0.5]);
    let solid = linear(volume, [d, 0.9 - d, 1.3 * d]);
    let corners = sum(texel(lut, [-3, 1, 0]), texel(volume, [1, 9, 2]));
    let place = |at: f64, length: f64| (at * length).floor() as i64;
    let nearest =
        sum(texel(lut, [place(d, 3.0), 1, 0]), texel(volume, [place(0.4, 3.0), place(d, 2.0), place(0.9, 4.0)]));
    let mixed: [f64; 4] =
        std::array::from_fn(|i| 0.3 * flat[i] + 0.3 * solid[i] + 0.1 * corners[i] + 0.05 * nearest[i]);
    Some([mixed[0], mixed[1], 0.5 * mixed[2] + 0.02 * (3.0 + 2.0 * 2.0 + 4.0 * 4.0), 1.0])
}

fn sum(one: [f64; 4], other: [f64; 4]) -> [f64; 4] {
    std::array::from_fn(|i| one[i] + other[i])
}

/// Returns the texel that is nearest to coordinates.
fn texel((_, size, texels): &TextureOf<'_>, at: [i64; 3]) -> [f64; 4] {
    let [x, y, z] = std::array::from_fn(|axis| at[axis].clamp(0, i64::from(size[axis]) - 1) as usize);
    texels[(z * size[1] as usize + y) * size[0] as usize + x].map(f64::from)
}

/// Returns the mean of the texels around a place, each weighted by its distance to the place along every axis.
fn linear(texture: &TextureOf<'_>, at: [f64; 3]) -> [f64; 4] {
    let mut mean = [0.0; 4];
    let place: [f64; 3] = std::array::from_fn(|axis| at[axis].clamp(0.0, 1.0) * f64::from(texture.1[axis]) - 0.5);
    for corner in 0..8 {
        let at: [i64; 3] = std::array::from_fn(|axis| place[axis].floor() as i64 + (corner >> axis & 1));
        let weight: f64 = (0..3).map(|axis| 1.0 - (place[axis] - at[axis] as f64).abs()).product();
        let value = texel(texture, at);
        mean = std::array::from_fn(|i| mean[i] + weight * value[i]);
    }
    mean
}

const IMAGES: &str = "buffer Images from STORAGE { // axes
    KEEP
    image near |fragments| vec4(fragments[0].depth, fragments.len() as f32, 0.0, 1.0);
    image edges |fragments, u| {
        let dx = u.near.at(1, 0) - u.near.at(-1, 0);
        let dy = u.near.at(0, 2) - u.near.at(0, -2);
        vec4(dx.x, dy.x, dx.y, u.near.at(0, 0).y)
    }
    resolve |fragments, u| {
        let here = u.edges.at(0, 0);
        let far = u.edges.at(-40, 3);
        let size = (u.near.width() + 3 * u.near.height()) as f32;
        vec4(0.5 + 0.4 * here.x, 0.5 + 0.4 * here.y + 0.01 * far.z, 0.1 * far.w + 0.01 * size, 1.0)
    }
}";

/// Returns the value of the image `near`: 0 where there are no fragments.
fn near(frame: &Frame<'_>, at: [i64; 2]) -> [f64; 2] {
    let [width, height] = SIZE.map(i64::from);
    let sorted = frame.sorted([at[0].clamp(0, width - 1), at[1].clamp(0, height - 1)]);
    sorted.first().map_or([0.0; 2], |first| [f64::from(first.depth), sorted.len() as f64])
}

/// Returns the value of the image `edges`.
fn edges(frame: &Frame<'_>, at: [i64; 2]) -> [f64; 4] {
    let [width, height] = SIZE.map(i64::from);
    let [x, y] = [at[0].clamp(0, width - 1), at[1].clamp(0, height - 1)];
    if frame.sorted([x, y]).is_empty() {
        return [0.0; 4];
    }
    let (right, left) = (near(frame, [x + 1, y]), near(frame, [x - 1, y]));
    let (below, above) = (near(frame, [x, y + 2]), near(frame, [x, y - 2]));
    [right[0] - left[0], below[0] - above[0], right[1] - left[1], near(frame, [x, y])[1]]
}

fn from_images(_: &Lookup, frame: &Frame<'_>, [x, y]: [i64; 2]) -> Option<[f64; 4]> {
    frame.sorted([x, y]).first()?;
    let (here, far) = (edges(frame, [x, y]), edges(frame, [x - 40, y + 3]));
    let size = f64::from(SIZE[0] + 3 * SIZE[1]);
    Some([0.5 + 0.4 * here[0], 0.5 + 0.4 * here[1] + 0.01 * far[2], 0.1 * far[3] + 0.01 * size, 1.0])
}

const BETWEEN: &str = "buffer Between from STORAGE {
    KEEP
    between |front, back, gap| {
        let a = 0.25 + 0.5 * gap;
        let mixed = 0.75 * front.color.truncate() + 0.25 * back.color.truncate();
        (a * mixed).extend(a)
    }
}";

fn between(_: &Lookup, frame: &Frame<'_>, pixel: [i64; 2]) -> Option<[f64; 4]> {
    let sorted = frame.sorted(pixel);
    sorted.first()?;
    let (mut color, mut passes) = ([0.0; 3], 1.0);
    for (index, front) in sorted.iter().enumerate() {
        // The last fragment is its own neighbour.
        let back = sorted.get(index + 1).unwrap_or(front);
        let a = 0.25 + 0.5 * f64::from(back.depth - front.depth);
        for (channel, sum) in color.iter_mut().enumerate() {
            let [near, far] = [front, back].map(|quad| f64::from(quad.color[channel]) / 255.0);
            *sum += passes * a * (0.75 * near + 0.25 * far);
        }
        passes *= 1.0 - a;
    }
    Some([color[0], color[1], color[2], 1.0 - passes])
}
