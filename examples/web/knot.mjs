// A knot of coloured glass: the scene of the example, and what draws it. `index.html` shows it on a canvas.
import { FragmentBuffer, requirements } from "../../backends/run/webgpu/fragbuf.mjs";

/** Opens a device for the passes in a folder. Returns it with a function that draws the knot at an angle. */
export async function open(adapter, loadFile, size, format) {
    const manifest = JSON.parse(await loadFile("manifest.json"));
    const device = await adapter.requestDevice(requirements(manifest, adapter, { size, format }));
    const buffer = await FragmentBuffer.create(device, manifest, loadFile, { size, format });
    const vertices = knot();
    const mesh = device.createBuffer({ size: vertices.byteLength, usage: GPUBufferUsage.VERTEX | GPUBufferUsage.COPY_DST });
    device.queue.writeBuffer(mesh, 0, vertices);
    const draw = (target, angle) =>
        buffer.render({
            target,
            clear: [0.94, 0.93, 0.9, 1],
            viewProjection: camera(size[0] / size[1], angle),
            draw(pass) {
                pass.setVertexBuffer(0, mesh);
                pass.draw(vertices.length / 7);
            },
        });
    return { device, buffer, draw };
}

/** Returns the triangles of a tube along a knot: seven floats per vertex, a position and a colour with straight alpha. */
export function knot(along = 480, around = 24) {
    const curve = (t) => {
        const [p, q] = [2 * t, 3 * t];
        return [(2 + Math.cos(q)) * Math.cos(p), (2 + Math.cos(q)) * Math.sin(p), 1.1 * Math.sin(q)];
    };
    const vertex = (i, j) => {
        const t = (2 * Math.PI * i) / along;
        const centre = curve(t);
        const tangent = unit(minus(curve(t + 0.001), centre));
        const side = unit(cross(tangent, [0, 0, 1]));
        const up = cross(side, tangent);
        const turn = (2 * Math.PI * j) / around;
        const normal = side.map((_, axis) => Math.cos(turn) * side[axis] + Math.sin(turn) * up[axis]);
        const light = 0.7 + 0.3 * normal[2];
        const hue = (shift) => light * (0.45 + 0.5 * Math.cos(t + shift));
        return [...centre.map((c, axis) => c + 0.46 * normal[axis]), hue(0), hue(4.2), hue(2.1), 0.42];
    };
    const corners = [[0, 0], [1, 0], [0, 1], [0, 1], [1, 0], [1, 1]];
    const quad = (i, j) => corners.flatMap(([di, dj]) => vertex(i + di, j + dj));
    return new Float32Array(Array.from({ length: along * around }, (_, n) => quad(Math.floor(n / around), n % around)).flat());
}

/** Returns the matrix of a camera that turns around the knot: to clip space with z from 0 to 1, column by column. */
function camera(aspect, angle) {
    const [tilt, distance, near, far, zoom] = [-0.25, 13, 8, 18, 3.45];
    const [c, s, ct, st] = [Math.cos(angle), Math.sin(angle), Math.cos(tilt), Math.sin(tilt)];
    // A turn around z, then a tilt around x; the camera looks along -z.
    const rows = [[c, -s, 0], [s * ct, c * ct, -st], [s * st, c * st, ct]];
    const depth = (axis) => (-rows[2][axis] * far) / (far - near);
    const column = (axis) => [(zoom / aspect) * rows[0][axis], zoom * rows[1][axis], depth(axis), -rows[2][axis]];
    return [...column(0), ...column(1), ...column(2), 0, 0, (far * (distance - near)) / (far - near), distance];
}

const minus = (a, b) => a.map((value, axis) => value - b[axis]);
const cross = (a, b) => [0, 1, 2].map((i) => a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3]);
const unit = (a) => a.map((value) => value / Math.hypot(...a));
