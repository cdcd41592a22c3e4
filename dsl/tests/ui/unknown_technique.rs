fragbuf_dsl::fragment_buffer! {
    buffer Glass from kplus_aray { keep 8; }
}

fn main() {}
