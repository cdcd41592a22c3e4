// A material: Lambert shading of stripes. `main.rs` puts the functions of a geometry pass in front of it.

struct Scene {
    view_projection: mat4x4<f32>,
    /// The direction towards the light.
    light: vec3<f32>,
    /// The light from all directions, from 0 to 1.
    ambient: f32,
}

@group(0) @binding(0) var<uniform> scene: Scene;

struct Surface {
    @builtin(position) at: vec4<f32>,
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) color: vec4<f32>,
}

@vertex
fn material_vertex(
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) color: vec4<f32>,
) -> Surface {
    return Surface(scene.view_projection * vec4<f32>(position, 1.0), position, normal, color);
}

@fragment
fn material_fragment(surface: Surface) {
    let stripes = 0.75 + 0.25 * sin(16.0 * surface.position.y);
    // Both sides of a transparent surface are lit.
    let lambert = abs(dot(normalize(surface.normal), scene.light));
    let color = surface.color.rgb * stripes * mix(lambert, 1.0, scene.ambient);
    store_fragment(surface.at.xy, Fragment(vec4<f32>(color, surface.color.a), surface.at.z));
}
