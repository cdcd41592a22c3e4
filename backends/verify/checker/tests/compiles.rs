//! Every pass that fragbuf links is one that the interpreter runs: all techniques, with every other value on every axis.

use std::collections::BTreeSet;

use fragbuf_targets::{TARGETS, check};
use fragbuf_codegen::{Form, Linking, link, plan};
use fragbuf_interpreter::{Options, Program};
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::Capability;

use crate::subjects::variant;

#[test]
fn every_pass_of_every_row_is_run() {
    let registry = Registry::builtin();
    let mut texts: BTreeSet<String> = BTreeSet::new();
    let known = registry.techniques().iter();
    for technique in known {
        for row in registry.rows().iter().filter(|row| registry.axis(&row.axis).is_some_and(|axis| axis.chosen)) {
            let Ok(variant) = variant(&technique.key, &[(row.axis.as_str(), row.key.as_str())], &registry) else {
                continue;
            };
            for target in TARGETS {
                let mut offers = target.offers.to_vec();
                offers.push(Capability::OwnEntryPoints);
                let Ok(selection) = variant.select(&offers) else { continue };
                let plan = plan(&variant, &selection, &registry).unwrap();
                let linking = Linking { profile: target.profile, form: Form::Program, prefix: String::new(), group: 0 };
                for pass in link(&plan, &linking, &registry).unwrap().passes {
                    if !texts.insert(pass.text.clone()) {
                        continue;
                    }
                    let checked = check(pass, target.profile, &variant.name.origin).unwrap();
                    for entry in &checked.pass().entry_points {
                        let made =
                            Program::entry_point(checked.module(), checked.info(), &entry.name, &Options::default());
                        assert!(made.is_ok(), "{} {}={} {}: {made:?}", technique.key, row.axis, row.key, entry.name);
                    }
                }
            }
        }
    }
    assert!(texts.len() > 40, "only {} texts", texts.len());
}
