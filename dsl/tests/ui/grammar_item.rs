fragbuf_dsl::fragment_buffer! {
    buffer Glass from kplus_array {
        kep 8;
        sync spin_lock;
    }
}

fn main() {}
