//! The compiler errors that a user of `fragment_buffer!` sees: every family of errors at the user's own token, and no error
//! of rustc about the expansion. A person reviews `ui/NAME.stderr`.

#[test]
fn mistakes_are_shown_at_the_users_tokens() {
    trybuild::TestCases::new().compile_fail("tests/ui/*.rs");
}
