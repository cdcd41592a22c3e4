// The vertex stage of every geometry pass. Positions are invariant: passes that draw the same scene twice must see
// the same fragments.

@vertex
fn geometry(vertex: Vertex) -> Varyings {
    return vertex_varyings(vertex);
}
