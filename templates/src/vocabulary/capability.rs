//! Capabilities that rows provide to each other. A combination of rows is legal if every required capability is
//! provided and every condition holds.

use super::names::names;

names! {
    /// Something that a row can provide and another row can require.
    Capability {
        // Between a storage and a sync.
        MutualExclusion "mutual exclusion between the fragments of one pixel";
        OrderedMutualExclusion "mutual exclusion between the fragments of one pixel, in submission order";
        Unsynchronised "unsynchronised fragments of one pixel";
        LockFree "a storage that synchronises fragments by its own atomic operations";
        RaceTolerant "a storage with defined behaviour when fragments race";
        FixedFunction "a storage that depth test, stencil test or blending synchronises";
        SyncInShader "synchronisation in shaders, so that the depth test is free";
        CullInShader "a cull that leaves the depth test free";
        SyncByFixedFunction "synchronisation by depth test, stencil test or blending";
        // Of a storage.
        KeepsAll "a storage that keeps every fragment";
        KeepsBest "a storage that keeps the k best";
        KeepsEqualKeys "a storage that keeps fragments with equal keys";
        AllocatesKBestOnly "a storage that allocates no memory for a fragment behind k better ones";
        SelectsBest "selection of the k best among all fragments";
        AcceptsKBestOnly "a storage that can receive only the k best fragments";
        ConservativeBound "a bound that no fragment of the final k best exceeds at any instant";
        DisplacesUnderLock "a storage in which a better fragment displaces a kept one inside the critical section";
        CanReplace "a full storage whose worst fragment can be replaced inside the critical section";
        OrderedSlots "slots in depth order, each of which can be replaced inside the critical section";
        KeyPerSlot "a resource with the key of each of the k best fragments of a pixel, equal keys included";
        SlotsPerPixel "k slots per pixel, which a reset pass empties";
        Counted "the number of fragments of each pixel before they are stored";
        KPerPixel "regions of fragments whose k may differ from pixel to pixel";
        ReportsWholeFragments "a storage that reports each lost fragment as a whole, with key and payload";
        KeepsArrival "kept fragments in the order of arrival if their keys are equal";
        Indexed "kept fragments with an index";
        OnePerSlot "a storage of one fragment for each slot of an iteration of peeling";
        Streams "a storage that passes fragments on in order, two neighbours at a time";
        // Of the fragments that reach a storage.
        NoCull "a storage that receives every fragment, without a cull";
        // Of the kept fragments in the resolve pass.
        Sorted "fragments in depth order";
        OneResolve "one resolve pass that serves every pixel";
        OneSample "one sample per pixel";
        StableSort "a sort that keeps the storage's order of fragments with equal depths";
        // Of the other choices, for peeling.
        DropsDisplaced "an overflow that drops displaced fragments";
        TotalOrder "ties that are resolved by the words of fragments";
        DividesLayers "peeling that divides the fragments of an iteration into slots: by depth, side, bucket or id";
        TellsIdsApart "iterations that tell fragments with equal keys apart by their ids";
        KeepsLater "peeling, whose iterations keep what earlier ones leave";
        Resumes "an effect that can continue with further fragments of a pixel";
        JoinsParts "an effect whose results for parts of a pixel's fragments can be joined";
        LayersInOrder "layers in the order of depth";
        // For the caller.
        CountsEvents "counters of every event of a frame, not only of losses";
        LeavesDepth "the depth of the nearest fragment in a depth buffer";
        // Of an effect.
        PairValues "a value for two neighbouring fragments";
    }
}
