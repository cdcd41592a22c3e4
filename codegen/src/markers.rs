//! The names of marker functions, without prefix. They mark operations that WGSL cannot express (`templates/shared/markers.wgsl`).
//! Back ends replace their calls with target-specific code, so linking does not fold them.

/// Orders memory accesses.
pub const MEMORY_FENCE: &str = "memory_fence";
/// Returns whether the invocation is a helper invocation.
pub const HELPER_LANE: &str = "is_helper_lane";
/// Begins the interlock.
pub const CRITICAL_BEGIN: &str = "critical_begin";
/// Ends the interlock.
pub const CRITICAL_END: &str = "critical_end";

/// All markers.
pub const MARKERS: [&str; 4] = [MEMORY_FENCE, HELPER_LANE, CRITICAL_BEGIN, CRITICAL_END];
