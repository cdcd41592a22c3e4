//! The WGSL spelling of the user's names.
//!
//! Input: an identifier of the user. Output: an identifier that is valid in WGSL and differs from all generated and
//! predeclared names; different names stay different. Each back end handles the keywords of its own target.

use std::borrow::Cow;
use std::collections::BTreeSet;
use std::sync::LazyLock;

/// Returns the WGSL spelling of `name`: the name itself, or with `_` appended if it is a keyword, a reserved word, a
/// built-in or a name of generated code. Different names have different spellings:
///
/// * a name that ends in `_` gets one more, so it differs from every name to which one `_` was appended;
/// * `_` and names that begin with `__`, which are invalid in WGSL, become `rust…0`; every other spelling that begins with
///   `rust_` ends in `_`.
pub fn mangled(name: &str) -> Cow<'_, str> {
    if name == "_" || name.starts_with("__") {
        Cow::Owned(format!("rust{name}0"))
    } else if name.ends_with('_') || is_taken(name) {
        Cow::Owned(format!("{name}_"))
    } else {
        Cow::Borrowed(name)
    }
}

/// Whether WGSL or generated code already has this name.
fn is_taken(name: &str) -> bool {
    static TAKEN: LazyLock<BTreeSet<&str>> = LazyLock::new(|| {
        [GENERATED, KEYWORDS, RESERVED, TYPES, ENUMERANTS, FUNCTIONS].iter().flat_map(|list| list.split(' ')).collect()
    });
    PREFIXES.iter().any(|prefix| name.starts_with(prefix)) || TAKEN.contains(name)
}

/// Names in generated code and templates.
const GENERATED: &str =
    "CAPACITY Fragment Packed VertexOutput Targets FragmentInput Vertex coverage frame main uniforms resumed Resumed";

/// Prefixes of names in generated code and templates.
const PREFIXES: [&str; 6] = ["layer", "rust_", "sort_", "storage_", "sync_", "user_"];

/// WGSL §15.1: keywords.
const KEYWORDS: &str = "\
    alias break case const const_assert continue continuing default diagnostic discard else enable false fn for if \
    let loop override requires return struct switch true var while";

/// WGSL §15.2: words reserved for later versions.
const RESERVED: &str = "\
    abstract active alignas alignof as asm asm_fragment async attribute auto await become cast catch class co_await \
    co_return co_yield coherent column_major common compile compile_fragment concept const_cast consteval constexpr \
    constinit crate debugger decltype delete demote demote_to_helper do dynamic_cast enum explicit export extends \
    extern external fallthrough filter final finally friend from fxgroup get goto groupshared highp impl implements \
    import inline instanceof interface layout lowp macro macro_rules match mediump meta mod module move mut mutable \
    namespace new nil noexcept noinline nointerpolation non_coherent noncoherent noperspective NULL null nullptr of \
    operator package packoffset partition pass patch pixelfragment precise precision premerge priv protected pub \
    public readonly ref regardless register reinterpret_cast require resource restrict Self self set shared sizeof \
    smooth snorm static static_assert static_cast std subroutine super target template this thread_local throw trait \
    try type typedef typeid typename typeof union unless unorm unsafe unsized use using varying virtual volatile \
    wgsl where with writeonly yield";

/// WGSL §6.9 and the aliases of §6.2: predeclared types and type generators, with those of known extensions.
const TYPES: &str = "\
    acceleration_structure array atomic binding_array bool buffer f16 f32 f64 i32 i64 mat2x2 mat2x2f mat2x2h mat2x3 \
    mat2x3f mat2x3h mat2x4 mat2x4f mat2x4h mat3x2 mat3x2f mat3x2h mat3x3 mat3x3f mat3x3h mat3x4 mat3x4f mat3x4h \
    mat4x2 mat4x2f mat4x2h mat4x3 mat4x3f mat4x3h mat4x4 mat4x4f mat4x4h ptr ray_query sampler sampler_comparison \
    texture_1d texture_2d texture_2d_array texture_3d texture_cube texture_cube_array texture_depth_2d \
    texture_depth_2d_array texture_depth_cube texture_depth_cube_array texture_depth_multisampled_2d \
    texture_external texture_multisampled_2d texture_storage_1d texture_storage_2d texture_storage_2d_array \
    texture_storage_3d u32 u64 vec2 vec2f vec2h vec2i vec2u vec3 vec3f vec3h vec3i vec3u vec4 vec4f vec4h vec4i \
    vec4u";

/// WGSL §6.3.1: predeclared enumerants, with those of known extensions.
const ENUMERANTS: &str = "\
    bgra8unorm function handle immediate private push_constant r16float r16sint r16snorm r16uint r16unorm r32float \
    r32sint r32uint r64uint r8sint r8snorm r8uint r8unorm read read_write rg11b10ufloat rg16float rg16sint rg16snorm \
    rg16uint rg16unorm rg32float rg32sint rg32uint rg8sint rg8snorm rg8uint rg8unorm rgb10a2uint rgb10a2unorm \
    rgba16float rgba16sint rgba16snorm rgba16uint rgba16unorm rgba32float rgba32sint rgba32uint rgba8sint rgba8snorm \
    rgba8uint rgba8unorm storage uniform workgroup write";

/// WGSL §17: built-in functions, with those of known extensions.
const FUNCTIONS: &str = "\
    abs acos acosh all any arrayLength asin asinh atan atan2 atanh atomicAdd atomicAnd atomicCompareExchangeWeak \
    atomicExchange atomicLoad atomicMax atomicMin atomicOr atomicStore atomicSub atomicXor bitcast bufferArrayView \
    bufferLength bufferView ceil clamp cos cosh countLeadingZeros countOneBits countTrailingZeros cross degrees \
    determinant distance dot dot4I8Packed dot4U8Packed dpdx dpdxCoarse dpdxFine dpdy dpdyCoarse dpdyFine exp exp2 \
    extractBits faceForward firstLeadingBit firstTrailingBit floor fma fract frexp fwidth fwidthCoarse fwidthFine \
    insertBits inverseSqrt ldexp length log log2 max min mix modf normalize pack2x16float pack2x16snorm \
    pack2x16unorm pack4x8snorm pack4x8unorm pack4xI8 pack4xI8Clamp pack4xU8 pack4xU8Clamp pow quadBroadcast \
    quadSwapDiagonal quadSwapX quadSwapY quantizeToF16 radians reflect refract reverseBits round saturate select \
    sign sin sinh smoothstep sqrt step storageBarrier subgroupAdd subgroupAll subgroupAnd subgroupAny subgroupBallot \
    subgroupBroadcast subgroupBroadcastFirst subgroupElect subgroupExclusiveAdd subgroupExclusiveMul \
    subgroupInclusiveAdd subgroupInclusiveMul subgroupMax subgroupMin subgroupMul subgroupOr subgroupShuffle \
    subgroupShuffleDown subgroupShuffleUp subgroupShuffleXor subgroupXor tan tanh textureBarrier textureDimensions \
    textureGather textureGatherCompare textureLoad textureNumLayers textureNumLevels textureNumSamples textureSample \
    textureSampleBaseClampToEdge textureSampleBias textureSampleCompare textureSampleCompareLevel textureSampleGrad \
    textureSampleLevel textureStore transpose trunc unpack2x16float unpack2x16snorm unpack2x16unorm unpack4x8snorm \
    unpack4x8unorm unpack4xI8 unpack4xU8 workgroupBarrier workgroupUniformLoad";
