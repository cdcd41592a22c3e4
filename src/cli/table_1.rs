//! `fragbuf list --table-1`: prints Table 1 of the k⁺-buffer paper, with the computed value of each cell.
//!
//! Input: the paper's rows and the registry. Output: Markdown. fragbuf's values are computed from plans.

use std::fmt::Write;

use fragbuf::Registry;
use fragbuf_templates::TABLE_1;

use super::output::Failure;
use super::paper_table::{both, properties};

const HEADER: &str = "# Table 1 of the k⁺-buffer paper, with the values of fragbuf

Vasilakis, Papaioannou & Fudos 2015 (K15), Table 1. `?` marks what is illegible in the available copy. Each cell has the value of the paper
and that of the plan: `paper → plan`, or one value if they agree. Computed by `fragbuf list --table-1`.

* The paper's second figures pack two layers into one texel, because its buffers are textures and few targets are available. fragbuf
  uses buffers: the payload's formats decide the packing, and only what a shader can hold limits k.
* *Primitives in order*: the plan says `yes` if the kept fragments depend on the order of arrival, or on races.
* *k up to*: the greatest k that the rules accept, for the papers' payload.
* *Artifacts*: the plan lists the hazards that its rows declare, by name; the pages of the techniques describe each.
* *Fixed*: whether memory use is independent of the scene; the paper's column is illegible.

| technique | geometry passes | primitives in order | fragments sorted | k up to | artifacts | words per pixel | fixed |
|---|---|---|---|---|---|---|---|
";

/// Returns the table.
pub(super) fn table(registry: &Registry) -> Result<String, Failure> {
    let mut text = HEADER.to_owned();
    for row in TABLE_1.rows {
        let Some(properties) = properties((row.key, row.name), &TABLE_1, registry)? else { continue };
        let cells: Vec<String> = properties.cells.iter().map(both).collect();
        let _ = writeln!(text, "| [{}]({}.md) | {} |", properties.name, properties.key, cells.join(" | "));
    }
    Ok(text)
}
