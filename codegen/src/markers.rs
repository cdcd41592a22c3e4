//! Marker functions: what WGSL has no word for (`templates/shared/markers.wgsl`), by name, before any prefix. Targets put
//! words of their own in place of their calls, so linking leaves them alone.

/// Orders memory accesses.
pub const MEMORY_FENCE: &str = "memory_fence";
/// Whether this is a helper invocation.
pub const HELPER_LANE: &str = "is_helper_lane";
/// The interlock begins.
pub const CRITICAL_BEGIN: &str = "critical_begin";
/// The interlock ends.
pub const CRITICAL_END: &str = "critical_end";

/// All of them.
pub const MARKERS: [&str; 4] = [MEMORY_FENCE, HELPER_LANE, CRITICAL_BEGIN, CRITICAL_END];
