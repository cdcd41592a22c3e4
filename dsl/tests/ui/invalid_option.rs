fragbuf_dsl::fragment_buffer! {
    buffer Glass from kplus_array {
        sync: spin_lock { limit: 0 };
    }
}

fn main() {}
