fragbuf_dsl::fragment_buffer! {
    buffer Glass from kplus_array {
        fragment { color: rgba8, depth: f32, id: u32 }
        uniform { cut: f32 }
        keep 4 least |f| f.depth + f.id;
        where |f, u| f.color - u.cut;
        resolve |fragments| {
            let first = fragments[0].color.truncate();
            first
        }
    }
}

fn main() {}
