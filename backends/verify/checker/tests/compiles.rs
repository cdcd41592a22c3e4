//! The interpreter compiles every pass that fragbuf links: all techniques, with every other value on every axis.

use std::collections::BTreeSet;

use fragbuf_codegen::{Form, Linking, link, plan};
use fragbuf_interpreter::{Bytecode, Options};
use fragbuf_targets::{TARGETS, check};
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::Feature;

use crate::subjects::variant;

#[test]
fn every_pass_of_every_row_compiles() {
    let registry = Registry::builtin();
    let mut sources: BTreeSet<String> = BTreeSet::new();
    let known = registry.techniques().iter();
    for technique in known {
        for row in registry.rows().iter().filter(|row| registry.axis(&row.axis).is_some_and(|axis| axis.chosen)) {
            let Ok(variant) = variant(&technique.key, &[(row.axis.as_str(), row.key.as_str())], &registry) else {
                continue;
            };
            for target in TARGETS {
                let mut provides = target.provides.to_vec();
                provides.push(Feature::OwnEntryPoints);
                let Ok(selection) = variant.select(&provides) else { continue };
                let plan = plan(&variant, &selection, &registry).unwrap();
                let linking = Linking { profile: target.profile, form: Form::Program, prefix: String::new(), group: 0 };
                for pass in link(&plan, &linking, &registry).unwrap().passes {
                    if !sources.insert(pass.text.clone()) {
                        continue;
                    }
                    let checked = check(pass, target.profile, &variant.name.span).unwrap();
                    for entry in &checked.pass().entry_points {
                        let program =
                            Bytecode::entry_point(checked.module(), checked.info(), &entry.name, &Options::default());
                        assert!(
                            program.is_ok(),
                            "{} {}={} {}: {program:?}",
                            technique.key,
                            row.axis,
                            row.key,
                            entry.name
                        );
                    }
                }
            }
        }
    }
    assert!(sources.len() > 40, "only {} sources", sources.len());
}
