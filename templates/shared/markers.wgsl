// What WGSL cannot say. The printers of other targets put their own words in place of calls to these functions: a
// memory fence, the built-in for helper invocations. In plain WGSL they do nothing, and the soundness tier says
// what that costs.

/// Orders this invocation's accesses to buffers before the call ahead of those after it, for every other invocation.
fn memory_fence() {}

/// Whether this invocation only serves derivatives: its stores and atomics have no effect, so it would wait for ever.
fn is_helper_lane() -> bool {
    return false;
}
