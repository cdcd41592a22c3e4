// What an effect has computed so far in a pixel. An effect that continues a loop saves its words by number. `over` and
// `layer` save what they have composited: premultiplied colour, and the transmittance behind it, in PEELING_SLOTS parts
// from the front to the back. `over` is associative, so parts are composited apart and joined when nothing can come
// between them. The slots of an iteration continue the parts of the same number: those with an even number add
// fragments behind what they have, those with an odd number in front of it.

/// The bits of a transmittance of 1. Memory holds the difference, so cleared memory lets all light pass.
const ACCUMULATED_TRANSPARENT = 0x3f800000u;

/// The pixel that is resolved, and the part that is continued.
var<private> accumulated_pixel: u32;
var<private> accumulated_slot: u32;

fn peeling_resume(pixel: u32) {
    accumulated_pixel = pixel;
}

fn peeling_pixel() -> u32 {
    return accumulated_pixel;
}

fn peeling_word(word: u32, pixel: u32) -> u32 {
    return accumulated_load(word, pixel);
}

fn peeling_save(word: u32, pixel: u32, value: u32) {
    accumulated_store(word, pixel, value);
}

fn peeling_begin(slot: u32) {
    accumulated_slot = slot;
}

fn peeling_color(transparent: vec3<f32>) -> vec3<f32> {
    if accumulated_is_behind() {
        return accumulated_part(accumulated_slot, accumulated_pixel).rgb;
    }
    return transparent;
}

fn peeling_transmittance() -> f32 {
    if accumulated_is_behind() {
        return accumulated_part(accumulated_slot, accumulated_pixel).a;
    }
    return 1.0;
}

fn peeling_suspend(color: vec3<f32>, transmittance: f32) {
    var composited = vec4<f32>(color, transmittance);
    if !accumulated_is_behind() {
        composited = accumulated_over(composited, accumulated_part(accumulated_slot, accumulated_pixel));
    }
    accumulated_save(accumulated_slot, accumulated_pixel, composited);
}

fn peeling_layer(index: u32) -> u32 {
    return frame.iteration * PEELING_SLOTS + accumulated_slot;
}

fn peeling_advance() {}

fn peeling_result(pixel: u32) -> vec4<f32> {
    var all = accumulated_part(0u, pixel);
    for (var part = 1u; part < PEELING_SLOTS; part++) {
        all = accumulated_over(all, accumulated_part(part, pixel));
    }
    return vec4<f32>(all.rgb, 1.0 - all.a);
}

/// Returns whether fragments go behind those that the part has. Others are composited alone first.
fn accumulated_is_behind() -> bool {
    return accumulated_slot % 2u == 0u;
}

fn accumulated_part(part: u32, pixel: u32) -> vec4<f32> {
    return bitcast<vec4<f32>>(vec4<u32>(
        accumulated_load(4u * part, pixel),
        accumulated_load(4u * part + 1u, pixel),
        accumulated_load(4u * part + 2u, pixel),
        accumulated_load(4u * part + 3u, pixel) ^ ACCUMULATED_TRANSPARENT,
    ));
}

fn accumulated_save(part: u32, pixel: u32, composited: vec4<f32>) {
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

/// Joins two neighbouring parts: part `to` gets both, and `other` becomes empty.
fn accumulated_join(to: u32, other: u32, pixel: u32) {
    let joined = accumulated_over(accumulated_part(min(to, other), pixel), accumulated_part(max(to, other), pixel));
    accumulated_save(to, pixel, joined);
    accumulated_save(other, pixel, vec4<f32>(0.0, 0.0, 0.0, 1.0));
}
