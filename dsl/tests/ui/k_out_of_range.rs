fragbuf_dsl::fragment_buffer! {
    buffer Glass from kplus_array { keep 5000; }
}

fn main() {}
