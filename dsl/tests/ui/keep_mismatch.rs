fragbuf_dsl::fragment_buffer! {
    buffer Glass from kplus_array { keep all; }
}

fn main() {}
