fn user_uniform(vec2f_: f32, target_: f32) -> f32 {
    return vec2f_ + target_;
}

fn user_ptr(loop__: f32) -> f32 {
    return user_uniform(loop__, 1.0);
}

fn user_criterion(layer_: Fragment) -> f32 {
    return layer_.layer_ * layer_.array_.x + uniforms.storage_ + uniforms.uniforms_ + layer_.rust__odd0;
}

fn user_admit_0(fragment: Fragment) -> bool {
    return user_ptr(fragment.sample) > 0.0 && fragment.texture == 1u;
}
