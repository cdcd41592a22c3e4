//! Functions of vectors.

use glam::{Vec2, Vec3, Vec4, vec2, vec3, vec4};

use super::{Function, Word};

functions! { vectors:
    fn parts_of_2(x: f32, y: f32) -> f32 {
        let v = vec2(x, y).clamp(Vec2::splat(-1000.0), Vec2::splat(1000.0));
        (v.floor() + v.ceil() + v.trunc() + v.fract() + v.fract_gl() + v.abs()).dot(vec2(1.0, 0.5))
    }
    fn parts_of_3(x: f32, y: f32, z: f32) -> f32 {
        let v = vec3(x, y, z).clamp(Vec3::splat(-1000.0), Vec3::splat(1000.0));
        (v.floor() + v.ceil() + v.trunc() + v.fract() + v.fract_gl() + v.abs()).dot(vec3(1.0, 0.5, 0.25))
    }
    fn parts_of_4(x: f32, y: f32, z: f32) -> f32 {
        let v = vec4(x, y, z, 0.5).clamp(Vec4::splat(-1000.0), Vec4::splat(1000.0));
        (v.floor() + v.ceil() + v.trunc() + v.fract() + v.fract_gl() + v.abs()).dot(vec4(1.0, 0.5, 0.25, 2.0))
    }
    fn elements_of_2(x: f32, y: f32) -> f32 {
        let v = vec2(x, y).clamp(Vec2::splat(-20.0), Vec2::splat(20.0));
        v.min_element() + 2.0 * v.max_element() + 3.0 * v.element_sum() + v.element_product()
    }
    fn elements_of_3(x: f32, y: f32, z: f32) -> f32 {
        let v = vec3(x, y, z).clamp(Vec3::splat(-20.0), Vec3::splat(20.0));
        v.min_element() + 2.0 * v.max_element() + 3.0 * v.element_sum() + v.element_product()
    }
    fn elements_of_4(x: f32, y: f32, z: f32) -> f32 {
        let v = vec4(x, y, z, x).clamp(Vec4::splat(-20.0), Vec4::splat(20.0));
        v.min_element() + 2.0 * v.max_element() + 3.0 * v.element_sum() + v.element_product()
    }
    fn order_of_3(x: f32, y: f32, z: f32) -> f32 {
        let v = vec3(x, y, z).min(vec3(y, z, x)).max(vec3(z, x, -1.0));
        v.clamp(Vec3::NEG_ONE, Vec3::splat(50.0)).dot(vec3(1.0, 2.0, 4.0))
    }
    fn powers_of_3(x: f32, y: f32, z: f32) -> f32 {
        let v = vec3(x, y, 0.0).abs().clamp(Vec3::ZERO, Vec3::splat(20.0));
        v.powf(z.clamp(0.0, 3.0)).element_sum() + v.powf(0.0).element_sum() + v.powf(2.0).element_sum()
    }
    fn powers_of_zero(x: f32, y: f32) -> f32 {
        let zero = vec2(x, y) - vec2(x, y);
        zero.powf(x - x).element_sum() + zero.powf(0.0).dot(vec2(10.0, 100.0))
    }
    fn exponents_of_2(x: f32, y: f32) -> f32 {
        let v = vec2(x, y).clamp(Vec2::splat(0.1), Vec2::splat(4.0));
        v.exp().dot(vec2(1.0, 0.5)) + v.recip().element_sum() + v.mul_add(v, v).element_sum()
    }
    fn lengths(x: f32, y: f32, z: f32) -> f32 {
        let v = vec3(x, y, z).clamp(Vec3::splat(-100.0), Vec3::splat(100.0));
        v.length() + v.length_squared() / 100.0 + v.distance(vec3(1.0, 2.0, 3.0)) + (v + vec3(0.1, 200.0, 0.1)).normalize().y
    }
    fn products(x: f32, y: f32, z: f32) -> f32 {
        let v = vec3(x, y, z).clamp(Vec3::splat(-9.0), Vec3::splat(9.0));
        let w = v.cross(vec3(1.0, -2.0, 0.5)).reflect(vec3(0.0, 0.6, 0.8)).lerp(v, 0.25);
        w.dot(vec3(0.5, 1.5, -1.0)) + w.truncate().extend(3.0).z + v.extend(2.0).truncate().x
    }
}
