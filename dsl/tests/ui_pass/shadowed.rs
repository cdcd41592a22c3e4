//! The crate imports nothing, and defines items with most of the names that expanded code uses.
#![deny(warnings, missing_docs, unreachable_pub, unused_qualifications)]
#![allow(dead_code, non_camel_case_types)]

mod std {}
mod core {}
mod glam {}
mod fragbuf {}
mod fragbuf_dsl {}
struct Option;
struct Result;
struct Some;
struct Default;
struct Clone;
struct Copy;
struct Vec2;
struct Vec3;
struct Vec4;
struct Fragment;
struct Uniforms;
struct Draft;
struct f32;
struct u32;
struct usize;
struct bool;
struct u8;
fn vec4() {}

::fragbuf_dsl::fragment_buffer! {
    /// The documentation of the module.
    pub buffer Glass from kplus_array {
        fragment { color: rgba8, depth: f32, id: u32, normal: octahedral, r#type: u32 }
        uniform { first: f32, eye: vec3, _padding_0: vec2, steps: u32, last: vec4, step: i32 }
        fn weight(f: Fragment, u: Uniforms, x: f32) -> f32 { (f.depth - u.first).max(0.0) * x + std::f32::consts::PI }
        keep 4 least |f, u| weight(f, u, 1.0);
        where |f, u| f.id != u.steps && f.r#type == 0;
        where |_, u| u.step > 0;
        resolve |fragments, u| {
            let mut sum = vec4(0.0, 0.0, 0.0, 0.0);
            for f in fragments { sum += f.color * f.normal.dot(u.eye); }
            for (i, f) in fragments.iter().enumerate().rev() { sum.x += f.depth * i as f32; }
            sum + u.last
        }
    }
}

::fragbuf_dsl::fragment_buffer! {
    pub(crate) buffer ABuffer from ab_ll {}
}

mod inside {
    ::fragbuf_dsl::fragment_buffer! { pub(super) buffer Type from kb {} }
}

macro_rules! kept {
    ($name:ident, $count:literal, $closure:expr, $factor:expr) => {
        ::fragbuf_dsl::fragment_buffer! {
            buffer $name from kplus_array { keep $count least |f| f.depth * $factor; }
        }
    };
}

kept!(Few, 3, |f| f.depth, 1.0 + 2.0);

fn main() {
    assert!(glass::variant().is_ok());
    assert!(a_buffer::variant().is_ok());
    assert!(inside::r#type::variant().is_ok());
    assert!(few::variant().is_ok());
    let fragment = few::Fragment { depth: 2.0, ..::core::default::Default::default() };
    assert!(few::criterion(&fragment, &few::Uniforms {}) == 6.0);
}
