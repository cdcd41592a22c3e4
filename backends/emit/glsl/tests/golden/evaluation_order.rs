//! Golden tests of short circuits and the order of reads, writes and calls.

use super::expect;

#[test]
fn short_circuits() {
    expect(
        "decide",
        "fn decide(i: u32, strict: bool) -> bool {
            let near = i < LIMIT && a[i] != 0u;
            if near || (strict && bump(i) > 3u) { return true; }
            return !near && (a[0] == 1u || a[1] == 1u);
        }",
        "
bool decide(uint i, bool strict) {
    bool near = i < LIMIT && a[i] != 0u;
    if (near || (strict && bump(i) > 3u)) {
        return true;
    }
    return !near && (a[0] == 1u || a[1] == 1u);
}
",
    );
}

#[test]
fn swap_keeps_its_temporary() {
    expect(
        "swap",
        "fn swap(i: u32, j: u32) { let t = a[i]; a[i] = a[j]; a[j] = t; }",
        "
void swap(uint i, uint j) {
    uint t = a[i];
    a[i] = a[j];
    a[j] = t;
}
",
    );
}

#[test]
fn reads_do_not_pass_writes() {
    // The index is read before the call changes it, the value after.
    expect(
        "order",
        "fn order(i: u32) -> u32 {
            var n = i;
            let p = &a[n];
            n += 1u;
            *p = n;
            a[a[i]] = a[0] + bump(0u);
            return a[0] * bump(0u) + read(0u);
        }",
        "
uint order(uint i) {
    uint n = i;
    uint n_value = n;
    n++;
    a[n_value] = n;
    uint a_value = a[i];
    uint a_value_2 = a[0];
    a[a_value] = a_value_2 + bump(0u);
    uint a_value_3 = a[0];
    uint bump_result = bump(0u);
    return a_value_3 * bump_result + read(0u);
}
",
    );
}

#[test]
fn effects_are_not_skipped() {
    expect(
        "choose",
        "fn choose(c: bool) -> u32 { return select(bump(0u), a[1], c); }",
        "
uint choose(bool c) {
    uint bump_result = bump(0u);
    return c ? a[1] : bump_result;
}
",
    );
}

#[test]
fn effects_inside_arguments_are_not_skipped() {
    expect(
        "nested",
        "fn nested(c: bool) -> u32 {
            a[bump(1u)] = a[2];
            a[3] = bump(bump(4u));
            return select(0u, read(bump(0u)), c) + a[5];
        }",
        "
uint nested(bool c) {
    uint bump_result = bump(1u);
    a[bump_result] = a[2];
    a[3] = bump(bump(4u));
    uint read_result = read(bump(0u));
    return (c ? read_result : 0u) + a[5];
}
",
    );
}

#[test]
fn effects_keep_their_order_in_a_condition() {
    expect(
        "guarded",
        "fn guarded(i: u32) -> u32 {
            while a[0] > 1u && bump(0u) < 5u { a[1] += bump(i); }
            let sum = a[i] + u32(bump(1u) > 2u || bump(2u) > 3u);
            return sum;
        }",
        "
uint guarded(uint i) {
    while (a[0] > 1u) {
        if (bump(0u) >= 5u) {
            break;
        }
        uint a_value = a[1];
        a[1] = a_value + bump(i);
    }
    uint a_value = a[i];
    uint sum = a_value + uint(bump(1u) > 2u || bump(2u) > 3u);
    return sum;
}
",
    );
}
