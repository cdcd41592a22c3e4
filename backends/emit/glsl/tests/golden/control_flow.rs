//! Golden tests of loops, branches and the declarations in them.

use super::expect;
use super::support::print;
use fragbuf_glsl::{Dialect, Unit};

#[test]
fn for_loop() {
    expect(
        "sum",
        "fn sum(n: u32) -> u32 {
            var total = 0u;
            for (var i = 0u; i < n; i++) {
                if a[i] == 0u { continue; }
                total += a[i];
            }
            for (var i = n; i > 0u; i -= 2u) { total ^= i; }
            return total;
        }",
        "
uint sum(uint n) {
    uint total = 0u;
    for (uint i = 0u; i < n; i++) {
        if (a[i] == 0u) {
            continue;
        }
        total += a[i];
    }
    for (uint i = n; i > 0u; i -= 2u) {
        total ^= i;
    }
    return total;
}
",
    );
}

#[test]
fn for_loop_over_an_outer_variable() {
    expect(
        "find",
        "fn find(n: u32) -> u32 {
            var i: u32;
            for (i = n; i < LIMIT; i++) {
                if a[i] == 0u { break; }
            }
            return i;
        }",
        "
uint find(uint n) {
    uint i = n;
    for (; i < LIMIT; i++) {
        if (a[i] == 0u) {
            break;
        }
    }
    return i;
}
",
    );
}

#[test]
fn while_loop_with_continue() {
    expect(
        "walk",
        "fn walk(head: u32) -> u32 {
            var node = head;
            var count = 0u;
            while node != 0u && count < LIMIT {
                node = a[node];
                if node == 7u { continue; }
                count++;
            }
            return count;
        }",
        "
uint walk(uint head) {
    uint node = head;
    uint count = 0u;
    while (node != 0u) {
        if (count >= LIMIT) {
            break;
        }
        node = a[node];
        if (node == 7u) {
            continue;
        }
        count++;
    }
    return count;
}
",
    );
}

/// Only the dialects of OpenGL split the test of a loop.
#[test]
fn vulkan_keeps_the_test_of_a_loop() {
    let source = "@group(0) @binding(0) var<storage, read_write> a: array<u32>;
        fn last(n: u32) -> u32 {
            var i = n;
            while i > 0u && a[i] < a[i - 1u] && a[i] != 3u { i--; }
            return i;
        }
        @compute @workgroup_size(1) fn main() { a[0] = last(a[1]); }";
    let print = |dialect| print(source, Unit::EntryPoint("main"), dialect).unwrap();
    assert!(print(Dialect::Vulkan450).contains("while (i > 0u && a[i] < a[i - 1u] && a[i] != 3u) {\n"));
    let exits = "while (i > 0u) {
        if (a[i] >= a[i - 1u]) {
            break;
        }
        if (a[i] == 3u) {
            break;
        }
        i--;
    }";
    for dialect in [Dialect::OpenGl450, Dialect::Es310] {
        let text = print(dialect);
        assert!(text.contains(exits), "{text}");
    }
}

#[test]
fn continuing_runs_at_continue() {
    expect(
        "spin",
        "fn spin(n: u32) {
            var i = 0u;
            loop {
                if a[i] == n { continue; }
                a[i] = n;
                continuing {
                    i += 1u;
                    a[0] = i;
                    break if i == 9u;
                }
            }
        }",
        "
void spin(uint n) {
    uint i = 0u;
    while (true) {
        if (a[i] == n) {
            i++;
            a[0] = i;
            if (i == 9u) {
                break;
            }
            continue;
        }
        a[i] = n;
        i++;
        a[0] = i;
        if (i == 9u) {
            break;
        }
    }
}
",
    );
}

#[test]
fn variables_of_a_loop_body_are_reinitialised() {
    expect(
        "anew",
        "fn anew(n: u32) {
            for (var i = 0u; i < n; i++) {
                var seen: bool;
                var first = i;
                if a[i] > 3u { seen = true; first = 2u; }
                if seen { a[i] = first; }
            }
        }",
        "
void anew(uint n) {
    for (uint i = 0u; i < n; i++) {
        bool seen = false;
        uint first = i;
        if (a[i] > 3u) {
            seen = true;
            first = 2u;
        }
        if (seen) {
            a[i] = first;
        }
    }
}
",
    );
}

#[test]
fn else_if_chain() {
    expect(
        "grade",
        "fn grade(n: u32) -> u32 {
            if n < 3u { return 0u; } else if n < 5u && a[n] == 1u { return 1u; } else if n < 9u { a[n] = 2u; } else { a[n] = 3u; }
            return n;
        }",
        "
uint grade(uint n) {
    if (n < 3u) {
        return 0u;
    } else if (n < 5u && a[n] == 1u) {
        return 1u;
    } else if (n < 9u) {
        a[n] = 2u;
    } else {
        a[n] = 3u;
    }
    return n;
}
",
    );
}

#[test]
fn spin_lock() {
    expect(
        "sync_store",
        "fn sync_store(pixel: u32, key: u32) {
            if is_helper_lane() { return; }
            for (var attempt = 0u; attempt < LIMIT; attempt++) {
                if atomicCompareExchangeWeak(&locks[pixel], 0u, 1u).exchanged {
                    memory_fence();
                    // slot 0 is published last
                    a[pixel] = key;
                    memory_fence();
                    atomicStore(&locks[pixel], 0u);
                    return;
                }
            }
            a[0] = key;
        }",
        "
void sync_store(uint pixel, uint key) {
    if (gl_HelperInvocation) {
        return;
    }
    for (uint attempt = 0u; attempt < LIMIT; attempt++) {
        if (atomicCompSwap(locks[pixel], 0u, 1u) == 0u) {
            memoryBarrierBuffer();
            // slot 0 is published last
            a[pixel] = key;
            memoryBarrierBuffer();
            locks[pixel] = 0u;
            return;
        }
    }
    a[0] = key;
}
",
    );
}
