// Markers for what WGSL cannot express: a memory fence, the built-in for helper invocations, begin and end of an
// interlock. Back ends replace calls to these functions with target-specific code. In plain WGSL they do nothing, and
// the soundness tier shows the consequence.

/// Orders this invocation's buffer accesses before the call and those after it, for every other invocation.
fn memory_fence() {}

/// Returns whether this is a helper invocation: its stores and atomics have no effect, so a wait would not end.
fn is_helper_lane() -> bool {
    return false;
}

/// Begins a critical section of the pixel, which `critical_end` ends. The call is at the top level of an entry point.
fn critical_begin() {}

fn critical_end() {}
