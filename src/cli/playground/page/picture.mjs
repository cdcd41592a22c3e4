/**
 * The picture of a description: drawn by WebGPU in the page, or by a fallback, such as a device of the server, where the browser has no
 * WebGPU or the description needs more than it offers. The latest request wins; a frame is never drawn twice at the same time.
 */
import { AUTO, limited } from "./camera.mjs";
import { WebGpuFrames } from "./webgpu_frames.mjs";

/** The parts of a request. The device `auto` is WebGPU in the page, or what the fallback selects. */
const DEFAULTS = { text: "", scene: "marbles", uniforms: {}, k: null, size: [512, 512], camera: AUTO, device: "auto" };

/** The parts that change while something is dragged. */
const MOVING = ["camera", "uniforms", "k"];

/**
 * Shows pictures on a canvas.
 * @param {HTMLCanvasElement} canvas
 * @param {object} options
 * @param {(statistics: object) => void} options.report gets the statistics of each frame, or `{ error }`
 * @param {{ draw(request: object, signal: AbortSignal): Promise<{ image: any, statistics: object }> }} options.fallback
 */
export async function createPicture(canvas, { report, fallback }) {
    const picture = new Picture(canvas, report, fallback);
    await picture.open();
    return picture;
}

class Picture {
    #canvas;
    #report;
    #request = { ...DEFAULTS };
    #webgpu = null;
    #fallback;
    #isWanted = false;
    #drawing = null;
    /** Cancels the frame that is drawn. */
    #running = null;

    constructor(canvas, report, fallback) {
        this.#canvas = canvas;
        this.#report = report;
        this.#fallback = fallback;
        listen(canvas, this);
    }

    async open() {
        this.#webgpu = await WebGpuFrames.open();
    }

    get camera() {
        return this.#request.camera;
    }

    set camera(camera) {
        this.set({ camera });
    }

    /** Changes parts of the request and draws. Resolves when this request, or a later one, is shown. */
    set(changes) {
        // A frame of an earlier camera or slider is shown meanwhile; one of another description, scene, size or device is not waited for.
        const isOther = (name) => !MOVING.includes(name) && JSON.stringify(changes[name]) !== JSON.stringify(this.#request[name]);
        if (Object.keys(changes).some(isOther)) this.#running?.abort();
        Object.assign(this.#request, changes);
        this.#isWanted = true;
        this.#canvas.setAttribute("aria-busy", "true");
        this.#drawing ??= this.#drawAll();
        return this.#drawing;
    }

    async #drawAll() {
        // `set` must see that nothing is drawn as soon as the loop has ended.
        await this.#drawWanted();
        this.#drawing = null;
        if (this.#isWanted) return this.set({});
        this.#canvas.setAttribute("aria-busy", "false");
    }

    async #drawWanted() {
        while (this.#isWanted) {
            this.#isWanted = false;
            const request = { ...this.#request };
            if (request.text === "") continue;
            this.#running = new AbortController();
            const { signal } = this.#running;
            try {
                const { image, statistics } = await this.#draw(request, signal);
                // WebGPU ends its frame all the same: the picture, and what is said of it, are those of the next one.
                if (signal.aborted) {
                    image.close?.();
                    continue;
                }
                show(this.#canvas, image);
                this.#report(statistics);
            } catch (error) {
                if (!signal.aborted) this.#report({ error: error.message });
            }
        }
    }

    /** Draws a request by WebGPU, or by the fallback where another device is chosen, or if WebGPU says why it cannot. */
    async #draw(request, signal) {
        if (!this.#webgpu || request.device !== "auto") return this.#fallback.draw(request, signal);
        try {
            return await this.#webgpu.draw(request);
        } catch (error) {
            if (error.isLost) this.#webgpu = await WebGpuFrames.open();
            signal.throwIfAborted();
            const { image, statistics } = await this.#fallback.draw(request, signal);
            return { image, statistics: { ...statistics, reason: error.message } };
        }
    }
}

function show(canvas, image) {
    [canvas.width, canvas.height] = [image.width, image.height];
    const context = canvas.getContext("2d");
    if (image instanceof ImageData) context.putImageData(image, 0, 0);
    else {
        context.drawImage(image, 0, 0);
        image.close();
    }
}

/** Turns the camera by the pointer, the wheel and the keyboard. */
function listen(canvas, picture) {
    const turn = (right, up) => {
        const { azimuth, elevation, zoom } = picture.camera;
        picture.camera = limited({ azimuth: azimuth + right, elevation: elevation + up, zoom });
    };
    const zoom = (factor) => {
        const camera = picture.camera;
        picture.camera = limited({ ...camera, zoom: camera.zoom * factor });
    };
    const keys = {
        ArrowLeft: () => turn(-5, 0),
        ArrowRight: () => turn(5, 0),
        ArrowUp: () => turn(0, 5),
        ArrowDown: () => turn(0, -5),
        "+": () => zoom(1.1),
        "=": () => zoom(1.1),
        "-": () => zoom(1 / 1.1),
        0: () => (picture.camera = AUTO),
    };
    canvas.addEventListener("keydown", (event) => {
        if (event.ctrlKey || event.metaKey || event.altKey || !keys[event.key]) return;
        event.preventDefault();
        keys[event.key]();
    });
    canvas.addEventListener("pointerdown", (event) => canvas.setPointerCapture(event.pointerId));
    canvas.addEventListener("pointermove", (event) => {
        if (!canvas.hasPointerCapture(event.pointerId)) return;
        const scale = 180 / canvas.clientWidth;
        turn(-event.movementX * scale, event.movementY * scale);
    });
    canvas.addEventListener(
        "wheel",
        (event) => {
            event.preventDefault();
            zoom(Math.exp(-event.deltaY / 600));
        },
        { passive: false },
    );
}
