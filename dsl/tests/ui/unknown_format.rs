fragbuf_dsl::fragment_buffer! {
    buffer Glass from kplus_array {
        fragment { color: rgb8, depth: f32 }
        uniform { view: mat4 }
        keep 4 least |f| f.depth - f.color.w;
    }
}

// The attribute without an error is emitted.
fn main() {
    let _ = glass::Fragment { depth: 0.5, ..Default::default() };
}
