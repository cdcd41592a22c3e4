// The premultiplied colour of a pixel's fragments that iterations have composited so far, and the light that passes
// them. Some rows composite several parts of a pixel apart, and join them later: `over` is associative.

/// The bits of a transmittance of 1. Memory holds the difference, so cleared memory lets all light pass.
const ACCUMULATED_TRANSPARENT = 0x3f800000u;

fn accumulated_color(pixel: u32) -> vec3<f32> {
    return bitcast<vec3<f32>>(vec3<u32>(
        accumulated_load(0u, pixel),
        accumulated_load(1u, pixel),
        accumulated_load(2u, pixel),
    ));
}

fn accumulated_transmittance(pixel: u32) -> f32 {
    return bitcast<f32>(accumulated_load(3u, pixel) ^ ACCUMULATED_TRANSPARENT);
}

fn accumulated_save(pixel: u32, color: vec3<f32>, transmittance: f32) {
    let words = bitcast<vec3<u32>>(color);
    accumulated_store(0u, pixel, words.x);
    accumulated_store(1u, pixel, words.y);
    accumulated_store(2u, pixel, words.z);
    accumulated_store(3u, pixel, bitcast<u32>(transmittance) ^ ACCUMULATED_TRANSPARENT);
}

fn accumulated_result(pixel: u32) -> vec4<f32> {
    return vec4<f32>(accumulated_color(pixel), 1.0 - accumulated_transmittance(pixel));
}

/// Returns part `part` of what has been composited: premultiplied colour, and transmittance.
fn accumulated_part(part: u32, pixel: u32) -> vec4<f32> {
    return bitcast<vec4<f32>>(vec4<u32>(
        accumulated_load(4u * part, pixel),
        accumulated_load(4u * part + 1u, pixel),
        accumulated_load(4u * part + 2u, pixel),
        accumulated_load(4u * part + 3u, pixel) ^ ACCUMULATED_TRANSPARENT,
    ));
}

fn accumulated_save_part(part: u32, pixel: u32, composited: vec4<f32>) {
    let words = bitcast<vec4<u32>>(composited);
    accumulated_store(4u * part, pixel, words.x);
    accumulated_store(4u * part + 1u, pixel, words.y);
    accumulated_store(4u * part + 2u, pixel, words.z);
    accumulated_store(4u * part + 3u, pixel, words.w ^ ACCUMULATED_TRANSPARENT);
}

/// Composites a part over another.
fn accumulated_over(front: vec4<f32>, behind: vec4<f32>) -> vec4<f32> {
    return vec4<f32>(front.rgb + front.a * behind.rgb, front.a * behind.a);
}

/// Moves what part `behind` holds to the end of part `front`.
fn accumulated_join(front: u32, behind: u32, pixel: u32) {
    let joined = accumulated_over(accumulated_part(front, pixel), accumulated_part(behind, pixel));
    accumulated_save_part(front, pixel, joined);
    accumulated_save_part(behind, pixel, vec4<f32>(0.0, 0.0, 0.0, 1.0));
}
