fragbuf_dsl::fragment_buffer! {
    fragment { color: rgba8, depth: f32 }
}

fn main() {}
