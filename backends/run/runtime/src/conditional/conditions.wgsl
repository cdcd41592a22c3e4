// Updates the words of loops and objects, then the arguments of a loop's draws: a loop that is over draws nothing, and neither does an
// object that a query has dropped. One workgroup.

struct Update {
    kind: u32,
    // The loop whose arguments are written; NONE: no loop.
    written: u32,
    // The loop around it; NONE: no loop.
    around: u32,
    // The words of the loop's condition.
    tested: u32,
    is_last: u32,
    // The number of the query whose objects are tested.
    query: u32,
    // The numbers of all loops, of queries, of the scene's objects and of its draws.
    loops: u32,
    queries: u32,
    objects: u32,
    draws: u32,
}

const NONE: u32 = 0xffffffffu;
const BEGIN: u32 = 0u;
const END: u32 = 1u;
const OBJECTS: u32 = 2u;
const LOOP_WORDS: u32 = 3u;
// The words of the arguments of a draw. Without indices it uses four.
const ARGUMENTS: u32 = 5u;
const INSTANCES: u32 = 1u;
// The indices of a box, and its corners.
const BOX_INDICES: u32 = 36u;
const BOX_CORNERS: u32 = 8u;

@group(0) @binding(0) var<uniform> update: Update;
// LOOP_WORDS for each loop; then, for each query and object, whether the object is dropped.
@group(0) @binding(1) var<storage, read_write> words: array<u32>;
// The words of a condition, or two words for each object.
@group(0) @binding(2) var<storage, read> tested: array<u32>;
// For each object, whether no query can decide about it.
@group(0) @binding(3) var<storage, read> undecided: array<u32>;
// For each draw of the scene its arguments and its object.
@group(0) @binding(4) var<storage, read> draws: array<u32>;
// For each loop the arguments of a fullscreen pass, of the scene's draws, of those again for each query, and of the query's boxes.
@group(0) @binding(5) var<storage, read_write> arguments: array<u32>;

var<workgroup> is_running: u32;

fn running(id: u32) -> u32 {
    return select(words[LOOP_WORDS * min(id, update.loops - 1u)], 1u, id == NONE);
}

fn dropped_at(query: u32, object: u32) -> u32 {
    return LOOP_WORDS * update.loops + query * update.objects + object;
}

fn is_visible(query: u32, object: u32) -> u32 {
    if object >= update.objects {
        return 1u;
    }
    return 1u - words[dropped_at(query, object)];
}

fn update_loop() {
    let at = LOOP_WORDS * update.written;
    if update.kind == BEGIN {
        words[at] = running(update.around);
    }
    if update.kind == END && words[at] != 0u {
        let is_met = tested[0] == 0u && (update.tested == 1u || tested[1] == 0u);
        words[at] = select(1u, 0u, is_met);
        words[at + 1u] += 1u;
        if update.is_last != 0u && !is_met {
            words[at + 2u] = 1u;
        }
    }
}

fn write_draw(at: u32, number: u32, instances: u32) {
    for (var word = 0u; word < ARGUMENTS; word++) {
        let value = draws[(ARGUMENTS + 1u) * number + word];
        arguments[ARGUMENTS * at + word] = select(value, value * instances, word == INSTANCES);
    }
}

fn write_box(at: u32, object: u32, instances: u32) {
    arguments[ARGUMENTS * at] = BOX_INDICES;
    arguments[ARGUMENTS * at + INSTANCES] = instances;
    arguments[ARGUMENTS * at + 2u] = 0u;
    arguments[ARGUMENTS * at + 3u] = BOX_CORNERS * object;
    arguments[ARGUMENTS * at + 4u] = 0u;
}

fn write_arguments(first: u32, runs: u32) {
    let of_loop = 1u + (1u + update.queries) * update.draws + update.queries * update.objects;
    let begin = of_loop * update.written;
    if first == 0u {
        arguments[ARGUMENTS * begin] = 3u;
        arguments[ARGUMENTS * begin + INSTANCES] = runs;
        arguments[ARGUMENTS * begin + 2u] = 0u;
        arguments[ARGUMENTS * begin + 3u] = 0u;
    }
    let scene = begin + 1u;
    let boxes = scene + (1u + update.queries) * update.draws;
    for (var number = first; number < update.draws; number += 64u) {
        write_draw(scene + number, number, runs);
        let object = draws[(ARGUMENTS + 1u) * number + ARGUMENTS];
        for (var query = 0u; query < update.queries; query++) {
            write_draw(scene + (1u + query) * update.draws + number, number, runs * is_visible(query, object));
        }
    }
    for (var object = first; object < update.objects; object += 64u) {
        for (var query = 0u; query < update.queries; query++) {
            write_box(boxes + query * update.objects + object, object, runs * is_visible(query, object));
        }
    }
}

@compute @workgroup_size(64)
fn update_conditions(@builtin(local_invocation_index) first: u32) {
    if first == 0u {
        if update.kind != OBJECTS {
            update_loop();
        }
        is_running = running(update.written);
    }
    let runs = workgroupUniformLoad(&is_running);
    if update.kind == OBJECTS && runs != 0u {
        for (var object = first; object < update.objects; object += 64u) {
            if (tested[2u * object] | tested[2u * object + 1u] | undecided[object]) == 0u {
                words[dropped_at(update.query, object)] = 1u;
            }
        }
    }
    storageBarrier();
    if update.written != NONE {
        write_arguments(first, runs);
    }
}
