// Backwards memory allocation (Knowles, Leach & Zambetta 2013). The cost of an array in private memory depends on its
// length, not on its use: a long array reduces the number of pixels in flight. So the resolve pass runs once per class
// of lengths, each with its own array, and each pixel is resolved in the pass of the shortest array that holds its
// fragments. The paper assigns pixels to classes by stencil. Here every pass counts the fragments and skips the pixels
// of other classes: a pixel without layers keeps the content of the target.

var<private> backwards_count: u32;

fn sort_begin() {
    backwards_count = 0u;
    layers_begin();
}

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
