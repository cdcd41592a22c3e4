fragbuf_dsl::fragment_buffer! {
    buffer Glass from kplus_array {
        storage: max_array;
        sync: none;
    }
}

fn main() {}
