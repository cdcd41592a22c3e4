/**
 * The camera of the page: an orbit around a scene, with the same matrix as `fragbuf render --camera orbit:AZIMUTH,ELEVATION,zoom:FACTOR`.
 */

/** The view that the command line calls `auto`: right, above and in front. */
export const AUTO = { azimuth: 28.81, elevation: 21.52, zoom: 1 };

/** The least and the greatest elevation and zoom. */
const [ELEVATIONS, ZOOMS] = [
    [-90, 90],
    [0.1, 100],
];

/** Returns a camera whose elevation and zoom are in their ranges, with an azimuth from 0 to 360 degrees. */
export function limited({ azimuth, elevation, zoom }) {
    const within = (value, [least, most]) => Math.min(most, Math.max(least, value));
    const turned = azimuth % 360;
    // Additions round: an azimuth in its range stays as it is.
    return {
        azimuth: turned < 0 ? turned + 360 : turned,
        elevation: within(elevation, ELEVATIONS),
        zoom: within(zoom, ZOOMS),
    };
}

/** Half of the vertical field of view, in radians, and the size of the frame relative to the scene. */
const [HALF_ANGLE, MARGIN] = [(20 * Math.PI) / 180, 1.04];

/**
 * Returns the matrix to clip space, column by column, and the eye. The positions just fit into a frame with this aspect, width over height.
 * @param {{ positions: Float32Array, bounds: number[][] }} scene Three floats per position; the least and the greatest coordinates.
 * @param {{ azimuth: number, elevation: number, zoom: number }} camera Degrees, and a magnification of the centre of the image.
 */
export function orbit({ positions, bounds: [least, greatest] }, aspect, { azimuth, elevation, zoom }) {
    const [a, e] = [azimuth, elevation].map((degrees) => ((degrees % 360) * Math.PI) / 180);
    const direction = [Math.sin(a) * Math.cos(e), Math.sin(e), Math.cos(a) * Math.cos(e)];
    const up = [-Math.sin(a) * Math.sin(e), Math.cos(e), -Math.cos(a) * Math.sin(e)];
    const right = cross(up, direction);
    const centre = least.map((value, axis) => (value + greatest[axis]) / 2);
    const tangents = [(Math.tan(HALF_ANGLE) * aspect) / MARGIN, Math.tan(HALF_ANGLE) / MARGIN];
    // The distance of the eye from the centre for all points to be in view, and the range of depths.
    let [distance, far, near] = [0, 0, 0];
    for (let index = 0; index < positions.length; index += 3) {
        const [x, y, z] = [positions[index] - centre[0], positions[index + 1] - centre[1], positions[index + 2] - centre[2]];
        const depth = x * direction[0] + y * direction[1] + z * direction[2];
        const across = Math.abs(x * right[0] + y * right[1] + z * right[2]) / tangents[0];
        const along = Math.abs(x * up[0] + y * up[1] + z * up[2]) / tangents[1];
        distance = Math.max(distance, depth + Math.max(across, along));
        far = Math.min(far, depth);
        near = Math.max(near, depth);
    }
    const thickness = Math.max(near - far, 1e-6);
    distance = Math.max(distance, near + 0.01 * thickness);
    const eye = centre.map((value, axis) => value + distance * direction[axis]);
    const planes = [distance - near - 0.005 * thickness, distance - far + 0.005 * thickness];
    return { viewProjection: product(perspective(aspect, planes, zoom), view([right, up, direction], eye)), eye };
}

/** Returns the rows of the matrix from positions to the space of the eye, which looks along -z. */
function view(axes, eye) {
    return [...axes.map((axis) => [...axis, -dot(axis, eye)]), [0, 0, 0, 1]];
}

/** Returns the rows of a projection with z from 0 to 1. */
function perspective(aspect, [near, far], zoom) {
    const scale = zoom / Math.tan(HALF_ANGLE);
    const depth = far / (near - far);
    return [
        [scale / aspect, 0, 0, 0],
        [0, scale, 0, 0],
        [0, 0, depth, depth * near],
        [0, 0, -1, 0],
    ];
}

/** Returns the product of two matrices, which are rows, column by column. */
function product(a, b) {
    const columns = [0, 1, 2, 3].map((column) =>
        a.map((row) => row.reduce((sum, value, index) => sum + value * b[index][column], 0)),
    );
    return new Float32Array(columns.flat());
}

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [0, 1, 2].map((i) => a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3]);
