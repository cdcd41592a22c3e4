fragbuf_dsl::fragment_buffer! {
    buffer Glass from kplus_array {
        fn half(x: f32) -> f32 { x * 0.5; }
        fn loops(x: f32) -> f32 { loops(x) }
        keep 4 least |f| half(f.depth, 1.0) + loops(3000000000);
    }
}

fn main() {}
