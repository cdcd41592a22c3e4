struct Inner { direction: vec3<f32>, weight: f32, flags: u32 }
struct Frame { size: vec2<u32>, pad: vec2<f32>, lights: array<vec4<f32>, 3>, inner: Inner, scale: f32 }
struct Node { color: vec3<f32>, next: u32, depth: f32 }
struct List { count: u32, origin: vec3<f32>, nodes: array<Node> }
@group(0) @binding(0) var<uniform> frame: Frame;
@group(0) @binding(1) var<storage, read_write> list: List;
@group(1) @binding(0) var<storage, read> head: u32;
@group(1) @binding(1) var<storage, read> single: Node;
@group(1) @binding(2) var<storage, read> vectors: array<vec3<f32>, 8>;
@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let node = list.nodes[head];
    list.nodes[id.x] = Node(node.color + frame.inner.direction + vectors[2], list.count, frame.scale);
    list.origin = single.color * frame.lights[1].xyz + vec3<f32>(f32(frame.size.x));
    list.nodes[1] = single;
}
