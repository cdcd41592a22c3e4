// One layer of each pixel alone (Vasilakis & Fudos 2013, D13 Fig. 4). Without peeling it is one fragment, counted from
// the front. With peeling it is what one iteration stores in one slot: the next depth of F2B, the front or the back of
// DUAL, one end of a bucket of BUN. Fragments of one layer are blended front to back, as in `over`.

fn resolve_layers() -> vec4<f32> {
    var color = peeling_color(vec3<f32>(0.0));
    var transmittance = peeling_transmittance();
    for (var index = 0u; index < layer_count(); index++) {
        if peeling_layer(index) == RESOLVE_LAYER {
            let surface = layer(index).color;
            color += transmittance * surface.a * surface.rgb;
            transmittance *= 1.0 - surface.a;
        }
    }
    peeling_suspend(color, transmittance);
    return vec4<f32>(color, 1.0 - transmittance);
}

fn resolve_result(pixel: u32) -> vec4<f32> {
    return peeling_result(pixel);
}
