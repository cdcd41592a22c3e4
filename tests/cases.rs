//! Descriptions that several tests use, and the way from a description to its generation.

use std::collections::BTreeSet;
use std::sync::LazyLock;

use fragbuf::load::{Description, variant};
use fragbuf::vocabulary::Row;
use fragbuf::{Form, Generation, Registry, Request, TARGETS, Target, Variant, generate};

/// A description with every attribute format, two constraints, a criterion, uniforms, options and a closure.
pub const CUSTOM: &str = "
buffer Custom from kplus_array {
    fragment { color: rgba8, depth: f32, id: u32, normal: octahedral, velocity: vec3, uv: vec2, glow: vec4, heat: f32, tint: rgba16 }
    uniform { cut: f32, eye: vec3, steps: u32, offset: i32, scale: vec2, tint: vec4 }
    keep 5 least |f| f.depth - 0.25 * f.color.w + 0.1 * f.heat;
    where |f, u| f.depth > u.cut;
    where |f, u| f.id != u.steps;
    sync: spin_lock { limit: 100 };
    resolve |fragments, u| {
        let mut color = vec3(0.0, 0.0, 0.0);
        let mut transmittance = 1.0;
        for f in fragments {
            let alpha = f.color.w * f.normal.dot(u.eye).abs();
            color += transmittance * alpha * f.color.truncate();
            transmittance *= 1.0 - alpha;
            if transmittance < 0.01 { break; }
        }
        color.extend(1.0 - transmittance) * u.tint
    }
}";

/// A description of depth only, without value words.
pub const DEPTH_ONLY: &str = "
buffer Thickness from kplus_array {
    fragment { depth: f32 }
    resolve |fragments, u| {
        let mut thickness = 0.0;
        let mut sign = -1.0;
        for f in fragments { thickness += sign * f.depth; sign = -sign; }
        vec4(thickness, thickness, thickness, 1.0)
    }
}";

/// An effect that iterations of peeling interrupt: with variables of every type, an index, `break` and `return`.
pub const CONTINUED: &str = "
buffer Continued from f2b_ll {
    fragment { color: rgba8, depth: f32, id: u32 }
    uniform { solid: u32, least: f32 }
    resolve |fragments, u| {
        let most = u.least.max(0.01);
        let mut inside = false;
        let mut crossings = 0;
        let mut last = -1_i32;
        let mut light = Vec3::ZERO;
        let mut left = 1.0;
        for (i, f) in fragments.iter().enumerate() {
            if f.id == u.solid { inside = !inside; crossings += 1; last = i as i32; }
            if i > 60 { return vec4(1.0, 0.0, 0.0, 1.0); }
            for step in 0..2 { if step as u32 > f.id { break; } }
            if !inside {
                light += left * f.color.w * f.color.truncate();
                left *= 1.0 - f.color.w;
            }
            if left < most { break; }
        }
        if crossings % 2 == 1 && last >= 0 { light *= 0.5; }
        light.extend(1.0 - left)
    }
}";

/// A description with textures in every closure, and images that read earlier images.
pub const TEXTURED: &str = "
buffer Textured from kplus_array {
    fragment { color: rgba8, depth: f32 }
    texture { bias: 2d, volume: 3d }
    keep 6 least |f, u| f.depth + 0.1 * u.bias.sample(vec2(f.depth, 0.5)).x;
    where |f, u| u.volume.load((f.depth * 8.0) as i32, 0, 1).w > 0.25;
    image first |fragments, u| u.volume.sample(vec3(fragments[0].depth, 0.5, 0.25));
    image blurred |fragments, u| {
        let mut sum = Vec4::ZERO;
        for y in -1..=1 {
            for x in -1..=1 { sum += u.first.at(x, y); }
        }
        sum * (1.0 / 9.0)
    }
    resolve |fragments, u| {
        let edge = u.blurred.at(1, 0) - u.blurred.at(-1, 0);
        let near = u.volume.sample_nearest(fragments[0].color.truncate());
        (edge.truncate() + near.truncate() * (u.bias.width() as f32)).extend(1.0)
    }
}";

/// The effect of neighbours along the ray.
pub const PAIRS: &str = "
buffer Pairs from kb_stream {
    fragment { color: rgba8, depth: f32, heat: f32 }
    uniform { density: f32 }
    texture { table: 2d }
    keep 6;
    between |front, back, gap, u| {
        let opacity = 1.0 - (-u.density * gap).exp();
        opacity * u.table.sample(vec2(front.heat, back.heat))
    }
}";

/// A description with attributes whose names are keywords or generated names in some language.
pub const RESERVED: &str = "
buffer Reserved from ab_ll {
    fragment { color: vec4, depth: f32, key: u32, sample: f32, position: vec2, buffer: f32, main: u32, mix: f32 }
    uniform { texture: f32, discard: u32 }
    where |f, u| f.sample + f.buffer + f.mix > u.texture && f.main + f.key != u.discard;
}";

/// A description of where fragments are, and which side of a triangle is visible.
pub const SIDES: &str = "
buffer Sides from kplus_array {
    fragment { depth: f32, front: u32, position: vec3 }
    uniform { eye: vec3 }
    resolve |fragments, u| {
        let mut thickness = 0.0;
        for f in fragments {
            let distance = (f.position - u.eye).length();
            if f.front == 1 { thickness -= distance; } else { thickness += distance; }
        }
        vec4(thickness, thickness, thickness, 1.0)
    }
}";

/// Name, description, and values set on it.
pub type Case = (&'static str, Description, Vec<(&'static str, &'static str)>);

/// Returns the snapshot cases. Together they use every value of every axis.
pub fn named() -> Vec<Case> {
    static UNNAMED: LazyLock<Vec<Case>> = LazyLock::new(unnamed);
    written().into_iter().chain(UNNAMED.iter().cloned()).collect()
}

/// Returns a case for every row that no written case uses: a storage by itself, any other row with the first technique that allows it.
fn unnamed() -> Vec<Case> {
    let registry = Registry::builtin();
    let mut seen: BTreeSet<(String, String)> = BTreeSet::new();
    for (_, description, set) in written() {
        let variant = checked(&description, &set).unwrap_or_else(|diagnostics| panic!("{diagnostics}"));
        let rows = variant.choices.iter().flat_map(|chosen| &chosen.alternatives).map(|selected| &selected.row);
        seen.extend(rows.map(|row| (row.axis.clone(), row.key.clone())));
    }
    let is_chosen = |row: &&Row| registry.axis(&row.axis).is_some_and(|axis| axis.chosen);
    let is_new = |row: &&Row| !seen.contains(&(row.axis.clone(), row.key.clone())) && !Registry::is_of_closures(row);
    registry.rows().iter().filter(is_chosen).filter(is_new).map(|row| case_of(row, &registry)).collect()
}

fn case_of(row: &Row, registry: &Registry) -> Case {
    let (axis, key): (&'static str, &'static str) = (row.axis.clone().leak(), row.key.clone().leak());
    let alone =
        ["keep 8;", "keep 1;", ""].map(|keep| (text(&format!("buffer Single {{ storage: {key}; {keep} }}")), vec![]));
    let techniques = registry.techniques().iter().flat_map(|technique| {
        let with = |more: Option<(&'static str, &'static str)>| {
            let set = std::iter::once((axis, key)).chain(more).collect();
            (Description::Technique(technique.key.clone()), set)
        };
        [with(None), with(Some(("k", "1")))]
    });
    let candidates: Vec<(Description, Vec<(&'static str, &'static str)>)> =
        if axis == "storage" { alone.to_vec() } else { techniques.collect() };
    let legal = candidates.into_iter().find(|(description, set)| checked(description, set).is_ok());
    let (description, set) = legal.unwrap_or_else(|| panic!("no description allows `{axis}: {key}`"));
    (key, description, set)
}

fn written() -> Vec<Case> {
    let technique = |key: &str| Description::Technique(key.to_owned());
    vec![
        ("kb", technique("kb"), vec![]),
        ("kplus_array", technique("kplus_array"), vec![]),
        ("ab_ll", technique("ab_ll"), vec![]),
        ("ab_sb", technique("ab_sb"), vec![]),
        ("kb_ps", technique("kb_ps"), vec![]),
        ("kplus_heap", technique("kplus_heap"), vec![]),
        ("mdt32_coplanar", technique("mdt32_coplanar"), vec![]),
        ("ab_array", technique("ab_array"), vec![]),
        ("kb_ab_ll", technique("kb_ab_ll"), vec![]),
        ("kb_mdt32", technique("kb_mdt32"), vec![]),
        ("kb_mdt64", technique("kb_mdt64"), vec![]),
        ("kplus_array_revised", technique("kplus_array_revised"), vec![]),
        ("kb_ll", technique("kb_ll"), vec![]),
        ("depth_partition", technique("depth_partition"), vec![("storage.near", "100000")]),
        ("kplus_ab_sb", technique("kplus_ab_sb"), vec![("k", "32")]),
        ("unified", technique("unified"), vec![]),
        ("k_peeling", technique("k_peeling"), vec![]),
        ("f2b", technique("f2b"), vec![]),
        ("f2b2", technique("f2b2"), vec![]),
        ("f2b_ll", technique("f2b_ll"), vec![]),
        ("f2b_fab", technique("f2b_fab"), vec![]),
        ("f2b_kb", technique("f2b_kb"), vec![]),
        ("dual_ll", technique("dual_ll"), vec![]),
        ("dual_fab", technique("dual_fab"), vec![]),
        ("dual_kb", technique("dual_kb"), vec![]),
        ("f2b_2p", technique("f2b_2p"), vec![]),
        ("f2b_1p", technique("f2b_1p"), vec![]),
        ("continued", text(CONTINUED), vec![]),
        ("textured", text(TEXTURED), vec![]),
        ("pairs", text(PAIRS), vec![]),
        (
            "pairs_sorted",
            text(PAIRS),
            vec![("storage", "linked_list"), ("sync", "slot_counter"), ("k", "all"), ("sort", "insertion")],
        ),
        ("f2b_3p", technique("f2b_3p"), vec![]),
        ("dual", technique("dual"), vec![]),
        ("dual_2p", technique("dual_2p"), vec![]),
        ("bun", technique("bun"), vec![]),
        ("bad", technique("bad"), vec![]),
        ("predicted", technique("mdt32_coplanar"), vec![("allocation", "predicted"), ("allocation.hit_ratio", "90")]),
        ("by_importance", technique("kplus_ab_sb"), vec![("allocation", "by_importance")]),
        ("temporal", technique("kplus_array"), vec![("cull", "temporal")]),
        ("ab_ll_paged", technique("ab_ll_paged"), vec![]),
        ("ab_ll_bun", technique("ab_ll_bun"), vec![]),
        ("kb_stream", technique("kb_stream"), vec![]),
        ("kb_mha", technique("kb_mha"), vec![]),
        ("kb_multi", technique("kb_multi"), vec![]),
        ("z_buffer", technique("z_buffer"), vec![]),
        ("kb_sr", technique("kb_sr"), vec![]),
        ("reserving_interlock", technique("kplus_array_revised"), vec![("sync", "interlock")]),
        ("occupancy", technique("kplus_array"), vec![("cull", "occupancy")]),
        ("occupancy_early", technique("kb_ps"), vec![("cull", "occupancy_early else occupancy")]),
        ("occupancy_custom", text(CUSTOM), vec![("cull", "occupancy"), ("cull.words", "2"), ("counters", "all")]),
        ("opaque_in_shader", technique("kplus_ab_sb"), vec![("opaque", "in_shader"), ("counters", "all")]),
        ("opaque_early", technique("mdt32_coplanar"), vec![("opaque", "early_depth else in_shader")]),
        ("custom", text(CUSTOM), vec![]),
        ("depth_only", text(DEPTH_ONLY), vec![]),
        ("sides", text(SIDES), vec![]),
        ("reserved", text(RESERVED), vec![]),
        ("statistics", technique("kplus_array"), vec![("counters", "all"), ("cull", "none"), ("k", "1")]),
        (
            "unsorted",
            text(DEPTH_ONLY),
            vec![
                ("sort", "none"),
                ("storage", "linked_list"),
                ("sync", "slot_counter"),
                ("cull", "none"),
                ("k", "all"),
            ],
        ),
        ("shell", technique("kplus_array"), vec![("sort", "shell"), ("k", "32")]),
        ("hybrid", technique("ab_ll"), vec![("sort", "hybrid"), ("sort.insertion", "8")]),
        ("bitonic", technique("ab_sb"), vec![("sort", "bitonic"), ("sort.layers", "33")]),
        (
            "submission",
            technique("kb_ps"),
            vec![("sync", "interlock_ordered"), ("ties", "submission"), ("sort", "insertion")],
        ),
        (
            "ties_by_attribute",
            text(CUSTOM),
            vec![("ties", "attribute"), ("ties.by", "id"), ("k", "3"), ("storage", "max_heap")],
        ),
        (
            "multisample",
            technique("kplus_array"),
            vec![("samples", "coverage"), ("overflow", "weighted_tail"), ("cull", "none")],
        ),
        ("weighted_tail", technique("kb_ab_ll"), vec![("overflow", "weighted_tail"), ("k", "4")]),
        ("tail_blend", technique("kb_ps"), vec![("overflow", "tail_blend"), ("cull", "none")]),
        ("merge_last", technique("kplus_array"), vec![("overflow", "merge_last"), ("cull", "none"), ("k", "4")]),
        (
            "merge_closest",
            technique("kb_ps"),
            vec![("overflow", "merge_closest"), ("cull", "none"), ("fragment.color", "rgba16")],
        ),
        ("fail", technique("ab_array"), vec![("overflow", "fail")]),
        ("lplus", technique("ab_ll"), vec![("sort", "lplus"), ("resolve.opaque", "4")]),
        ("backwards_memory", technique("ab_ll"), vec![("sort", "backwards_memory"), ("sort.layers", "24")]),
        ("block", technique("kb_ab_ll"), vec![("sort", "block")]),
        ("tiled", technique("ab_sb"), vec![("addressing", "tiled")]),
        ("morton", technique("kplus_array"), vec![("addressing", "morton")]),
        ("interlock_else_lock", technique("kplus_array"), vec![("sync", "interlock else spin_lock")]),
        (
            "locked_sorted_array",
            technique("kb"),
            vec![("sync", "spin_lock"), ("cull", "early"), ("ties", "unordered"), ("counters", "none")],
        ),
    ]
}

pub fn text(text: &str) -> Description {
    Description::Text { file: "case.fragbuf".to_owned(), text: text.to_owned() }
}

pub fn checked(description: &Description, set: &[(&str, &str)]) -> Result<Variant, fragbuf::Diagnostics> {
    let set: Vec<(String, String)> =
        set.iter().map(|(name, value)| ((*name).to_owned(), (*value).to_owned())).collect();
    variant(description, &set, &Registry::builtin())
}

/// Tests whether a message or a help ends in a list without elements, as in "is provided by ".
pub fn has_empty_list(diagnostic: &fragbuf::Diagnostic) -> bool {
    let is_cut = |text: &str| text.ends_with([' ', ':', ',']) || text.contains("()") || text.contains(" , ");
    is_cut(&diagnostic.message) || is_cut(&diagnostic.help)
}

/// Generates every target in program form.
pub fn generated(variant: &Variant) -> Generation {
    let targets: Vec<&'static Target> = TARGETS.iter().collect();
    let request = Request { targets: &targets, form: Form::Program, prefix: "", group: 0 };
    generate(variant, &request, &Registry::builtin()).unwrap_or_else(|diagnostics| panic!("{diagnostics}"))
}

/// A seeded random number generator (SplitMix64).
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    pub fn below(&mut self, bound: usize) -> usize {
        (self.next() % bound as u64) as usize
    }

    pub fn pick<'a, T>(&mut self, list: &'a [T]) -> &'a T {
        &list[self.below(list.len())]
    }
}
