// A fragment that finds no place is dropped. Storages and locks hand every such fragment here, so that none is lost
// uncounted.

fn on_lost(lost: Packed, reason: u32) {
    count_loss(reason);
}
