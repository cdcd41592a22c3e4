fragbuf_dsl::fragment_buffer! {
    buffer Glass from ab_ll {
        strage: linked_list;
        sort: insertoin;
    }
}

fn main() {}
