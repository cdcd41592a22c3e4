// Draws the boxes of objects for occlusion queries. Nothing is written.

@fragment
fn boxes() {}
