// Sets the stencil of one sample of every pixel: what is drawn has no colour, the test's reference is the value.

@fragment
fn route() {}
