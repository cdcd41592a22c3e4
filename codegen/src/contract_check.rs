//! Checks templates against the contracts that they implement.

use fragbuf_templates::Registry;

use crate::contract::CONTRACTS;
use crate::link::{FunctionSignature, signatures};

/// Checks the functions of all templates against the contracts. Returns one message per mismatch.
pub fn verify(registry: &Registry) -> Vec<String> {
    let mut problems = Vec::new();
    for row in registry.rows() {
        let Some(template) = &row.template else { continue };
        let signatures = signatures(&template.source);
        for contract in CONTRACTS {
            for FunctionSignature { name, signature, .. } in &signatures {
                if *name == contract.name && (row.axis != contract.axis || *signature != contract.signature) {
                    problems.push(format!(
                        "{}: `fn {name}{signature}` should be `fn {name}{}`",
                        template.path, contract.signature
                    ));
                }
            }
        }
        let provides_any =
            CONTRACTS.iter().any(|contract| signatures.iter().any(|function| function.name == contract.name));
        let is_chosen = registry.axis(&row.axis).is_some_and(|axis| axis.chosen);
        if is_chosen && !provides_any && CONTRACTS.iter().any(|contract| contract.axis == row.axis) {
            problems.push(format!("{}: provides no function of the contract `{}`", template.path, row.axis));
        }
    }
    problems
}
