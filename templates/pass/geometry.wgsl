// The vertex stage of every geometry pass. Positions are invariant: passes that draw the scene again must produce the
// same fragments.

@vertex
fn geometry(vertex: Vertex) -> VertexOutput {
    return vertex_output(vertex);
}
