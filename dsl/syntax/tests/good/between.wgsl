fn user_opacity(gap: f32) -> f32 {
    return 1.0 - exp(-uniforms.density * gap);
}

fn user_between(front: Fragment, back: Fragment, gap: f32) -> vec4<f32> {
    let a = user_opacity(gap);
    return a * sample_texture_table(vec3<f32>(front.scalar, back.scalar, gap)) * front.color.w;
}
