// Every pixel keeps up to the k of the frame.

fn allocation_slots(pixel: u32) -> u32 {
    return frame.k;
}
