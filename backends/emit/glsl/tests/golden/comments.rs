//! Golden tests of comments and headers.

use fragbuf_glsl::{Dialect, Unit};

use super::expect;
use super::support::{parse, print};

#[test]
fn comments_keep_their_positions() {
    expect(
        "commented",
        "fn commented(n: u32) -> u32 {
            // the first
            var total = 0u; // starts at zero

            // above the loop,
            // in two lines
            for (var i = 0u; i < n; i++) {
                // inside
                let value = a[i]; // read once
                if value > 3u { // large
                    total += value;
                    // end of the branch
                } else {
                    // small
                    total++;
                }
                // end of the loop
            }

            return total; // done
        }",
        "
uint commented(uint n) {
    // the first
    uint total = 0u; // starts at zero

    // above the loop,
    // in two lines
    for (uint i = 0u; i < n; i++) {
        // inside
        uint value = a[i]; // read once
        if (value > 3u) {
            // large
            total += value;
            // end of the branch
        } else {
            // small
            total++;
        }
        // end of the loop
    }

    return total; // done
}
",
    );
}

#[test]
fn comments_above_functions_are_kept() {
    let source =
        "// The head of a file.\n\n// Two lines\n// about it.\nfn twice(n: u32) -> u32 {\n    return n * 2u;\n}\n";
    let text = print(source, Unit::Library, Dialect::OpenGl450).unwrap();
    assert_eq!(text, "// Two lines\n// about it.\nuint twice(uint n) {\n    return n * 2u;\n}\n");
}

#[test]
fn header_follows_the_version() {
    let source = "/// Doubles.\nfn twice(n: u32) -> u32 { return n * 2u; }\n@compute @workgroup_size(1) fn main() { let n = twice(1u); }";
    let (module, info) = parse(source);
    let slot = |_, _| fragbuf_glsl::Slot::default();
    let header = "made by a test\nin two lines";
    let options = fragbuf_glsl::Options {
        dialect: Dialect::Vulkan450,
        header,
        markers: &[],
        bindings: &slot,
        plain_loads: &[],
        plain_functions: &[],
        written_first: &[],
        zero_workgroup_memory: true,
    };
    let text = fragbuf_glsl::print(&module, &info, source, Unit::EntryPoint("main"), &options).unwrap();
    assert!(
        text.starts_with("#version 450\n\n// made by a test\n// in two lines\n\nlayout(local_size_x = 1"),
        "{text}"
    );
    let library = fragbuf_glsl::print(&module, &info, source, Unit::Library, &options).unwrap();
    let expected = "// made by a test\n// in two lines\n\n/// Doubles.\nuint twice(uint n) {\n    return n * 2u;\n}\n";
    assert_eq!(library, expected);
    // With another source than the module's, only the comments are lost.
    let strange = fragbuf_glsl::print(&module, &info, "\u{1F600} // ?", Unit::EntryPoint("main"), &options).unwrap();
    assert!(strange.contains("uint n = twice(1u);"), "{strange}");
}
