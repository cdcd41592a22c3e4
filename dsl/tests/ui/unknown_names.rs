fragbuf_dsl::fragment_buffer! {
    buffer Glass from kplus_array {
        uniform { cut: f32 }
        keep 4 least |f, u| f.deph + u.cutt + weigth(f.depth);
        fn weight(x: f32) -> f32 { x.squareroot() }
    }
}

fn main() {}
