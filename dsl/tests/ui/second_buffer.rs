fragbuf_dsl::fragment_buffer! {
    buffer First from ab_ll {}
    buffer Second from ab_ll {}
}

fn main() {}
