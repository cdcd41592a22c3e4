fragbuf_dsl::fragment_buffer! {
    buffer Glass from ab_ll {
        fragment { color: rgba8, z: f32 }
    }
}

fn main() {}
