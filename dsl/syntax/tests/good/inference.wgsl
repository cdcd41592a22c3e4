fn user_resolve() -> vec4<f32> {
    var count = 0u;
    var best = 0u;
    var depth = 0.0;
    for (var i = 0u; i < layer_count(); i++) {
        let f = layer(i);
        if f.id > best {
            best = f.id;
            count = i;
        }
        depth += 1.0;
    }
    let signed = 5i;
    let flag = 7i & signed;
    return vec4<f32>(f32(count), f32(best), depth, f32(flag));
}
