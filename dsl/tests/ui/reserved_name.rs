fragbuf_dsl::fragment_buffer! {
    buffer Glass from kplus_array {
        fragment { color: rgba8, depth: f32, type: u32 }
        uniform { vec3: f32 }
        fn criterion(x: f32) -> f32 { x }
    }
}

fn main() {}
