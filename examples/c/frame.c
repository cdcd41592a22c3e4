/* Prints what a host creates, uploads and runs for one frame of examples/glass.fragbuf, from the generated header alone.
 *
 * It calls no graphics API. Where it prints, a host calls its own: vkCreateBuffer, glBufferData, vkCmdDispatch, glDrawArrays.
 * What is above `main` takes any plan whose frame has no loop with exchanged resources (`parities`), so it also serves other
 * descriptions. */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

#include "glass.h"

/* One buffer or texture per resource. FRAGBUF_NO_VALUE: the size is beyond 64 bits. */
static int create_resources(const struct fragbuf_plan *plan, const struct fragbuf_symbols *symbols)
{
    for (uint32_t i = 0; i < plan->resource_count; i++) {
        const struct fragbuf_resource *resource = &plan->resources[i];
        uint64_t bytes = resource->bytes(symbols);
        if (bytes == FRAGBUF_NO_VALUE) {
            fprintf(stderr, "the frame is too large for `%s`\n", resource->name);
            return 0;
        }
        printf("create %s %s: %" PRIu64 " bytes at set %" PRIu32 ", binding %" PRIu32 "\n",
               resource->format == FRAGBUF_BUFFER ? "buffer" : "texture", resource->name, bytes, plan->group, resource->binding);
    }
    return 1;
}

/* The shaders of a pass for one target. */
static void bind_pass(const struct fragbuf_plan *plan, uint32_t pass)
{
    for (uint32_t i = 0; i < plan->file_count; i++) {
        const struct fragbuf_file *file = &plan->files[i];
        if (file->pass == pass) {
            printf(" %s:%s", file->path, file->entry_point);
        }
    }
}

static void run_pass(const struct fragbuf_plan *plan, uint32_t index, const struct fragbuf_symbols *symbols)
{
    const struct fragbuf_pass *pass = &plan->passes[index];
    printf("%s with", pass->name);
    bind_pass(plan, index);
    printf(": ");
    switch (pass->kind) {
    case FRAGBUF_GEOMETRY:
        printf("draw the scene\n");
        break;
    case FRAGBUF_FULLSCREEN:
        printf("draw 3 vertices\n");
        break;
    case FRAGBUF_COMPUTE:
        printf("dispatch %" PRIu64 " x %" PRIu64 " x %" PRIu64 "\n", pass->groups[0](symbols), pass->groups[1](symbols),
               pass->groups[2](symbols));
        break;
    }
}

/* Follows the steps. A loop is a jump back from its end until its limit, or until its condition holds: a host reads the word, or the
 * query, after each iteration. Here every condition holds after one. */
static void run_frame(const struct fragbuf_plan *plan, const struct fragbuf_symbols *symbols)
{
    uint64_t iterations[64] = {0};
    for (uint32_t at = 0; at < plan->step_count; at++) {
        const struct fragbuf_step *step = &plan->steps[at];
        switch (step->action) {
        case FRAGBUF_CLEAR:
            printf("fill %s with 0x%" PRIx32 "\n", plan->resources[step->index].name, step->value);
            break;
        case FRAGBUF_COPY:
            printf("copy %s to %s\n", plan->resources[step->index].name, plan->resources[step->value].name);
            break;
        case FRAGBUF_PASS:
            run_pass(plan, step->index, symbols);
            break;
        case FRAGBUF_LOOP:
            iterations[step->index] = 0;
            if (plan->loops[step->index].max_iterations(symbols) == 0) {
                at = plan->loops[step->index].end;
            }
            break;
        case FRAGBUF_LOOP_END: {
            const struct fragbuf_loop *loop = &plan->loops[step->index];
            iterations[step->index]++;
            if (loop->until == FRAGBUF_LIMIT && iterations[step->index] < loop->max_iterations(symbols)) {
                at = loop->begin;
            }
            break;
        }
        case FRAGBUF_HOST:
            printf("read back, then call %s\n", plan->hosts[step->index].function);
            break;
        }
    }
}

int main(int argc, char **argv)
{
    uint32_t width = argc > 1 ? (uint32_t)strtoul(argv[1], NULL, 10) : 640;
    uint32_t height = argc > 2 ? (uint32_t)strtoul(argv[2], NULL, 10) : 480;
    if (width == 0 || height == 0) {
        fprintf(stderr, "usage: %s [WIDTH HEIGHT], each 1 or more\n", argv[0]);
        return 2;
    }
    /* glass.fragbuf has memory for k fragments of each pixel. Where lists share a pool, the third number is its size in fragments. */
    struct fragbuf_symbols symbols = glass_symbols(width, height, 0);
    if (!create_resources(&glass_plan, &symbols)) {
        return 1;
    }
    struct glass_frame frame = {.width = width, .height = height, .first_row = 0, .k = (uint32_t)symbols.k};
    struct glass_uniforms uniforms = {.eye = {0.45f, 0.37f, 0.81f}};
    printf("upload %zu bytes to binding %" PRIu32 ": %" PRIu32 " x %" PRIu32 ", k = %" PRIu32 "\n", sizeof frame,
           GLASS_FRAME_BINDING, frame.width, frame.height, frame.k);
    printf("upload %zu bytes to binding %" PRIu32 ": eye = %.2f %.2f %.2f\n", sizeof uniforms, GLASS_UNIFORMS_BINDING,
           (double)uniforms.eye[0], (double)uniforms.eye[1], (double)uniforms.eye[2]);
    run_frame(&glass_plan, &symbols);
    printf("read word %" PRIu32 " of %s: fragments that timed out\n", GLASS_COUNTER_TIMED_OUT,
           glass_plan.resources[GLASS_RESOURCE_COUNTERS].name);
    return 0;
}
