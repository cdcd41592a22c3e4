//! The fragments that the rasteriser generates for shapes of known coverage: a pixel belongs to a shape if its centre is inside,
//! or on a left or top edge.

use fragbuf_runtime::Output;
use fragbuf_runtime::headless::Offscreen;

use crate::kept;
use crate::oracle::pixels;
use crate::quads::SIZE;
use crate::stage::{FORMAT, device, read_buffers, renderer, settings, shaders, technique};

/// Renders triangles, in pixels from the top left with a depth per corner. Returns the depths of every pixel's fragments.
fn depths(triangles: &[[[f32; 3]; 3]]) -> Vec<Vec<f32>> {
    let stage = device();
    let mut renderer = renderer(&stage, &shaders(&technique("ab_ll", &[]), "wgsl"), &settings()).unwrap();
    let mut bytes = Vec::new();
    for [x, y, z] in triangles.iter().flatten() {
        let half = SIZE as f32 / 2.0;
        let vertex = [x / half - 1.0, 1.0 - y / half, *z, 1.0, 1.0, 1.0, 1.0];
        bytes.extend(vertex.iter().flat_map(|value| value.to_le_bytes()));
    }
    let buffer = crate::stage::vertex_buffer(&stage, &bytes);
    let offscreen = Offscreen::new(&stage.device, FORMAT, SIZE, SIZE).unwrap();
    let output = Output { view: offscreen.view(), load: wgpu::LoadOp::Clear(wgpu::Color::BLACK) };
    let draw = &mut |pass: &mut wgpu::RenderPass<'_>, _: &fragbuf_runtime::Call<'_>| {
        pass.set_vertex_buffer(0, buffer.slice(..));
        pass.draw(0..3 * triangles.len() as u32, 0..1);
    };
    renderer.render(&output, draw).unwrap();
    let kept = kept::kept(&renderer, &read_buffers(&stage, &renderer), &[]);
    kept.iter().map(|words| words.iter().map(|words| f32::from_bits(words[0])).collect()).collect()
}

fn quad(x0: f32, y0: f32, x1: f32, y1: f32) -> [[[f32; 3]; 3]; 2] {
    let [a, b, c, d] = [[x0, y0, 0.5], [x0, y1, 0.5], [x1, y1, 0.5], [x1, y0, 0.5]];
    [[a, b, c], [a, c, d]]
}

#[test]
fn a_pixel_is_covered_if_its_centre_is_inside_or_on_a_left_or_top_edge() {
    // Edges on pixel edges, between centres, and through centres.
    for [x0, y0, x1, y1] in [[2.0, 3.0, 9.0, 7.0], [2.4, 3.3, 9.6, 7.7], [2.5, 3.5, 9.5, 7.5], [0.5, 0.5, 15.5, 15.5]] {
        let depths = depths(&quad(x0, y0, x1, y1));
        for ((x, y), depths) in pixels().zip(depths) {
            let (cx, cy) = (x as f32 + 0.5, y as f32 + 0.5);
            let inside = x0 <= cx && cx < x1 && y0 <= cy && cy < y1;
            // There is one fragment, although the diagonal between the quad's triangles passes through centres.
            assert_eq!(depths.len(), usize::from(inside), "pixel {x}, {y} of {x0}, {y0}, {x1}, {y1}");
        }
    }
}

#[test]
fn shapes_that_share_an_edge_share_no_pixel() {
    let quads =
        [quad(0.0, 0.0, 7.5, 9.5), quad(7.5, 0.0, 16.0, 9.5), quad(0.0, 9.5, 7.5, 16.0), quad(7.5, 9.5, 16.0, 16.0)];
    let fan: Vec<[[f32; 3]; 3]> = quads.into_iter().flatten().collect();
    assert!(depths(&fan).iter().all(|depths| depths.len() == 1));
}

#[test]
fn depth_is_linear_across_the_screen() {
    let plane = |x: f32, y: f32| 0.1 + x / 32.0 + y / 64.0;
    let corner = |x: f32, y: f32| [x, y, plane(x, y)];
    let triangle = [corner(1.0, 1.0), corner(3.0, 15.0), corner(15.0, 2.0)];
    let mut covered = 0;
    for ((x, y), depths) in pixels().zip(depths(&[triangle])) {
        for depth in depths {
            let expected = plane(x as f32 + 0.5, y as f32 + 0.5);
            assert!((depth - expected).abs() < 1.0e-5, "pixel {x}, {y}: {depth} instead of {expected}");
            covered += 1;
        }
    }
    assert!(covered > 60, "{covered}");
}
