fragbuf_dsl::fragment_buffer! {
    buffer Glass from kplus_array {
        keep 8
        sort: insertion;
    }
}

fn main() {}
