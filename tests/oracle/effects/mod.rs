//! Effects of `examples/effects` with references that share no code with the templates and the closures. The tests of hosts share this list.
//!
//! Input: the name of an effect. Output: its variants over several storages, the vertices of a small scene of solids, values of uniforms, and the
//! expected image: per pixel a ray, its intersections in `f64`, and the effect by the formulas of its paper. Insides of solids are winding
//! numbers by solid angles, which no closure computes. Pixels whose centre is at an edge, or where surfaces nearly touch, are not compared.
#![allow(dead_code, reason = "each test binary uses a part of it")]

mod colors;
mod crossings;
mod images;
mod layers;
mod particles;
mod ray;
mod shadows;
mod solids;
mod volumes;

use fragbuf_model::{SourceSpan, Variant, check};
use fragbuf_templates::Registry;

pub use ray::Ray;
pub use solids::{SIZE, Solids};

/// The opaque background of every image.
pub const BACKGROUND: [f64; 3] = [0.2, 0.4, 0.6];

/// An effect with its reference.
pub struct Effect {
    pub name: &'static str,
    text: &'static str,
    pub uniforms: &'static [(&'static str, Number)],
    /// Textures, each with a function that computes its texels.
    textures: &'static [(&'static str, fn(&Solids) -> Texels)],
    /// Techniques, each with its k; `None`: it keeps all fragments.
    storages: &'static [Storage],
    /// Returns the scene.
    scene: fn() -> Solids,
    /// A part of the description and what replaces it to give a wrong image.
    mutation: (&'static str, &'static str),
    color: Reference,
}

/// Returns the premultiplied colour of a ray that hits something.
enum Reference {
    OfRay(fn(&Ray<'_>) -> [f64; 4]),
    /// By the rays of other pixels as well; `None`: one of them is not compared.
    OfNeighbours(fn(&Ray<'_>) -> Option<[f64; 4]>),
}

/// A technique with its k; `None`: it keeps all fragments.
type Storage = (&'static str, Option<u32>);

/// The texels of a texture.
pub struct Texels {
    /// Columns, rows and slices.
    pub size: [u32; 3],
    /// Row after row from the top, slice after slice.
    pub values: Vec<[f32; 4]>,
}

/// The value of a uniform.
#[derive(Clone, Copy)]
pub enum Number {
    F32(f32),
    U32(u32),
    Vec3([f32; 3]),
    Vec4([f32; 4]),
}

impl Number {
    /// Returns the words of the value.
    pub fn words(self) -> Vec<u32> {
        match self {
            Number::F32(value) => vec![value.to_bits()],
            Number::U32(value) => vec![value],
            Number::Vec3(values) => values.map(f32::to_bits).to_vec(),
            Number::Vec4(values) => values.map(f32::to_bits).to_vec(),
        }
    }

    /// Returns the bytes of the value.
    pub fn bytes(self) -> Vec<u8> {
        self.words().into_iter().flat_map(u32::to_le_bytes).collect()
    }
}

/// A-buffers and k-buffers with more entries than a pixel has fragments.
const ALL: &[Storage] = &[("ab_ll", None), ("ab_sb", None), ("kplus_array", Some(16)), ("mdt32_coplanar", Some(16))];

/// The same, and peeling.
const PEELED: &[Storage] =
    &[("ab_ll", None), ("ab_sb", None), ("kplus_array", Some(16)), ("mdt32_coplanar", Some(16)), ("f2b_ll", None)];

/// The same as all, and a stream that restores any order of so few fragments.
const STREAMED: &[Storage] = &[
    ("kb_stream", Some(16)),
    ("ab_ll", None),
    ("ab_sb", None),
    ("kplus_array", Some(16)),
    ("mdt32_coplanar", Some(16)),
];

/// Storages for the two nearest fragments. Peeling keeps one fragment of equal depths, or all of them.
const TWO: &[Storage] = &[("kplus_array", Some(2)), ("ab_sb", None), ("mdt32_coplanar", Some(2)), ("f2b_ll", None)];

/// Storages for the nearest fragment.
const NEAREST: &[Storage] =
    &[("kplus_array", Some(1)), ("ab_sb", None), ("mdt32_coplanar", Some(1)), ("kplus_heap", Some(2))];

/// Names an effect with the text of its description.
macro_rules! effect {
    ($name:literal, $uniforms:expr, $scene:ident over $storages:expr, $mutation:expr, neighbours $color:expr) => {
        effect!($name, $uniforms, $scene over $storages, $mutation; Reference::OfNeighbours($color), &[])
    };
    ($name:literal, $uniforms:expr, textures $textures:expr, $scene:ident over $storages:expr, $mutation:expr, $color:expr) => {
        effect!($name, $uniforms, $scene over $storages, $mutation; $color, $textures)
    };
    ($name:literal, $uniforms:expr, $scene:ident over $storages:expr, $mutation:expr, $color:expr) => {
        effect!($name, $uniforms, $scene over $storages, $mutation; Reference::OfRay($color), &[])
    };
    ($name:literal, $uniforms:expr, $scene:ident over $storages:expr, $mutation:expr; $color:expr, $textures:expr) => {
        Effect {
            name: $name,
            text: include_str!(concat!("../../../examples/effects/", $name, ".fragbuf")),
            uniforms: $uniforms,
            textures: $textures,
            storages: $storages,
            scene: Solids::$scene,
            mutation: $mutation,
            color: $color,
        }
    };
}

/// Every effect.
pub const EFFECTS: &[Effect] = &[
    effect!(
        "transparency",
        &[("camera", Number::Vec3(layers::CAMERA)), ("alpha", Number::F32(layers::ALPHA))],
        open over PEELED,
        ("1.0 - sum.w", "1.01 - sum.w"),
        layers::transparency
    ),
    effect!(
        "translucency",
        &[("camera", Number::Vec3(layers::CAMERA)), ("absorption", Number::Vec3(layers::ABSORPTION))],
        closed over PEELED,
        ("powf(5.0)", "powf(4.0)"),
        layers::translucency
    ),
    effect!("wireframe", &[("width", Number::F32(layers::WIDTH)), ("alpha", Number::F32(layers::ALPHA))], open over PEELED, ("2.0 * f.edges", "1.5 * f.edges"), layers::wireframe),
    effect!("csg", &[("equal", Number::F32(1e-6))], closed over ALL, ("f.depth + u.equal", "f.depth - u.equal"), crossings::csg),
    effect!(
        "self_collision",
        &[("alpha", Number::F32(layers::ALPHA))],
        closed over ALL,
        ("> f.depth", ">= f.depth"),
        crossings::self_collision
    ),
    effect!("winding_number", &[("least", Number::F32(1e-4))], closed over ALL, ("number.max(greatest)", "number"), crossings::winding_number),
    effect!("self_trimmed", &[("rule", Number::U32(1))], closed over ALL, ("> f.depth", ">= f.depth"), crossings::self_trimmed),
    effect!(
        "coplanarity",
        &[],
        open over ALL,
        ("is_before || is_behind", "is_before"),
        colors::coplanarity
    ),
    effect!("depth_complexity", &[("most", Number::F32(colors::MOST))], open over ALL, ("0.95", "0.9"), colors::complexity),
    effect!(
        "volume",
        &[("density", Number::F32(volumes::DENSITY))],
        mesh over ALL,
        ("/ 3.0", "/ 2.9"),
        volumes::volume
    ),
    effect!(
        "volume_table",
        &[("length", Number::F32(volumes::LENGTH))],
        textures &[("table", volumes::table)],
        mesh over STREAMED,
        ("vec3(front.scalar, back.scalar", "vec3(back.scalar, front.scalar"),
        Reference::OfRay(volumes::volume_table)
    ),
    effect!(
        "isosurface",
        &[("value", Number::F32(volumes::VALUE)), ("alpha", Number::F32(layers::ALPHA))],
        mesh over ALL,
        ("lerp(back.scalar_gradient, at)", "lerp(back.scalar_gradient, 0.5)"),
        volumes::isosurface
    ),
    effect!(
        "particles",
        &[("value", Number::F32(particles::VALUE))],
        particles over ALL,
        ("offset.dot(offset)", "0.8 * offset.dot(offset)"),
        neighbours particles::particles
    ),
    effect!(
        "silhouettes",
        &[("camera", Number::Vec3(layers::CAMERA)), ("jump", Number::F32(images::JUMP))],
        open over NEAREST,
        ("> u.jump", "> 2.0 * u.jump"),
        neighbours images::silhouettes
    ),
    effect!(
        "depth_of_field",
        &[
            ("camera", Number::Vec3(layers::CAMERA)),
            ("near", Number::F32(images::NEAR)),
            ("far", Number::F32(images::FAR)),
        ],
        open over ALL,
        ("> u.far", "> 1.02 * u.far"),
        neighbours images::depth_of_field
    ),
    effect!(
        "midpoint",
        &[("near", Number::F32(colors::NEAR)), ("far", Number::F32(colors::FAR))],
        open over TWO,
        ("depths + 1.0", "depths + 0.9"),
        colors::midpoint
    ),
    effect!(
        "midpoint_shadows",
        shadows::UNIFORMS,
        textures &[("shadow", shadows::map)],
        open over NEAREST,
        ("depth <= 1.0 - map.x", "depth <= 0.999 - map.x"),
        Reference::OfNeighbours(shadows::midpoint_shadows)
    ),
];

impl Effect {
    /// Returns the effect over each of its storages.
    pub fn variants(&self) -> impl Iterator<Item = (String, Variant)> {
        self.storages.iter().map(|storage| (format!("{} over {}", self.name, storage.0), over(self.text, storage)))
    }

    /// Returns a variant of another image: a part of the description is changed.
    pub fn mutant(&self) -> Variant {
        let (part, other) = self.mutation;
        assert!(self.text.contains(part), "{}: no `{part}` to change", self.name);
        over(&self.text.replace(part, other), &self.storages[0])
    }

    /// Returns the textures of the description, by their names.
    pub fn textures(&self, solids: &Solids) -> Vec<(&'static str, Texels)> {
        self.textures.iter().map(|(name, texels)| (*name, texels(solids))).collect()
    }

    /// Returns the scene.
    pub fn solids(&self) -> Solids {
        (self.scene)()
    }

    /// Returns the expected colour of every pixel; `None`: it is not compared.
    pub fn expected(&self, solids: &Solids) -> Vec<Option<[f64; 3]>> {
        let pixels = (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| [x, y]));
        let image: Vec<Option<[f64; 3]>> = pixels
            .map(|pixel| {
                let ray = Ray::through(solids, pixel)?;
                let [r, g, b, a] = match self.color {
                    _ if ray.hits.is_empty() => [0.0; 4],
                    Reference::OfRay(color) => color(&ray),
                    Reference::OfNeighbours(color) => color(&ray)?,
                };
                Some(std::array::from_fn(|channel| [r, g, b][channel] + (1.0 - a) * BACKGROUND[channel]))
            })
            .collect();
        self.assert_varied(&image);
        image
    }

    /// Fails if an image differs from the expected one by more than 1/255 in a channel.
    pub fn assert_image(&self, what: &str, seen: &[[f32; 4]], expected: &[Option<[f64; 3]>]) {
        if let Some(difference) = difference(seen, expected) {
            panic!("{what}: {difference}");
        }
    }

    /// Fails if the scene shows too little of the effect, or too few pixels are compared.
    fn assert_varied(&self, image: &[Option<[f64; 3]>]) {
        let compared: Vec<[u32; 3]> = image.iter().flatten().map(|color| color.map(|c| (255.0 * c) as u32)).collect();
        let mut colors = compared.clone();
        colors.sort_unstable();
        colors.dedup();
        assert!(3 * compared.len() > 2 * image.len(), "{}: {} pixels are compared", self.name, compared.len());
        assert!(colors.len() >= 5, "{}: {} colours", self.name, colors.len());
    }
}

/// Returns a description over another technique.
fn over(text: &str, (technique, k): &Storage) -> Variant {
    let (_, buffer) = text.split_once("\nbuffer ").unwrap();
    let (head, body) = buffer.split_once(" {").unwrap();
    let (name, _) = head.split_once(" from ").unwrap();
    let parsed = fragbuf_syntax::parse(&format!("buffer {name} from {technique} {{ {body}"), name);
    assert!(parsed.diagnostics.is_empty(), "{technique}: {}", parsed.diagnostics);
    let mut draft = parsed.draft.unwrap();
    let k = k.map_or("all".to_owned(), |k| k.to_string());
    draft.set("k", &k, &SourceSpan::new("k", 1, 1)).unwrap();
    // Few drivers have the interlock that the stream prefers.
    if *technique == "kb_stream" {
        draft.set("sync", "spin_lock", &SourceSpan::new("sync", 1, 1)).unwrap();
    }
    check(&draft, &Registry::builtin()).unwrap_or_else(|errors| panic!("{technique}: {errors}"))
}

/// Returns the first pixel that differs by more than 1/255, described for people.
pub fn difference(seen: &[[f32; 4]], expected: &[Option<[f64; 3]>]) -> Option<String> {
    assert_eq!(seen.len(), expected.len());
    let compared =
        seen.iter().zip(expected).enumerate().filter_map(|(at, (seen, expected))| Some((at, seen, (*expected)?)));
    let mut differing = compared.filter(|(_, seen, expected)| {
        (0..3).any(|channel| (f64::from(seen[channel]) - expected[channel]).abs() > 1.0 / 255.0)
    });
    let (at, seen, expected) = differing.next()?;
    let (x, y) = (at as u32 % SIZE[0], at as u32 / SIZE[0]);
    Some(format!("pixel {x}, {y} is {:?}, not {expected:?}; {} others differ", &seen[..3], differing.count()))
}
