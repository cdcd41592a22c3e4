//! A check on several threads has the report of a check on one: verdicts, schedules and numbers of states.

use fragbuf_checker::{Limits, Model, Report};
use fragbuf_templates::Registry;
use rayon::ThreadPoolBuilder;

use crate::subjects::{limits, report};

#[test]
fn the_number_of_threads_changes_nothing_in_a_report() {
    let registry = Registry::builtin();
    let limits = |model| Limits { entries: vec![1, 2], ..limits(2, model) };
    let few = Limits { states: 100, fragments: vec![3], ..limits(Model::Sequential) };
    let random = Limits { random_schedules: Some(5), ..limits(Model::Sequential) };
    for (key, set, target, limits) in [
        ("kb", &[][..], "wgsl", limits(Model::Sequential)),
        ("kb", &[], "wgsl", few),
        ("kb", &[], "wgsl", random),
        ("kb", &[("sync", "spin_lock"), ("cull", "early")], "wgsl", limits(Model::Relaxed)),
        ("kplus_array", &[], "wgsl", limits(Model::Relaxed)),
        ("kplus_array", &[], "spirv", limits(Model::Relaxed)),
        ("kb_mdt32", &[], "wgsl", limits(Model::Sequential)),
        ("kb_multi", &[], "wgsl", limits(Model::Relaxed)),
        ("kplus_ab_sb", &[], "wgsl", limits(Model::Sequential)),
    ] {
        let checked = |threads: usize| -> Report {
            let pool = ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| report(key, set, target, &limits, &registry).unwrap())
        };
        let alone = checked(1);
        for threads in [2, 5] {
            assert_eq!(checked(threads), alone, "{key} {set:?} {target} {threads}");
        }
    }
}
