// Lists of pages (after Crassin 2010): a page holds PAGE_ENTRIES fragments of one pixel, and pages are linked instead
// of fragments. The first page of every pixel is reserved for it. A fragment that finds the last page full takes a
// page from the pool, links it back to that page, and moves the pixel's cursor to it by one compare-exchange. The
// cursor is one past the slot of the pixel's last fragment; 0 means that the pixel has none.
//
// Invariant: in the cursor's page, each slot below the cursor belongs to the fragment that moved the cursor past it;
// all pages before it are full. The owner of a page writes its link before the cursor moves to the page, and slots are
// read only after the pass, so the order of fragments has no effect.
//
// If several fragments find the page full at the same time, one page is used and the others leak: they are counted,
// and their slots are missing from the pool. Published designs lock the page instead. A fragment keeps its page over
// retries, so it takes at most one.
//
// Memory: a page per pixel and one per PAGE_ENTRIES fragments, each of PAGE_ENTRIES * entry_words words; 1 word per
// page of the pool, 1 per pixel. So every fragment that the pool is sized for fits, unless pages leak.

/// The page of a fragment that has not taken one.
const NO_PAGE = 0xffffffffu;

fn storage_insert(pixel: u32, entry: Packed) {
    // The exchange of a helper invocation has no effect: it would use all attempts.
    if is_helper_lane() {
        return;
    }
    var page = NO_PAGE;
    for (var attempt = 0u; attempt < PAGE_TRIES; attempt++) {
        let cursor = cursors_load(pixel);
        var slot = cursor;
        if cursor == 0u {
            slot = pixel * PAGE_ENTRIES;
        } else if cursor % PAGE_ENTRIES == 0u {
            if page == NO_PAGE {
                page = pool_atomic_add(1u);
            }
            if page >= frame.fragments / PAGE_ENTRIES {
                on_lost(pixel, entry, POOL_EXHAUSTED);
                return;
            }
            links_store(page, cursor);
            slot = (pixel_count() + page) * PAGE_ENTRIES;
        }
        if cursors_atomic_compare_exchange(pixel, cursor, slot + 1u) {
            entries_store(slot, entry);
            // The fragment that takes the first slot of a page uses its own page.
            if page != NO_PAGE && slot % PAGE_ENTRIES != 0u {
                count_event(PAGES_LEAKED);
            }
            return;
        }
    }
    on_lost(pixel, entry, TIMED_OUT);
}

fn storage_first(pixel: u32) -> u32 {
    // 0, the empty list, wraps around to END.
    return bounded_walk_first(cursors_load(pixel) - 1u, paged_list_size());
}

fn storage_next(pixel: u32, cursor: u32) -> u32 {
    if cursor % PAGE_ENTRIES != 0u {
        return bounded_walk_next(cursor - 1u, paged_list_size());
    }
    let page = cursor / PAGE_ENTRIES;
    if page < pixel_count() {
        return END;
    }
    return bounded_walk_next(links_load(page - pixel_count()) - 1u, paged_list_size());
}

fn storage_read(pixel: u32, cursor: u32) -> Packed {
    return entries_load(cursor);
}

/// Returns the number of entries of all pages.
fn paged_list_size() -> u32 {
    return (pixel_count() + frame.fragments / PAGE_ENTRIES) * PAGE_ENTRIES;
}
