fragbuf_dsl::fragment_buffer! {
    buffer Glass from kplus_array {
        keep 8 least |f| f.depth - ;
        where f.depth > 0.5;
    }
}

fn main() {}
