fragbuf_dsl::fragment_buffer! {
    buffer Glass { keep 8; }
}

fn main() {}
