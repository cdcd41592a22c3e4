fragbuf_dsl::fragment_buffer! {
    buffer Glass from kplus_array {
        resolve |fragments| {
            let sum = Vec4::ZERO;
            for f in fragments { sum += f.color; }
            sum
        }
    }
}

fn main() {}
