//! Mangled names are valid in WGSL, unused otherwise, and distinct for distinct names.

#![allow(clippy::expect_used, reason = "a test fails by panicking")]

use std::collections::BTreeMap;

use fragbuf_model::mangled;

/// The names of WGSL §15.1 and §15.2, and examples of every other kind of reserved name.
const RESERVED: &str = "
    alias break case const const_assert continue continuing default diagnostic discard else enable false fn for if let
    loop override requires return struct switch true var while
    NULL Self abstract active alignas alignof as asm asm_fragment async attribute auto await become cast catch class
    co_await co_return co_yield coherent column_major common compile compile_fragment concept const_cast consteval
    constexpr constinit crate debugger decltype delete demote demote_to_helper do dynamic_cast enum explicit export
    extends extern external fallthrough filter final finally friend from fxgroup get goto groupshared highp impl
    implements import inline instanceof interface layout lowp macro macro_rules match mediump meta mod module move mut
    mutable namespace new nil noexcept noinline nointerpolation non_coherent noncoherent noperspective null nullptr of
    operator package packoffset partition pass patch pixelfragment precise precision premerge priv protected pub public
    readonly ref regardless register reinterpret_cast require resource restrict self set shared sizeof smooth snorm
    static static_assert static_cast std subroutine super target template this thread_local throw trait try type
    typedef typeid typename typeof union unless unorm unsafe unsized use using varying virtual volatile wgsl where with
    writeonly yield
    bool f16 f32 i32 u32 vec2 vec3 vec4 vec3f vec2u mat4x4 mat2x3f array atomic ptr sampler texture_2d
    texture_storage_2d texture_depth_multisampled_2d
    read write read_write function private workgroup uniform storage rgba8unorm r32uint bgra8unorm
    bitcast all any select arrayLength abs acos atan2 clamp cross degrees distance dot exp extractBits faceForward
    firstLeadingBit floor fma fract frexp ldexp length log max min mix modf normalize pow radians reflect refract
    reverseBits round saturate sign smoothstep sqrt step tan transpose trunc dpdx fwidth textureLoad atomicAdd
    atomicCompareExchangeWeak pack4x8unorm unpack2x16float storageBarrier workgroupBarrier workgroupUniformLoad
    subgroupAdd subgroupBallot quadSwapX
    Fragment Packed VertexOutput Vertex FragmentInput coverage uniforms frame CAPACITY user_weight storage_bound sync_begin sort_layers layer
    layer_count layers rust_odd
";

fn reserved() -> Vec<&'static str> {
    RESERVED.split_whitespace().collect()
}

#[test]
fn only_reserved_names_change() {
    for name in reserved() {
        assert_eq!(mangled(name), format!("{name}_"));
    }
    for name in ["f", "depth", "color", "id", "normal", "velocity", "x", "_x", "Glass", "sum", "weight", "min_", "a__b"]
    {
        let expected = if name.ends_with('_') { format!("{name}_") } else { name.to_string() };
        assert_eq!(mangled(name), expected);
    }
}

#[test]
fn distinct_names_stay_distinct() {
    let stems: Vec<&str> =
        reserved().into_iter().chain(["x", "_", "__", "__x", "_x", "rust", "rust_", "rust__x", "0"]).collect();
    let mut mangled_names: BTreeMap<String, String> = BTreeMap::new();
    for stem in stems {
        for prefix in ["", "_", "__", "rust", "rust_", "user_"] {
            for suffix in ["", "_", "__", "___", "0", "0_", "_0", "_1", "x"] {
                let name = format!("{prefix}{stem}{suffix}");
                let result = mangled(&name).into_owned();
                let other = mangled_names.insert(result.clone(), name.clone());
                assert!(other.is_none_or(|other| other == name), "two names become {result}: {name} and another");
            }
        }
    }
}

#[test]
fn every_result_is_an_unused_wgsl_identifier() {
    let reserved = reserved();
    for stem in reserved.iter().copied().chain(["_", "__", "___", "__x", "_x_", "x"]) {
        for suffix in ["", "_", "__"] {
            let name = format!("{stem}{suffix}");
            let result = mangled(&name);
            assert!(result != "_" && !result.starts_with("__"), "{name} becomes {result}");
            assert!(!reserved.contains(&result.as_ref()), "{name} becomes {result}, which is reserved");
        }
    }
}
