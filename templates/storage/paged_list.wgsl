// Lists of pages (after Crassin 2010): a page holds PAGE_ENTRIES fragments of one pixel, and pages are linked, not
// fragments. Every pixel has a first page of its own; a fragment that finds the last page full takes another from the
// pool, links it back to that page and moves the pixel's cursor there by one compare and exchange. The cursor is the
// place after the pixel's last fragment, and 0 where there is none.
//
// Invariant: places below the cursor in its page are taken, each by the fragment that moved the cursor past it; all
// pages that the links lead back to are full. A link is written by its page's owner before the cursor leads there, and
// places are read only after the pass, so no order of writers shows.
//
// Where several fragments find the page full at once, one page is used and the others leak: they are counted, and what
// they hold is missing from the pool. Printed designs lock the page instead. A fragment keeps its page over retries, so
// it takes one at most.
//
// Memory: a page per pixel and one for every PAGE_ENTRIES fragments, of PAGE_ENTRIES * entry_words words; 1 word per
// page of the pool, 1 per pixel. So as many fragments as there is room for fit however they lie, unless pages leak.

/// No page of its own, for a fragment.
const NO_PAGE = 0xffffffffu;

fn storage_insert(pixel: u32, entry: Packed) {
    // A helper lane's exchange has no effect: it would try to the end.
    if is_helper_lane() {
        return;
    }
    var page = NO_PAGE;
    for (var attempt = 0u; attempt < PAGE_TRIES; attempt++) {
        let cursor = cursors_load(pixel);
        var place = cursor;
        if cursor == 0u {
            place = pixel * PAGE_ENTRIES;
        } else if cursor % PAGE_ENTRIES == 0u {
            if page == NO_PAGE {
                page = pool_atomic_add(1u);
            }
            if page >= frame.fragments / PAGE_ENTRIES {
                on_lost(pixel, entry, POOL_EXHAUSTED);
                return;
            }
            links_store(page, cursor);
            place = (pixel_count() + page) * PAGE_ENTRIES;
        }
        if cursors_atomic_compare_exchange(pixel, cursor, place + 1u) {
            entries_store(place, entry);
            // A page is begun at its first place.
            if page != NO_PAGE && place % PAGE_ENTRIES != 0u {
                count_event(PAGES_LEAKED);
            }
            return;
        }
    }
    on_lost(pixel, entry, SPIN_EXHAUSTED);
}

fn storage_first(pixel: u32) -> u32 {
    // 0, the empty list, becomes END.
    return cursors_load(pixel) - 1u;
}

fn storage_next(pixel: u32, cursor: u32) -> u32 {
    if cursor % PAGE_ENTRIES != 0u {
        return cursor - 1u;
    }
    let page = cursor / PAGE_ENTRIES;
    if page < pixel_count() {
        return END;
    }
    return links_load(page - pixel_count()) - 1u;
}

fn storage_read(pixel: u32, cursor: u32) -> Packed {
    return entries_load(cursor);
}
