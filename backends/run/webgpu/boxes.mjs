/**
 * The boxes around the caller's objects, which occlusion queries draw.
 * @module
 */

/** The triangles of a box. Bits 0, 1 and 2 of a corner's number say whether it is the greater along x, y and z. */
const TRIANGLES = [0, 1, 3, 0, 3, 2, 4, 6, 7, 4, 7, 5, 0, 4, 5, 0, 5, 1, 2, 3, 7, 2, 7, 6, 0, 2, 6, 0, 6, 4, 1, 5, 7, 1, 7, 3];

/** Rasterisers round positions: boxes grow by this part of their greatest extent at each side, so that no object is dropped for it. */
const MARGIN = 1 / 64;

/** Boxes on a device. */
export class Boxes {
    /**
     * @param {GPUDevice} device
     * @param {import("./fragbuf.d.ts").ObjectBox[]} objects
     * @param {GPUVertexBufferLayout} layout The position comes first; all other inputs are 0.
     */
    constructor(device, objects, layout) {
        this.objects = objects;
        const stride = layout.arrayStride / 4;
        const vertices = new Float32Array(8 * stride * objects.length);
        objects.forEach((object, index) => {
            corners(object).forEach((corner, number) => vertices.set(corner, (8 * index + number) * stride));
        });
        const filled = (data, usage) => {
            const size = Math.max(data.byteLength, 4);
            const buffer = device.createBuffer({ label: "fragbuf boxes", size, usage, mappedAtCreation: true });
            new data.constructor(buffer.getMappedRange()).set(data);
            buffer.unmap();
            return buffer;
        };
        this.vertices = filled(vertices, GPUBufferUsage.VERTEX);
        this.indices = filled(new Uint16Array(TRIANGLES), GPUBufferUsage.INDEX);
    }

    destroy() {
        this.vertices.destroy();
        this.indices.destroy();
    }

    /** Draws the box of one object. */
    draw(pass, object) {
        pass.setVertexBuffer(0, this.vertices);
        pass.setIndexBuffer(this.indices, "uint16");
        pass.drawIndexed(TRIANGLES.length, 1, 0, 8 * object);
    }
}

/** Returns the corners of a box with its margin. */
function corners({ least, greatest }) {
    const isBox = [least, greatest].every((corner) => corner?.length === 3 && [...corner].every(Number.isFinite));
    if (!isBox) throw new Error("an object has no box: pass `{ least: [x, y, z], greatest: [x, y, z] }`");
    const margin = MARGIN * Math.max(...[0, 1, 2].map((axis) => greatest[axis] - least[axis]));
    const corner = (number) => [0, 1, 2].map((axis) => ((number >> axis) & 1 ? greatest[axis] + margin : least[axis] - margin));
    return Array.from({ length: 8 }, (_, number) => corner(number));
}

/**
 * Whether a query can decide about the box of an object: not if the near plane clips it, or if it covers less than a pixel, because then
 * possibly none of its samples passes although the object is visible.
 */
export function isDecidable(object, cameraWords, [width, height]) {
    const matrix = new Float32Array(cameraWords.buffer);
    const clip = corners(object).map(([x, y, z]) =>
        [0, 1, 2, 3].map((row) => matrix[row] * x + matrix[4 + row] * y + matrix[8 + row] * z + matrix[12 + row]),
    );
    if (!clip.every(([, , z, w]) => z >= 0 && w > 0)) return false;
    const extent = (axis, pixels) => {
        const places = clip.map((corner) => ((corner[axis] / corner[3]) * pixels) / 2);
        return Math.max(...places) - Math.min(...places);
    };
    return extent(0, width) >= 1 || extent(1, height) >= 1;
}
