fragbuf_dsl::fragment_buffer! {
    buffer Glass from kplus_array {
        keep 4 least |f| match f.depth { _ => 1.0 };
        resolve |fragments| {
            let mut n = 0;
            while n < 3 { n += 1; }
            fragments[n].color.round()
        }
    }
}

fn main() {}
