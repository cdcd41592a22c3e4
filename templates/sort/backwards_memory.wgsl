// Backwards memory allocation (Knowles, Leach & Zambetta 2013). What an array in private memory costs follows from its
// length, not from its use: a long one leaves room for few pixels at a time. So the resolve pass runs once per class
// of lengths, each with an array of its own, and every pixel is resolved in the pass of the shortest that holds its
// fragments. The paper sends pixels to their class by stencil; here every pass counts, and leaves alone whom it does
// not serve: a pixel without layers keeps what the target held.

var<private> backwards_count: u32;

fn sort_gather(entry: Packed) {
    backwards_count += 1u;
}

fn sort_finish() {
    if backwards_count <= CLASS_ABOVE || backwards_count > CLASS_MOST {
        return;
    }
    for (var cursor = resolve_first(); cursor != END; cursor = resolve_next(cursor)) {
        layers_insert(resolve_read(cursor));
    }
}
