//! The module `bindings` that `fragbuf::fragment_buffer!` emits.

fragbuf::fragment_buffer! {
    buffer Bound from kplus_array {
        uniform { far: f32 }
        where |f, u| f.depth < u.far;
    }
}

/// A plan numbers buffers from 3 on, in the order of its rows: keys, entries and counts of the array, then the lock.
#[test]
fn bindings_are_those_of_the_plan() {
    use bound::bindings::{CAMERA, COUNTERS, ENTRIES, FRAME, KEPT_COUNTS, KEYS, LOCKS, UNIFORMS};
    assert_eq!([FRAME, UNIFORMS, CAMERA], [0, 1, 2]);
    assert_eq!([KEYS, ENTRIES, KEPT_COUNTS, LOCKS, COUNTERS], [3, 4, 5, 6, 7]);
}

/// A module without imports in which the names that the expansion uses are taken.
mod shadowed {
    #![deny(warnings, missing_docs, unreachable_pub, unused_qualifications)]
    #![allow(dead_code, non_camel_case_types)]

    mod fragbuf {}
    mod fragbuf_dsl {}
    mod fragbuf_bindings {}
    mod core {}
    struct u32;

    ::fragbuf::fragment_buffer! {
        /// Documentation and a visibility.
        pub(super) buffer Glass from kplus_array {}
    }
}

#[test]
fn the_expansion_names_only_its_own_crate() {
    assert_eq!(shadowed::glass::bindings::KEYS, 3);
    assert!(shadowed::glass::variant().is_ok());
}
