//! Features of targets and devices that rows need. If a target lacks a feature, a description can name an alternative
//! row (`interlock else spin_lock`); the features of each target decide which row is used.

use super::names::names;

names! {
    /// Something that a target can provide and a row can need.
    Feature {
        FragmentAtomics "atomic operations in fragment shaders";
        Fences "memory fences in fragment shaders";
        Coherent "coherent plain words in buffers";
        Interlock "fragment shader interlock";
        OrderedInterlock "fragment shader interlock in submission order";
        U64Atomics "64-bit atomic operations that return a value";
        EarlyDepth "a forced early depth test";
        MinMaxBlend "blending by minimum and maximum";
        SampleMask "a fixed sample mask and several samples per pixel";
        Coverage "the coverage mask of a fragment, with several samples per pixel";
        Linkable "functions that the caller's shader can call";
        OwnEntryPoints "generated entry points: `--form program`";
        PrimitiveIndex "the primitive index of a fragment";
        SampleCounts "2 or 8 samples per pixel";
        BindGroups "more than 4 bind groups";
    }
}
