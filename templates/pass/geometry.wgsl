// The vertex stage of every geometry pass. Positions are invariant: passes that draw the same scene twice must see
// the same fragments.

@vertex
fn geometry(vertex: Vertex) -> Placed {
    return vertex_placed(vertex);
}
