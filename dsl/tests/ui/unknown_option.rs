fragbuf_dsl::fragment_buffer! {
    buffer Glass from kplus_array {
        sync: spin_lock { limt: 9 };
    }
}

fn main() {}
