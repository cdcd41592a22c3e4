fn user_at(d: f32) -> vec4<f32> {
    return sample_texture_volume(vec3<f32>(d, d, uniforms.scale)) + load_texture_volume(-1i, 2i, 3i);
}

fn user_criterion(f: Fragment) -> f32 {
    return f.depth + sample_texture_lut(vec2<f32>(f.depth, 0.5)).x;
}

fn user_admit_0(f: Fragment) -> bool {
    return load_texture_type(0i, select(i32(f.depth), 2147483647i, f.depth >= 2147483648.0)).w > 0.5;
}

fn user_image_first() -> vec4<f32> {
    return user_at(layer(0u).depth);
}

fn user_image_second() -> vec4<f32> {
    var sum = vec4<f32>(0.0);
    for (var y = -1i; y <= 1i; y++) {
        for (var x = -1i; x <= 1i; x++) {
            sum += at_image_first(x, y);
        }
    }
    return sum * (1.0 / f32(width_image_first() * height_image_first()));
}

fn user_resolve() -> vec4<f32> {
    let size = width_texture_volume() + height_texture_volume() * depth_texture_volume() + height_texture_lut();
    let nearest = sample_nearest_texture_lut(vec2<f32>(0.5, 0.5)) + sample_nearest_texture_volume(vec3<f32>(0.25));
    return at_image_second(0i, 1i) + nearest * f32(size + width_image_second()) + layer(0u).color;
}
