/** A parsed `manifest.json`. The guide's chapter on the manifest defines every field. */
export interface Manifest {
    schema: string;
    name: string;
    technique: string | null;
    files: { path: string; target: string; pass: string; stage: string; entry_point: string }[];
    [field: string]: unknown;
}

/** The schema of the manifests that this package follows. */
export const SCHEMA: string;

export interface RequirementOptions {
    /** The width and height of the frame in pixels. */
    size: [number, number];
    /** The format of the target of your frames. */
    format?: GPUTextureFormat;
    /** Symbols that you will set, such as `k`. */
    symbols?: Record<string, number>;
    /** As in {@link Options}. */
    perPixel?: number;
    /** As in {@link Options}: requests the feature `timestamp-query`, if the adapter has it. */
    times?: boolean;
}

/**
 * Returns what to request of an adapter, for `adapter.requestDevice`. Throws an error that names everything that the adapter lacks.
 */
export function requirements(
    manifest: Manifest,
    adapter: GPUAdapter,
    options: RequirementOptions,
): { requiredLimits: Record<string, number>; requiredFeatures: GPUFeatureName[] };

export interface Options {
    /** The width and height of the frame in pixels. */
    size: [number, number];
    /** The format of the target of your frames; blending must be allowed for it. */
    format: GPUTextureFormat;
    /** Symbols of the manifest that you set, such as `k` or `fragments`. */
    symbols?: Record<string, number>;
    /**
     * The fragments per pixel that memory is reserved for where no step of the frame counts them. Default: 8. Fragments beyond them are
     * counted as lost.
     */
    perPixel?: number;
    /**
     * What a frame waits for. `all`, the default: the decisions of host steps, and whether a loop ends. `lag`: as `all`, but decisions that
     * may lag take effect in a later frame, with the greatest value that a slice needed. The first frame waits for them, and so does the
     * first one after a change of the size or of a symbol. `loops`: whether a loop ends; memory is reserved for `perPixel` fragments. `none`: nothing;
     * loops run to their limits, and frames can be recorded with `encode`.
     */
    readback?: "all" | "lag" | "loops" | "none";
    /** The bytes that a frame may allocate. Default: 2 GiB. A frame that needs more is drawn in slices of rows. */
    memory?: number;
    /** The rows of a slice. Default: as many as the device's limits and `memory` allow. */
    rows?: number;
    /** Your vertex buffers, with the locations of the manifest's `vertex_inputs`. Default: {@link FragmentBuffer.vertexLayout}. */
    vertexBuffers?: GPUVertexBufferLayout[];
    /** The primitive state of passes that draw your scene. Default: a list of triangles, without culling. */
    primitive?: GPUPrimitiveState;
    /** For files in module form: adds your own entry points to the code of a pass that draws your scene. */
    material?(file: { pass: string; code: string; entry: string }): Material;
    /** Is called after a frame in which fragments were lost. Default: a warning on the console, once. */
    onLoss?(counters: Counters): void;
    /**
     * Measures every pass, for {@link FragmentBuffer.times}. Default: false. The device needs the feature
     * `timestamp-query`. Without it, frames are the same, and `times()` returns the reason instead of times.
     */
    times?: boolean;
}

/** A shader of your own that calls the function of a pass, such as `store_fragment`. */
export interface Material {
    /** The code of the pass and yours. */
    code: string;
    /** The names of your entry points. */
    vertex: string;
    fragment: string;
    vertexBuffers: GPUVertexBufferLayout[];
    /** The layouts of your bind groups, by their index. The one of the fragment buffer stays empty. */
    bindGroupLayouts?: (GPUBindGroupLayout | undefined)[];
}

/** The box around an object, in the space of vertex positions. */
export interface ObjectBox {
    least: [number, number, number];
    greatest: [number, number, number];
}

export interface Call {
    /**
     * A texture of the size and format of the frame, or a view. The frame is blended over its content. A function is called when the frame
     * is composited: the texture of a canvas does not survive the readbacks before.
     */
    target: GPUTexture | GPUTextureView | (() => GPUTexture | GPUTextureView);
    /** The colour that the target is cleared to first. Without it, its content stays. */
    clear?: GPUColor;
    /** From positions to clip space with z from 0 to 1: 16 numbers, column by column. */
    viewProjection: ArrayLike<number>;
    /**
     * Records the draws of your scene. Is called for every pass over the scene, and must record the same triangles each time. Do not set a
     * pipeline, a scissor rectangle, or the bind group of the fragment buffer.
     */
    draw(pass: GPURenderPassEncoder, about: { pass: string; objects: number[] | null }): void;
    /** The description's uniforms. One keeps its value until you set it again. */
    uniforms?: Record<string, number | ArrayLike<number>>;
    /** Symbols that change, such as `k`. `encode` takes none. */
    symbols?: Record<string, number>;
    /** Textures of the description by their names, and external textures of the plan: `opaque`, `importance`. */
    textures?: Record<string, GPUTexture>;
    /**
     * The boxes of your objects, for plans that draw boxes; other plans ignore them. `draw` gets the numbers of those to draw; all of them
     * if it is null. Pass the same array while the boxes stay the same, because another one is copied to the device again.
     */
    objects?: ObjectBox[];
}

/** How a loop with a condition ended. */
export interface LoopReport {
    until: { word_is_zero: string } | { no_samples: string };
    iterations: number;
    /** False if the loop reached its limit first: the image is incomplete. Null with `readback: "none"`, which does not know; counters do. */
    isMet: boolean | null;
}

export interface FrameReport {
    loops: LoopReport[];
}

export interface Counters {
    /** The fragments that are missing from the image, or in the wrong order: the sum of the manifest's counters with `is_loss`. */
    lost: number;
    /** Every counter of the manifest, by its name. With `counters: losses` only losses are counted, and the others are 0. */
    counts: Record<string, number>;
}

/** How long the passes of a frame took on the device. */
export interface PassTimes {
    /**
     * Milliseconds by the manifest's name of the pass, in the order in which passes ran first. Runs in loops and slices
     * are summed. Finite and never negative. 0 is possible: browsers round timestamps, to about 100 µs.
     */
    passes: Record<string, number>;
    /** The runs that `passes` does not contain: those after the first 2048 of a frame, or all with a `reason`. */
    unmeasured: number;
    /** Why nothing is measured: the device lacks the feature `timestamp-query`. Otherwise null. */
    reason: string | null;
}

/** A fragment buffer on a device, for frames of one size. */
export class FragmentBuffer {
    private constructor();
    /**
     * Compiles every pass and allocates memory.
     * @param loadFile Returns the text of a file; `path` is relative to `manifest.json`.
     */
    static create(
        device: GPUDevice,
        manifest: Manifest,
        loadFile: (path: string) => string | Promise<string>,
        options: Options,
    ): Promise<FragmentBuffer>;
    /** The layout of a vertex buffer with all inputs behind one another: the position, then the attributes without depth. */
    readonly vertexLayout: GPUVertexBufferLayout;
    /** The number of slices in which a frame is drawn. */
    readonly slices: number;
    /** The bytes of the plan's buffers and textures. */
    readonly allocatedBytes: number;
    /** Returns the value of a symbol of the manifest. */
    symbol(name: string): number;
    /** Resizes the frame. Await it, as `setSymbols` and `render`, before the next of these calls: one that begins earlier is an error. */
    resize(size: [number, number]): Promise<void>;
    /** Sets symbols from the next frame on. */
    setSymbols(symbols: Record<string, number>): Promise<void>;
    /** Draws a frame and submits it. Resolves once everything is submitted. */
    render(call: Call): Promise<FrameReport>;
    /** Records a frame into your encoder, with `readback: "none"`. Submit the encoder before you record the next frame. */
    encode(encoder: GPUCommandEncoder, call: Call): void;
    /** Reads the counters of the last submitted frame. */
    counters(): Promise<Counters>;
    /**
     * Reads the times of the passes of the last submitted frame, with {@link Options.times}. No frame waits for them.
     * `passes` is empty before the first frame, and after one that failed.
     */
    times(): Promise<PassTimes>;
    /** Frees all memory. */
    destroy(): void;
}
