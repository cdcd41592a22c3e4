fn user_criterion(f: Fragment) -> f32 {
    return f.depth;
}
