//! Slices of rows: the image of every technique is that of the whole frame, memory is that of a slice, and a budget that is too
//! small is an error with its numbers.

use std::sync::Arc;

use fragbuf_cpu::{Code, Device, Error, FragmentOrder, Mesh, Picture, Settings};
use fragbuf_frame::{Error as FrameError, MemoryNeed, PoolSize, Sizing, resource_bytes};
use fragbuf_model::{Draft, SourceSpan};
use fragbuf_templates::Registry;

use crate::stage::{Triangle, built_in_of, mesh, quad};

const WIDTH: u32 = 19;
const HEIGHT: u32 = 23;

/// Compiles a technique that counts every event.
fn code(registry: &Registry, key: &str) -> Arc<Code> {
    let span = SourceSpan::new(key, 1, 1);
    let mut draft = Draft::from_technique(key, &span);
    draft.set("counters", "all", &span).unwrap();
    Arc::new(built_in_of(&draft, registry))
}

/// Quads over the whole frame and over parts of it, and triangles that cross.
fn scene() -> (Vec<u32>, Vec<u32>) {
    let mut triangles: Vec<Triangle> = Vec::new();
    for layer in 0..5 {
        let (at, color) = (0.1 + 0.15 * layer as f32, [0.2 * layer as f32, 0.9 - 0.2 * layer as f32, 0.5, 0.4]);
        triangles.extend(quad([layer, 16 - layer, 2 * layer, 16], at, color));
    }
    triangles.extend(quad([0, 16, 0, 16], 0.95, [0.1, 0.3, 0.2, 0.5]));
    let corners = [[1.0, 0.0, 0.0], [15.0, 9.0, 1.0], [3.0, 16.0, 0.4]];
    triangles.push(Triangle { corners, color: [0.7, 0.6, 0.1, 0.5] });
    mesh(&triangles)
}

/// Renders the scene; external textures have one depth per row.
fn render(code: &Arc<Code>, settings: Settings) -> Result<(Device, Picture), Error> {
    let mut device = Device::new(code.clone(), settings)?;
    let external = device.plan().resources.iter().find(|planned| planned.is_external());
    if let Some(name) = external.map(|planned| planned.resource.name.clone()) {
        let depths: Vec<f32> = (0..WIDTH * HEIGHT).map(|pixel| 1.0 - 0.03 * (pixel / WIDTH) as f32).collect();
        device.set_texture(&name, &depths)?;
    }
    let (vertices, indices) = scene();
    let picture = device.render(&Mesh { vertices: &vertices, indices: &indices }, &|_| {})?;
    Ok((device, picture))
}

fn bits(picture: &Picture) -> Vec<[u32; 4]> {
    picture.pixels.iter().map(|pixel| pixel.map(f32::to_bits)).collect()
}

/// The rows of slices: one, an odd number that cuts tiles and quads, and an even one.
const ROWS: [u32; 3] = [1, 5, 8];

#[test]
fn slices_do_not_change_a_bit_of_the_image() {
    let registry = Registry::builtin();
    // Enough for the whole frame in every slice.
    let sizing = Sizing::Reserve(PoolSize::Fragments(16 * WIDTH * HEIGHT));
    for technique in registry.techniques() {
        let (key, code) = (technique.key.as_str(), code(&registry, technique.key.as_str()));
        for sizing in [Sizing::Auto, sizing] {
            let settings = Settings { sizing, ..Settings::new(WIDTH, HEIGHT) };
            let (_, whole) = render(&code, settings).unwrap();
            assert!(whole.pixels.iter().any(|pixel| pixel[3] > 0.0), "{key}: the image is empty");
            for rows in ROWS {
                let (device, sliced) = render(&code, Settings { slice: Some(rows), ..settings }).unwrap();
                assert_eq!(device.slices(), HEIGHT.div_ceil(rows), "{key}");
                assert_eq!(sliced.slice_counters.len() as u32, device.slices(), "{key}");
                assert!(bits(&whole) == bits(&sliced), "{key}, {sizing:?}: slices of {rows} rows differ");
                assert_eq!(whole.counters, sliced.counters, "{key}, {sizing:?}: slices of {rows} rows");
                assert!(sliced.out_of_bounds.is_empty(), "{key}: {:?}", sliced.out_of_bounds);
            }
        }
    }
}

#[test]
fn shuffled_slices_keep_the_order_of_each_pixel() {
    let registry = Registry::builtin();
    for key in ["kplus_array", "ab_ll", "ab_sb"] {
        let code = code(&registry, key);
        let settings = Settings { order: FragmentOrder::Shuffled(3), ..Settings::new(WIDTH, HEIGHT) };
        let (_, whole) = render(&code, settings).unwrap();
        let (_, sliced) = render(&code, Settings { slice: Some(5), ..settings }).unwrap();
        let near = |(a, b): (&[f32; 4], &[f32; 4])| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1.0 / 255.0);
        assert!(whole.pixels.iter().zip(&sliced.pixels).all(near), "{key}");
    }
}

/// A shuffled pixel needs all triangles at once, and the lists of all tiles. Beyond the size of one batch, they must fit into what the frame
/// leaves of the budget.
#[test]
fn shuffled_triangles_beyond_the_budget_are_an_error() {
    let code = code(&Registry::builtin(), "kplus_array");
    let draw = |order: FragmentOrder, (size, rest): (u32, u64), (vertices, indices): &(Vec<u32>, Vec<u32>)| {
        let whole = Settings { order, slice: Some(size), ..Settings::new(size, size) };
        let frame = Device::new(code.clone(), whole).unwrap().allocated_bytes() + 2 * 16 * u64::from(size * size);
        let mut device = Device::new(code.clone(), Settings { memory: frame + rest, ..whole }).unwrap();
        device.render(&Mesh { vertices, indices }, &|_| {}).map(|picture| picture.samples)
    };
    let refused = |frame: (u32, u64), mesh: &(Vec<u32>, Vec<u32>)| {
        let result = draw(FragmentOrder::Shuffled(1), frame, mesh);
        let Err(Error::Frame(FrameError::TooLarge { what, needed, limit, shrinks_with_rows, .. })) = result else {
            panic!("{result:?}");
        };
        assert_eq!(what, format!("a shuffled order of {} triangles", mesh.1.len() / 3));
        assert!(needed > limit && shrinks_with_rows, "{needed} of {limit}");
        limit
    };
    let repeated = |triangle: Triangle, count: usize| {
        let (vertices, indices) = mesh(&[triangle]);
        (vertices, indices.repeat(count))
    };
    let triangle = |corners: [[f32; 3]; 3]| Triangle { corners, color: [0.5; 4] };
    // Triangles beside the frame, because they are cheap.
    let beside = triangle([[17.0, 0.0, 0.5], [18.0, 0.0, 0.5], [17.0, 1.0, 0.5]]);
    let many = repeated(beside, 500_000);
    let batch = refused((1, 0), &many);
    assert_eq!((refused((1, batch / 2), &many), refused((1, batch + 1000), &many)), (batch, batch + 1000));
    assert!(draw(FragmentOrder::Submission, (1, 0), &many).is_ok());
    assert!(draw(FragmentOrder::Shuffled(1), (1, 10 * batch), &many).is_ok());
    // Triangles over most of 32 x 32 tiles: their lists do not fit. Those of triangles in one tile do.
    let over_all = triangle([[-16.0, 0.0, 0.5], [32.0, 0.0, 0.5], [8.0, 32.0, 0.5]]);
    assert_eq!(refused((512, 0), &repeated(over_all, 20_000)), batch);
    let small = triangle([[0.0, 0.0, 0.5], [0.1, 0.0, 0.5], [0.0, 0.1, 0.5]]);
    assert!(draw(FragmentOrder::Shuffled(1), (512, 0), &repeated(small, 200)).is_ok());
}

/// Returns the bytes of a frame in slices of `rows` rows: resources, the image and the output of a slice, four floats per pixel.
fn needed(device: &Device, rows: u32) -> u64 {
    let values = fragbuf_frame::initial_values(device.plan(), (WIDTH, HEIGHT), Sizing::Auto).unwrap().0;
    let sizes = resource_bytes(device.plan(), &values.with_rows(rows)).unwrap();
    let image = 16 * u64::from(WIDTH) * u64::from(HEIGHT + rows);
    sizes.iter().map(|(_, bytes)| bytes).sum::<u64>() + image
}

#[test]
fn slices_are_as_high_as_the_budget_allows() {
    let registry = Registry::builtin();
    for key in ["kplus_array", "kb", "ab_ll", "ab_array"] {
        let code = code(&registry, key);
        let (device, whole) = render(&code, Settings::new(WIDTH, HEIGHT)).unwrap();
        assert_eq!(device.slices(), 1, "{key}");
        for rows in [1, 7, HEIGHT] {
            let memory = needed(&device, rows);
            let fits = |memory: u64| {
                let (device, picture) = render(&code, Settings { memory, ..Settings::new(WIDTH, HEIGHT) })?;
                assert!(bits(&whole) == bits(&picture), "{key}, {rows} rows");
                assert!(device.allocated_bytes() <= memory, "{key}");
                Ok::<_, Error>(device.symbol("height"))
            };
            assert_eq!(fits(memory).unwrap(), Some(u64::from(rows)), "{key}");
            if rows > 1 {
                assert_eq!(fits(memory - 1).unwrap(), Some(u64::from(rows - 1)), "{key}");
            }
        }
    }
}

#[test]
fn a_budget_below_one_row_is_an_error_with_its_numbers() {
    let registry = Registry::builtin();
    let code = code(&registry, "kplus_array");
    let device = Device::new(code.clone(), Settings::new(WIDTH, HEIGHT)).unwrap();
    let least = needed(&device, 1);
    let refused = |memory: u64| match Device::new(code.clone(), Settings { memory, ..Settings::new(WIDTH, HEIGHT) }) {
        Err(Error::Frame(FrameError::OverBudget(need))) => need,
        other => panic!("{:?}", other.map(|device| device.slices())),
    };
    let image = 16 * u64::from(WIDTH * HEIGHT);
    let need = refused(least - 1);
    let buffers = least - image;
    let expected = MemoryNeed { size: (WIDTH, HEIGHT), rows: 1, image, textures: 0, buffers, budget: least - 1 };
    assert_eq!((need, need.total()), (expected, least));
    assert_eq!(refused(0).total(), least);
    let text = Error::Frame(FrameError::OverBudget(need)).to_string();
    assert!(
        text.contains(&format!("a frame of 19 x 23 pixels in slices of 19 x 1 pixels needs {least} bytes")),
        "{text}"
    );
    assert!(
        text.contains(&format!("the memory budget for it is {} bytes", least - 1)) && text.contains("--memory"),
        "{text}"
    );
    // The rows that the caller requests are not changed.
    let whole = needed(&device, HEIGHT);
    let settings = Settings { slice: Some(HEIGHT), memory: whole - 1, ..Settings::new(WIDTH, HEIGHT) };
    assert!(matches!(Device::new(code, settings), Err(Error::Frame(FrameError::OverBudget(_)))));
}

/// The image alone is too large: 32768 x 32768 pixels of 16 bytes.
#[test]
fn an_image_beyond_the_budget_is_refused_before_it_is_allocated() {
    let code = code(&Registry::builtin(), "kplus_array");
    match Device::new(code, Settings::new(1 << 15, 1 << 15)) {
        Err(Error::Frame(FrameError::OverBudget(need))) => assert_eq!((need.image, need.budget), (1 << 34, 2 << 30)),
        other => panic!("{:?}", other.map(|device| device.slices())),
    }
}

#[test]
fn a_pool_that_grows_beyond_the_budget_is_an_error() {
    let registry = Registry::builtin();
    let code = code(&registry, "ab_sb");
    let (device, picture) = render(&code, Settings { sizing: Sizing::Exact, ..Settings::new(WIDTH, HEIGHT) }).unwrap();
    let image = 16 * u64::from(WIDTH) * u64::from(2 * HEIGHT);
    let exact = device.allocated_bytes() + image;
    let with = |memory: u64, slice: Option<u32>| {
        render(&code, Settings { sizing: Sizing::Exact, memory, slice, ..Settings::new(WIDTH, HEIGHT) })
    };
    assert!(bits(&with(exact, None).unwrap().1) == bits(&picture));
    let Err(Error::Frame(FrameError::OverBudget(need))) = with(exact - 1, None) else { panic!("it fits") };
    assert_eq!((need.total(), need.rows), (exact, HEIGHT));
    // Lower slices have fewer fragments.
    assert!(bits(&with(exact - 1, Some(HEIGHT / 2)).unwrap().1) == bits(&picture));
    // As many fragments as bytes allow.
    let reserved = Settings { sizing: Sizing::Reserve(PoolSize::Bytes(u64::MAX)), ..Settings::new(WIDTH, HEIGHT) };
    assert!(matches!(Device::new(code.clone(), reserved), Err(Error::Frame(_))));
}
