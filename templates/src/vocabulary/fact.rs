//! What rows offer each other. Legality is `requires ⊆ offers` over the chosen rows, and conditions that hold.

use super::words::words;

words! {
    /// One thing that a row can offer, and another require.
    Fact {
        // Between a storage and a sync.
        Critical "that writers of one pixel take turns";
        OrderedCritical "that writers of one pixel take turns in the order of submission";
        Race "that writers of one pixel race, and no one keeps them apart";
        OwnAtomics "a storage that keeps writers apart by its own atomic operations";
        SurvivesRaces "a storage whose behaviour stays defined when writers race";
        FixedFunction "a storage that leaves writers to depth test, stencil or blending";
        LeftToShaders "that shaders keep writers of one pixel apart, so that their depth test is free";
        CullInShader "a cull that leaves the depth test free";
        LeftToTests "that writers of one pixel are left to depth test, stencil or blending";
        // What a storage can be asked.
        KeepsAll "a storage that keeps every fragment";
        KeepsBest "a storage that keeps the k best";
        SparesRoom "a storage that gives no room to a fragment behind k better ones";
        SelectsBest "that the k best are chosen among all";
        BestSuffice "a storage that may be handed the k best fragments alone";
        BoundAnyInstant "a bound that no fragment of the final k best ever fails, at any instant";
        DisplacesInTurn "a storage in which, inside the critical section, a better fragment displaces a kept one";
        CanReplace "that the worst kept fragment can be replaced inside the critical section, once there are k";
        OrderedSlots "slots in the order of depth, each of which can be replaced inside the critical section";
        Counted "the number of fragments of each pixel, known before they are stored";
        LosesWhole "that a fragment which finds no place is lost whole, key and payload together";
        KeepsArrival "kept fragments that stay in the order of arrival where their keys are equal";
        Indexed "kept fragments with an index";
        Streams "a storage that hands fragments on in order, two neighbours at a time";
        // What comes to it.
        CullsNothing "that no fragment is turned away before the storage sees it";
        // What the kept fragments are, once gathered.
        Sorted "fragments in the order of depth";
        OneResolve "one resolve pass that serves every pixel";
        OneSample "one sample per pixel";
        StableSort "a sort that leaves fragments of equal depth as the storage gives them";
        // What a caller may be told, or take over.
        CountsEvents "that every event of a frame is counted, and not losses alone";
        LeavesDepth "the depth of the nearest fragment, left in a depth buffer";
        // What they are worth.
        ValuesPairs "a value for two neighbouring fragments";
    }
}
