// Sets the stencil of one sample of every pixel to the reference of the stencil test. It writes no colour.

@fragment
fn route() {}
