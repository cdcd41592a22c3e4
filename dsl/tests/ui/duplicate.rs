fragbuf_dsl::fragment_buffer! {
    buffer Glass from kplus_array {
        fragment { color: rgba8, depth: f32, depth: u32 }
        resolve: over;
        resolve |fragments| fragments[0].color;
    }
}

fn main() {}
