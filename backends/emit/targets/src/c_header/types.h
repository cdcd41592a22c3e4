/* Types that all headers of fragbuf share. The first header that a program includes defines them. */
#ifndef FRAGBUF_TYPES
#define FRAGBUF_TYPES 1

#include <assert.h>
#include <stddef.h>
#include <stdint.h>

static_assert(sizeof(float) == 4, "uniform blocks contain 32-bit floats");

/* The result of a formula that has no value: a part is below 0, divides by 0 or exceeds 64 bits. */
#define FRAGBUF_NO_VALUE UINT64_MAX

/* The symbols of formulas whose values a host or a frame sets. */
struct fragbuf_symbols {
@SYMBOLS@};

/* A size, a number of workgroups or a limit. */
typedef uint64_t (*fragbuf_formula)(const struct fragbuf_symbols *);

/* The format of a resource. */
enum fragbuf_format {
    FRAGBUF_BUFFER, /* a storage buffer */
    FRAGBUF_TEXELS_2D, /* a texture of the description, of any size and any format of floats */
    FRAGBUF_TEXELS_3D,
    FRAGBUF_R32_UINT,
    FRAGBUF_RG16_UINT,
    FRAGBUF_R32_FLOAT,
    FRAGBUF_RG32_FLOAT,
    FRAGBUF_RGBA8_UNORM,
    FRAGBUF_RGBA16_FLOAT,
    FRAGBUF_DEPTH32_FLOAT,
    FRAGBUF_DEPTH24_PLUS_STENCIL8
};

/* The content of a resource when a frame begins. */
enum fragbuf_init {
    FRAGBUF_CLEARED, /* a step of the frame clears it */
    FRAGBUF_KEPT,    /* what the previous frame left */
    FRAGBUF_EXTERNAL /* the host supplies it */
};

/* A buffer or a texture. A texture has the size of the frame. */
struct fragbuf_resource {
    const char *name;
    uint32_t binding;
    uint32_t opengl_binding; /* UINT32_MAX: no shader declares it */
    enum fragbuf_format format;
    enum fragbuf_init init;
    uint32_t is_persistent; /* 1: its content is needed in the next frame */
    fragbuf_formula bytes;  /* may be 0, where an API needs at least 4; of a texture: of its texels */
};

/* A uniform block. */
struct fragbuf_block {
    const char *name;
    uint32_t binding;
    uint32_t opengl_binding;
    uint32_t bytes;
};

/* An input of the vertex stage of geometry passes. */
struct fragbuf_vertex_input {
    const char *name;
    const char *type; /* in WGSL */
    uint32_t location;
};

/* What a pass draws or dispatches. */
enum fragbuf_kind {
    FRAGBUF_GEOMETRY,   /* the scene */
    FRAGBUF_FULLSCREEN, /* one triangle, of 3 vertices without attributes */
    FRAGBUF_COMPUTE     /* workgroups */
};

/* The objects of the scene that a geometry pass draws. */
enum fragbuf_objects {
    FRAGBUF_ALL_OBJECTS,
    FRAGBUF_BOXES,          /* the bounding box of each object, with an occlusion query */
    FRAGBUF_VISIBLE_OBJECTS /* those for which no query of the pass `query` counted zero samples in this frame */
};

/* A use of a resource by a pass. */
struct fragbuf_use {
    uint32_t resource;  /* an index */
    const char *access; /* as in the manifest: "read", "plain", "atomic", "coherent", "attachment", "sampled", "indirect" */
};

/* A pass. Its fixed-function state is in manifest.json. */
struct fragbuf_pass {
    const char *name;
    enum fragbuf_kind kind;
    enum fragbuf_objects objects;
    uint32_t query;            /* an index */
    fragbuf_formula groups[3]; /* workgroups along x, y and z; NULL unless it computes */
    const struct fragbuf_use *uses;
    uint32_t use_count;
};

/* A file of a pass for one target, with one entry point. */
struct fragbuf_file {
    const char *path; /* relative to manifest.json */
    const char *target;
    const char *stage; /* "vertex", "fragment", "compute" or "module" */
    const char *entry_point;
    uint32_t pass; /* an index */
};

/* What ends a loop before its limit. */
enum fragbuf_until {
    FRAGBUF_LIMIT,        /* nothing */
    FRAGBUF_WORD_IS_ZERO, /* the first word of the resource `subject` is 0 after an iteration */
    FRAGBUF_NO_SAMPLES    /* no sample passed in the pass `subject` during the iteration */
};

/* A loop: the steps from `begin` to `end`, both of which are steps of the loop itself. */
struct fragbuf_loop {
    uint32_t begin;
    uint32_t end;
    enum fragbuf_until until;
    uint32_t subject; /* an index */
    fragbuf_formula max_iterations;
};

/* Words that a host function reads. */
struct fragbuf_range {
    uint32_t resource;     /* an index */
    fragbuf_formula first; /* the first word */
    fragbuf_formula count;
};

/* A call of a host function. The frame continues when it has set its symbols. */
struct fragbuf_host {
    const char *function;
    const struct fragbuf_range *reads;
    uint32_t read_count;
    const size_t *sets; /* offsets in struct fragbuf_symbols */
    uint32_t set_count;
    uint32_t may_lag; /* 1: a frame may use what the words of an earlier frame gave */
};

/* Whether two resources stand for each other at a step: if `is_odd` is 1, or the total of finished iterations of the loops in the
 * bit mask is odd, but not both. Iterations are counted over the whole frame. */
struct fragbuf_parity {
    uint32_t is_odd;
    uint64_t loops;
};

/* Two resources that the frame exchanges. */
struct fragbuf_exchange {
    uint32_t resources[2];     /* indices */
    struct fragbuf_parity end; /* at the end of the frame */
};

enum fragbuf_action {
    FRAGBUF_CLEAR,    /* sets every word of the resource `index` to `value`, or every texel to the bits `value` (the manifest has it as channels) */
    FRAGBUF_COPY,     /* copies the resource `index` to the resource `value` */
    FRAGBUF_PASS,     /* draws or dispatches the pass `index` */
    FRAGBUF_LOOP,     /* begins the loop `index`, with `iteration` 0; with a limit of 0, continue after its end */
    FRAGBUF_LOOP_END, /* ends the body of the loop `index`: continue after its begin with `iteration` + 1, or after it */
    FRAGBUF_HOST      /* calls the host function `index` */
};

/* A step of a frame. A pass sees what the steps before it wrote. */
struct fragbuf_step {
    enum fragbuf_action action;
    uint32_t index;
    uint32_t value;
    const struct fragbuf_parity *parities; /* one per exchange; NULL if all are those of the beginning */
};

/* A counter: a word of the resource `counters`. */
struct fragbuf_counter {
    const char *name;
    const char *meaning;
    uint32_t is_loss; /* 1: if it is not 0, fragments are missing from the image or in the wrong order */
};

/* Everything that a host needs to run a frame, except for the sources of the passes and what only the manifest has: fixed-function
 * state, samples of textures, bindings by pass and stage, and what a device must offer. */
struct fragbuf_plan {
    const char *name;
    uint32_t group; /* the bind group of all declarations */
    uint32_t counter_resource; /* an index; UINT32_MAX without counters */
    const struct fragbuf_block *blocks;
    uint32_t block_count;
    const struct fragbuf_vertex_input *vertex_inputs;
    uint32_t vertex_input_count;
    const struct fragbuf_resource *resources;
    uint32_t resource_count;
    const struct fragbuf_exchange *exchanges;
    uint32_t exchange_count;
    const struct fragbuf_pass *passes;
    uint32_t pass_count;
    const struct fragbuf_file *files;
    uint32_t file_count;
    const struct fragbuf_loop *loops;
    uint32_t loop_count;
    const struct fragbuf_host *hosts;
    uint32_t host_count;
    const struct fragbuf_counter *counters;
    uint32_t counter_count;
    const struct fragbuf_step *steps;
    uint32_t step_count;
};

/* The operators of formulas. A result without a value has no value in later operators. */
static inline uint64_t fragbuf_checked(uint64_t a, uint64_t b, uint64_t value)
{
    return a == FRAGBUF_NO_VALUE || b == FRAGBUF_NO_VALUE ? FRAGBUF_NO_VALUE : value;
}

static inline uint64_t fragbuf_add(uint64_t a, uint64_t b)
{
    return a > UINT64_MAX - b ? FRAGBUF_NO_VALUE : fragbuf_checked(a, b, a + b);
}

static inline uint64_t fragbuf_subtract(uint64_t a, uint64_t b)
{
    return a < b ? FRAGBUF_NO_VALUE : fragbuf_checked(a, b, a - b);
}

static inline uint64_t fragbuf_multiply(uint64_t a, uint64_t b)
{
    return b != 0 && a > UINT64_MAX / b ? FRAGBUF_NO_VALUE : fragbuf_checked(a, b, a * b);
}

static inline uint64_t fragbuf_divide(uint64_t a, uint64_t b)
{
    return b == 0 ? FRAGBUF_NO_VALUE : fragbuf_checked(a, b, a / b);
}

static inline uint64_t fragbuf_ceil_div(uint64_t a, uint64_t b)
{
    return b == 0 ? FRAGBUF_NO_VALUE : fragbuf_checked(a, b, a / b + (a % b != 0 ? 1 : 0));
}

static inline uint64_t fragbuf_min(uint64_t a, uint64_t b)
{
    return fragbuf_checked(a, b, a < b ? a : b);
}

static inline uint64_t fragbuf_max(uint64_t a, uint64_t b)
{
    return fragbuf_checked(a, b, a < b ? b : a);
}

static inline uint64_t fragbuf_equal(uint64_t a, uint64_t b)
{
    return fragbuf_checked(a, b, a == b ? 1 : 0);
}

static inline uint64_t fragbuf_less(uint64_t a, uint64_t b)
{
    return fragbuf_checked(a, b, a < b ? 1 : 0);
}

static inline uint64_t fragbuf_not(uint64_t a)
{
    return fragbuf_checked(a, 0, a == 0 ? 1 : 0);
}

static inline uint64_t fragbuf_and(uint64_t a, uint64_t b)
{
    return fragbuf_checked(a, b, a != 0 && b != 0 ? 1 : 0);
}

static inline uint64_t fragbuf_or(uint64_t a, uint64_t b)
{
    return fragbuf_checked(a, b, a != 0 || b != 0 ? 1 : 0);
}

static inline uint64_t fragbuf_pow2(uint64_t a)
{
    return a > 63 ? FRAGBUF_NO_VALUE : UINT64_C(1) << a;
}

static inline uint64_t fragbuf_log2_ceil(uint64_t a)
{
    uint64_t exponent = 0;
    while (exponent < 63 && UINT64_C(1) << exponent < a) {
        exponent++;
    }
    return UINT64_C(1) << exponent < a ? FRAGBUF_NO_VALUE : exponent;
}

#endif
