// Draws jobs that the tests have written with the WebGPU host, and returns pixels. Runs in Node and in browsers.
//
// A job has a plan, scenes and settings; see `jobs.rs`. `load(path, kind)` returns a file as `text` or as `bytes`.
import { FragmentBuffer, requirements } from "../../backends/run/webgpu/fragbuf.mjs";

const FORMAT = "rgba16float";

/** Draws every job. Returns an object per job: the results of its runs, or the error. */
export async function drawAll(adapter, jobs, load) {
    const uncaptured = [];
    const results = {};
    // The plans of the tests need no feature; passes of some runs are timed.
    const device = await adapter.requestDevice({ requiredFeatures: ["timestamp-query"] });
    device.addEventListener("uncapturederror", ({ error }) => uncaptured.push(error.message));
    for (const job of jobs) {
        try {
            results[job.name] = { runs: await drawJob(adapter, device, job, load) };
        } catch (error) {
            results[job.name] = { error: `${error.message}` };
        }
    }
    return { results, uncaptured, adapter: `${adapter.info.vendor} ${adapter.info.architecture}` };
}

async function drawJob(adapter, device, job, load) {
    const manifest = JSON.parse(await load(`${job.folder}/manifest.json`, "text"));
    const loadFile = (path) => load(`${job.folder}/${path}`, "text");
    const { size } = job;
    // No plan of the tests needs more than every device has.
    const asked = requirements(manifest, adapter, { size, format: FORMAT, symbols: job.symbols });
    if (Object.keys(asked.requiredLimits).length + asked.requiredFeatures.length > 0) throw new Error(`asks for ${JSON.stringify(asked)}`);
    const textures = {};
    for (const { name, format, file, dimension, size: texels } of job.textures) {
        const bytes = await load(file, "bytes");
        textures[name] = dimension ? described(device, dimension, texels, bytes) : await texture(device, format, size, bytes);
    }
    const target = device.createTexture({ size, format: FORMAT, usage: GPUTextureUsage.RENDER_ATTACHMENT | GPUTextureUsage.COPY_SRC });
    const scenes = [];
    for (const scene of job.scenes) {
        const bytes = await load(scene.vertices, "bytes");
        const mesh = device.createBuffer({ size: bytes.byteLength, usage: GPUBufferUsage.VERTEX | GPUBufferUsage.COPY_DST });
        device.queue.writeBuffer(mesh, 0, bytes);
        scenes.push({ ...scene, mesh });
    }
    const runs = [];
    for (const run of job.runs) {
        const options = { size, format: FORMAT, symbols: job.symbols, onLoss: () => {}, ...run.options };
        const buffer = await FragmentBuffer.create(device, manifest, loadFile, options);
        const result = { slices: buffer.slices, images: [], lost: [], loops: [], times: [], drawn: 0, every: 0 };
        for (const index of run.scenes) {
            const { mesh, count, objects } = scenes[index];
            const call = {
                target, textures,
                clear: [...job.background, 1],
                viewProjection: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1],
                uniforms: job.uniforms,
                objects: objects ?? undefined,
                draw(pass, { objects: visible }) {
                    pass.setVertexBuffer(0, mesh);
                    if (!visible) return pass.draw(count);
                    result.drawn += visible.length;
                    result.every += objects.length;
                    for (const object of visible) pass.draw(6, 1, 6 * object);
                },
            };
            if (run.options.readback === "none") {
                const encoder = device.createCommandEncoder();
                buffer.encode(encoder, call);
                device.queue.submit([encoder.finish()]);
                result.loops.push([]);
            } else {
                result.loops.push((await buffer.render(call)).loops);
            }
            result.lost.push((await buffer.counters()).lost);
            if (run.options.times) result.times.push(await buffer.times());
            result.images.push(await pixels(device, target, size));
        }
        buffer.destroy();
        runs.push(result);
    }
    [target, ...scenes.map(({ mesh }) => mesh), ...Object.values(textures)].forEach((object) => object.destroy());
    return runs;
}

/** Creates a texture of a description: four floats per texel. */
function described(device, dimension, size, bytes) {
    const usage = GPUTextureUsage.COPY_DST | GPUTextureUsage.TEXTURE_BINDING;
    const created = device.createTexture({ size, dimension, format: "rgba32float", usage });
    device.queue.writeTexture({ texture: created }, bytes, { bytesPerRow: 16 * size[0], rowsPerImage: size[1] }, size);
    return created;
}

/** Creates a texture with one number per pixel. WebGPU copies nothing into a depth texture, so a pass draws it. */
async function texture(device, format, size, bytes) {
    const { COPY_DST, TEXTURE_BINDING, RENDER_ATTACHMENT } = GPUTextureUsage;
    const numbers = device.createTexture({ size, format: "r32float", usage: COPY_DST | TEXTURE_BINDING | RENDER_ATTACHMENT });
    device.queue.writeTexture({ texture: numbers }, bytes, { bytesPerRow: 4 * size[0] }, size);
    if (format === "r32float") return numbers;
    const code = `
        @group(0) @binding(0) var numbers: texture_2d<f32>;
        @vertex fn corner(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
            return vec4f(f32(index & 1u) * 4.0 - 1.0, f32(index & 2u) * 2.0 - 1.0, 0.0, 1.0);
        }
        @fragment fn depth(@builtin(position) position: vec4f) -> @builtin(frag_depth) f32 {
            return textureLoad(numbers, vec2i(position.xy), 0).r;
        }`;
    const module = device.createShaderModule({ code });
    const visibility = GPUShaderStage.FRAGMENT;
    const layout = device.createBindGroupLayout({ entries: [{ binding: 0, visibility, texture: { sampleType: "unfilterable-float" } }] });
    const pipeline = device.createRenderPipeline({
        layout: device.createPipelineLayout({ bindGroupLayouts: [layout] }),
        vertex: { module },
        fragment: { module, targets: [] },
        depthStencil: { format, depthCompare: "always", depthWriteEnabled: true },
    });
    const depths = device.createTexture({ size, format, usage: TEXTURE_BINDING | RENDER_ATTACHMENT });
    const encoder = device.createCommandEncoder();
    const view = depths.createView();
    const depthStencilAttachment = { view, depthLoadOp: "clear", depthStoreOp: "store", depthClearValue: 1 };
    const pass = encoder.beginRenderPass({ colorAttachments: [], depthStencilAttachment });
    pass.setPipeline(pipeline);
    pass.setBindGroup(0, device.createBindGroup({ layout, entries: [{ binding: 0, resource: numbers.createView() }] }));
    pass.draw(3);
    pass.end();
    device.queue.submit([encoder.finish()]);
    return depths;
}

/** Reads red, green and blue of every pixel of a texture of half floats. */
async function pixels(device, source, [width, height]) {
    const bytesPerRow = Math.ceil((8 * width) / 256) * 256;
    const staging = device.createBuffer({ size: bytesPerRow * height, usage: GPUBufferUsage.MAP_READ | GPUBufferUsage.COPY_DST });
    const encoder = device.createCommandEncoder();
    encoder.copyTextureToBuffer({ texture: source }, { buffer: staging, bytesPerRow }, [width, height]);
    device.queue.submit([encoder.finish()]);
    await staging.mapAsync(GPUMapMode.READ);
    const halves = new Uint16Array(staging.getMappedRange());
    const channel = (x, y, index) => number(halves[(y * bytesPerRow) / 2 + 4 * x + index]);
    const image = Array.from({ length: width * height }, (_, pixel) => [0, 1, 2].map((index) => channel(pixel % width, Math.floor(pixel / width), index)));
    staging.destroy();
    return image;
}

/** Returns the number that a half float stores; of infinities and NaN, one that no pixel has. */
function number(half) {
    const [exponent, mantissa] = [(half >> 10) & 31, half & 1023];
    if (exponent === 31) return 1e9;
    const magnitude = exponent === 0 ? mantissa * 2 ** -24 : (1 + mantissa / 1024) * 2 ** (exponent - 15);
    return half >> 15 ? -magnitude : magnitude;
}
