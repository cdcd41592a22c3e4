//! What a target or a device can express, and rows need of it. A description names several rows where one target lacks
//! what the first needs (`interlock else spin_lock`); which of them is taken is decided per target.

use super::words::words;

words! {
    /// One thing that a target can offer, and a row need.
    Capability {
        FragmentAtomics "atomic operations in fragment shaders";
        Fences "memory fences in fragment shaders";
        Coherent "coherent plain words in buffers";
        Interlock "fragment shader interlock";
        OrderedInterlock "fragment shader interlock in the order of submission";
        U64Atomics "64-bit atomic operations that return a value";
        EarlyDepth "a forced early depth test";
        MinMaxBlend "blending by minimum and maximum";
        SampleMask "a fixed sample mask and several samples per pixel";
        Coverage "which samples of its pixel a fragment covers, several samples per pixel";
        Linkable "functions that a caller's own shader can call";
        OwnEntryPoints "entry points of its own: `--form program`";
        PrimitiveIndex "the number of a fragment's triangle";
    }
}
