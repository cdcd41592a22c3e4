//! Indirect draws and dispatches, with arguments that an earlier pass writes in the layout of WebGPU.

use fragbuf_cpu::{Device, FragmentOrder};
use fragbuf_templates::vocabulary::{Access, Element, Pass, Resource, Step};

use crate::stage::{Triangle, code, device, draw, quad, storage};

/// Writes the arguments.
const ARGUE: &str = "
@compute @workgroup_size(1)
fn argue(@builtin(global_invocation_id) id: vec3<u32>) {
    arguments_store(id.x, given(id.x));
}
";

const COUNT_DRAWN: &str = "
@fragment
fn count_drawn(inputs: FragmentInput) {
    let before = drawn_atomic_add(1u);
    let color = fragment_from_inputs(inputs).color;
    let reddest = red_atomic_max(u32(round(255.0 * color.r)));
}
";

const COUNT_WHOLE: &str = "
@fragment
fn count_whole() {
    let before = drawn_atomic_add(1u);
}
";

const COUNT_GROUPS: &str = "
@compute @workgroup_size(2)
fn count_groups(@builtin(workgroup_id) id: vec3<u32>) {
    let before = drawn_atomic_add(1u);
    let greatest = red_atomic_max(id.y);
}
";

/// Returns the words of `drawn` and `red` after a pass with these arguments.
fn run(pass: Pass, skeleton: (&str, &str), arguments: [u32; 5], triangles: &[Triangle]) -> [u32; 2] {
    let word = |name: &str| Resource::new(name, Element::Word, "").cleared(0);
    let argue = Pass::compute("argue", "argue", "5", "1").uses("arguments", Access::Plain);
    let pass = pass.uses("arguments", Access::Indirect).uses("drawn", Access::Atomic).uses("red", Access::Atomic);
    let rows = storage(
        vec![Resource::new("arguments", Element::Word, "").by("word", "5"), word("drawn"), word("red")],
        vec![Step::Pass(argue), Step::Pass(pass)],
    );
    let [a, b, c, d, e] = arguments;
    let given = format!(
        "{ARGUE}\nfn given(index: u32) -> u32 {{\n    var words = array<u32, 5>({a}u, {b}u, {c}u, {d}u, {e}u);\n    return words[index];\n}}\n"
    );
    let code = code(rows, &[("argue", &given), skeleton], None).unwrap_or_else(|error| panic!("{error}"));
    let mut device: Device = device(&code, FragmentOrder::Submission);
    draw(&mut device, triangles);
    ["drawn", "red"].map(|name| device.words(name).unwrap()[0])
}

/// Returns quads of 4 and 9 pixels.
fn scene() -> Vec<Triangle> {
    [quad([0, 2, 0, 2], 0.5, [0.2, 0.0, 0.0, 1.0]), quad([4, 7, 4, 7], 0.5, [0.6, 0.0, 0.0, 1.0])].concat()
}

#[test]
fn triangles_are_drawn_by_indirect_arguments() {
    let pass = || Pass::geometry("count_drawn", "count_drawn");
    let cases = [
        ([12, 1, 0, 0, 0], [13, 153]),
        ([6, 1, 0, 0, 0], [4, 51]),
        ([6, 1, 6, 0, 0], [9, 153]),
        // The indices of the first quad with base vertex 6 are the second quad.
        ([6, 1, 0, 6, 0], [9, 153]),
        ([12, 3, 0, 0, 5], [39, 153]),
        ([12, 0, 0, 0, 0], [0, 0]),
        ([0, 1, 0, 0, 0], [0, 0]),
        // Beyond the end of the mesh.
        ([600, 1, 6, 0, 0], [9, 153]),
        ([12, 1, 0, 600, 0], [0, 0]),
    ];
    for (arguments, expected) in cases {
        assert_eq!(run(pass(), ("count_drawn", COUNT_DRAWN), arguments, &scene()), expected, "{arguments:?}");
    }
}

#[test]
fn the_whole_frame_is_drawn_by_indirect_arguments() {
    let pass = || Pass::fullscreen("count_whole", "count_whole");
    for (arguments, expected) in
        [([3, 1, 0, 0, 0], 256), ([3, 2, 0, 0, 0], 512), ([3, 0, 0, 0, 0], 0), ([0, 1, 0, 0, 0], 0)]
    {
        assert_eq!(run(pass(), ("count_whole", COUNT_WHOLE), arguments, &scene())[0], expected, "{arguments:?}");
    }
}

#[test]
fn workgroups_are_dispatched_by_indirect_arguments() {
    let pass = || Pass::compute("count_groups", "count_groups", "1", "1");
    for (arguments, expected) in [([3, 4, 2, 0, 0], [48, 3]), ([3, 0, 2, 0, 0], [0, 0])] {
        assert_eq!(run(pass(), ("count_groups", COUNT_GROUPS), arguments, &scene()), expected, "{arguments:?}");
    }
}
