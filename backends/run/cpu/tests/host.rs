//! A host step that reads many words: it computes the number of slots from a histogram of fragments per pixel.

use fragbuf_cpu::FragmentOrder;
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{Access, Element, Host, HostCall, HostFunction, Pass, Resource, Row, Step};

use crate::stage::{code_with, device, draw, fragments, stacked, storage};

const COUNT: &str = "
@fragment
fn count_each(inputs: FragmentInput) {
    let before = counts_atomic_add(pixel_index(inputs.position.xy), 1u);
}
";

const HISTOGRAM: &str = "
@compute @workgroup_size(64)
fn histogram(@builtin(global_invocation_id) invocation: vec3<u32>) {
    if invocation.x < pixel_count() {
        let before = bins_atomic_add(min(counts_load(invocation.x), 31u), 1u);
    }
}
";

/// Returns the last bin with a pixel.
fn deepest(call: &HostCall<'_>) -> Result<Vec<u64>, String> {
    let last = call.reads[0].iter().rposition(|pixels| *pixels > 0);
    Ok(vec![last.map_or(0, |bin| bin as u64)])
}

#[test]
fn a_histogram_determines_the_number_of_slots() {
    let row = storage(
        vec![
            Resource::new("counts", Element::Word, "").by("pixel", "pixels").cleared(0),
            Resource::new("bins", Element::Word, "").by("bin", "32").cleared(0),
            Resource::new("slots", Element::Word, "").by("slot", "n").by("pixel", "pixels"),
        ],
        vec![
            Step::Pass(Pass::geometry("count_each", "count_each").uses("counts", Access::Atomic)),
            Step::Pass(
                Pass::compute("histogram", "histogram", "ceil_div(pixels, 64)", "1")
                    .uses("counts", Access::Read)
                    .uses("bins", Access::Atomic),
            ),
            Step::Host(Host::new("deepest").reads_all("bins").sets("n")),
        ],
    );
    let host = Row { host: Some(HostFunction(deepest)), ..Row::new("host", "deepest", "", "") };
    let registry = Registry::builtin().with(host);
    let code = code_with(registry, row, &[("count_each", COUNT), ("histogram", HISTOGRAM)], None);
    let code = code.unwrap_or_else(|error| panic!("{error}"));
    let mut seen = device(&code, FragmentOrder::Submission);
    for count in [12, 4, 9] {
        let triangles = stacked(count, 3);
        draw(&mut seen, &triangles);
        let expected = fragments(&triangles);
        let mut bins = vec![0; 32];
        expected.iter().for_each(|fragments| bins[*fragments as usize] += 1);
        assert_eq!(seen.words("bins"), Some(bins));
        let deepest = u64::from(*expected.iter().max().unwrap());
        assert_eq!(seen.symbol("n"), Some(deepest));
        assert_eq!(seen.words("slots").map(|words| words.len() as u64), Some(deepest * expected.len() as u64));
    }
}

/// Cleared resources stay cleared after a host step sets k (memory is sized for any k) or the length of a pool.
#[test]
fn initial_content_survives_host_steps() {
    let sizes = || Resource::new("sizes", Element::Word, "").by("word", "2").cleared(3);
    let row = storage(
        vec![
            sizes(),
            Resource::new("slots", Element::Word, "").by("slot", "k").by("pixel", "pixels").cleared(7),
            Resource::new("pool", Element::Word, "").by("node", "fragments").cleared(5),
        ],
        vec![Step::Host(Host::new("allocate").reads_all("sizes").sets("k").sets("fragments"))],
    );
    let code = code_with(Registry::builtin(), row, &[], Some(64)).unwrap_or_else(|error| panic!("{error}"));
    let mut seen = device(&code, FragmentOrder::Submission);
    for _ in 0..2 {
        draw(&mut seen, &stacked(1, 1));
        assert_eq!(seen.symbol("k"), Some(3));
        let pixels = (crate::stage::SIZE * crate::stage::SIZE) as usize;
        assert_eq!(seen.words("slots"), Some(vec![7; 64 * pixels]));
        assert_eq!(seen.words("pool"), Some(vec![5; 3]));
    }
}
