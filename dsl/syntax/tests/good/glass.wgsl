fn user_weight(f: Fragment, x: f32) -> f32 {
    return max(f.depth - uniforms.cut, 0.0) * x;
}

fn user_criterion(f: Fragment) -> f32 {
    return f.depth - 0.25 * f.color.w;
}

fn user_admit_0(f: Fragment) -> bool {
    return f.depth > uniforms.cut;
}

fn user_admit_1(f: Fragment) -> bool {
    return f.id != 0u;
}

fn user_resolve() -> vec4<f32> {
    var color = vec3<f32>(0.0);
    var transmittance = 1.0;
    for (var f_index = 0u; f_index < layer_count(); f_index++) {
        let f = layer(f_index);
        let alpha = f.color.w * user_weight(f, 0.5);
        color += transmittance * alpha * f.color.xyz;
        transmittance *= 1.0 - alpha;
    }
    return vec4<f32>(color, 1.0 - transmittance);
}
