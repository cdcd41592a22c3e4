//! What the compiler shows a user of `fragment_buffer!`: every family of mistakes at the user's own token, and nothing
//! of rustc's own about the expansion. `ui/NAME.stderr` is reviewed by eye.

#[test]
fn mistakes_are_shown_at_the_users_tokens() {
    trybuild::TestCases::new().compile_fail("tests/ui/*.rs");
}
