fn user_counted(n: u32) -> f32 {
    var sum = 0.0;
    for (var i = 0i; i < 8i; i++) {
        sum += f32(i);
    }
    var i_more = 1u <= n;
    for (var i = 1u; i_more; i++) {
        i_more = i < n;
        if i == 3u {
            continue;
        }
        if i > 6u {
            break;
        }
        sum *= 2.0;
    }
    for (var i = uniforms.bias; i < 4i; i++) {
        sum += f32(i);
    }
    let index_end = uniforms.steps * 2u;
    for (var index = 0u; index < index_end; index++) {
        sum += 1.0;
    }
    var m = n;
    let i_end = m;
    for (var i = 0u; i < i_end; i++) {
        m = i;
    }
    for (var i_next = n; i_next > 0u; i_next--) {
        let i = i_next - 1u;
        for (var j = 0u; j < i; j++) {
            sum -= f32(i * j);
        }
    }
    for (var i_next = 3i; i_next > uniforms.bias; i_next--) {
        let i = i_next - 1i;
        sum += f32(i);
    }
    for (var index_next = 3i; index_next > 0i; index_next--) {
        sum += 0.5;
    }
    return sum;
}

fn user_resolve() -> vec4<f32> {
    var color = vec4<f32>(0.0);
    for (var f_index = 0u; f_index < layer_count(); f_index++) {
        let f = layer(f_index);
        color += f.color;
    }
    for (var i = 0u; i < layer_count(); i++) {
        let f = layer(i);
        if i == 2u {
            break;
        }
        color.w += f.depth;
    }
    for (var f_next = layer_count(); f_next > 0u; f_next--) {
        let f = layer(f_next - 1u);
        color *= f.depth;
    }
    for (var i_next = layer_count(); i_next > 0u; i_next--) {
        let i = i_next - 1u;
        let f = layer(i);
        color.x += f.depth * f32(i);
    }
    for (var i = 0u; i < layer_count(); i++) {
        let next = min(i + 1u, layer_count() - 1u);
        color.y += layer(next).depth - layer(i).depth;
    }
    for (var f_index = 0u; f_index < layer_count(); f_index++) {
        color.z += 1.0;
    }
    for (var i = 0u; i < uniforms.steps; i++) {
        let index = i;
        if index < layer_count() && !(layer_count() == 0u) {
            color += layer(index).color * layer(0u).depth;
        }
    }
    for (var i = 0u; i < layer_count(); i++) {
        color.x += f32(i);
    }
    return color;
}
