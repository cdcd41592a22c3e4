use crate::subjects::report;
use fragbuf_checker::{Limits, Model};
use fragbuf_templates::Registry;
#[test]
fn scratch() {
    for spec in std::env::var("SCRATCH").unwrap().split_whitespace() {
        let parts: Vec<&str> = spec.split(';').collect();
        let set: Vec<(&str, &str)> = parts[1].split(',').filter_map(|one| one.split_once('=')).collect();
        let model = if parts[3] == "late" { Model::Late } else { Model::Sequential };
        let range = |text: &str| -> Vec<u32> { text.split(',').map(|one| one.parse().unwrap()).collect() };
        let limits = Limits { fragments: range(parts[4]), entries: range(parts[5]), model, ..Limits::default() };
        let begin = std::time::Instant::now();
        let r = report(parts[0], &set, parts[2], &limits, &Registry::builtin());
        match r {
            Ok(r) => println!(
                "{spec}: {:?} {} cases {} states whole {} stated {} judged {} fail {:#?}",
                begin.elapsed(),
                r.cases,
                r.states,
                r.is_whole,
                r.is_stated,
                r.is_judged,
                r.failure.map(|f| (
                    f.case,
                    f.fault,
                    f.prior,
                    f.fragments,
                    if std::env::var("STEPS").is_ok() {
                        f.steps.iter().map(|s| format!("{} {} {}", s.fragment, s.action, s.place)).collect()
                    } else {
                        Vec::<String>::new()
                    }
                ))
            ),
            Err(e) => println!("{spec}: {e:?}"),
        }
    }
}
