// Front-to-back *over* (Porter & Duff 1984). Input colours have straight alpha; the result is premultiplied, to be
// blended over the background.

fn resolve_layers() -> vec4<f32> {
    var color = peeling_color(vec3<f32>(0.0));
    var transmittance = peeling_transmittance();
    for (var index = 0u; index < layer_count(); index++) {
        // Stops when less than OPAQUE_THOUSANDTHS of the light behind would pass (K15 sec. 4.4): the omitted fragments
        // change every channel by less than that.
        if OPAQUE_THOUSANDTHS > 0u && 1000.0 * transmittance < f32(OPAQUE_THOUSANDTHS) {
            break;
        }
        let surface = layer(index).color;
        color += transmittance * surface.a * surface.rgb;
        transmittance *= 1.0 - surface.a;
    }
    peeling_suspend(color, transmittance);
    return vec4<f32>(color, 1.0 - transmittance);
}

fn resolve_result(pixel: u32) -> vec4<f32> {
    return peeling_result(pixel);
}
