/**
 * The triangles of a scene, as `/api/geometry` sends them, and their light.
 */

/** The brightness of a surface at a grazing angle, as on the command line. */
const AMBIENT = 0.2;

/** Parses the answer of `/api/geometry`. */
export function parseGeometry(bytes) {
    const length = new DataView(bytes).getUint32(0, true);
    const header = JSON.parse(new TextDecoder().decode(new Uint8Array(bytes, 4, length)));
    const { stride, vertices: count, indices } = header;
    let offset = 4 + 4 * Math.ceil(length / 4);
    const take = (Type, words) => {
        const part = new Type(bytes, offset, words);
        offset += 4 * words;
        return part;
    };
    const [vertices, normals, list] = [
        take(Float32Array, stride * count),
        take(Float32Array, 3 * count),
        take(Uint32Array, indices),
    ];
    const positions = new Float32Array(3 * count);
    const [least, greatest] = [
        [Infinity, Infinity, Infinity],
        [-Infinity, -Infinity, -Infinity],
    ];
    for (let vertex = 0; vertex < count; vertex++) {
        for (let axis = 0; axis < 3; axis++) {
            const value = vertices[vertex * stride + axis];
            positions[3 * vertex + axis] = value;
            least[axis] = Math.min(least[axis], value);
            greatest[axis] = Math.max(greatest[axis], value);
        }
    }
    const objects = header.objects.map(([first, end]) => ({
        first,
        count: end - first,
        box: box(positions, list.subarray(first, end)),
    }));
    return {
        ...header,
        vertices,
        normals,
        indices: list,
        positions,
        objects,
        bounds:
            count === 0
                ? [
                      [0, 0, 0],
                      [0, 0, 0],
                  ]
                : [least, greatest],
    };
}

/** Returns the box around the positions of these indices. */
function box(positions, indices) {
    const [least, greatest] = [
        [Infinity, Infinity, Infinity],
        [-Infinity, -Infinity, -Infinity],
    ];
    for (const index of indices) {
        for (let axis = 0; axis < 3; axis++) {
            least[axis] = Math.min(least[axis], positions[3 * index + axis]);
            greatest[axis] = Math.max(greatest[axis], positions[3 * index + axis]);
        }
    }
    return indices.length === 0 ? { least: [0, 0, 0], greatest: [0, 0, 0] } : { least, greatest };
}

/** Returns the vertices with their colours lit from the eye: two-sided Lambert shading, per vertex. */
export function lit({ stride, color, vertices, normals, positions }, eye) {
    if (color === null) return vertices;
    const result = vertices.slice();
    for (let vertex = 0; 3 * vertex < positions.length; vertex++) {
        const ray = [0, 1, 2].map((axis) => eye[axis] - positions[3 * vertex + axis]);
        const length = Math.hypot(...ray) || 1;
        const cosine = ray.reduce((sum, value, axis) => sum + value * normals[3 * vertex + axis], 0) / length;
        const light = AMBIENT + (1 - AMBIENT) * Math.abs(cosine);
        for (let channel = 0; channel < 3; channel++) result[vertex * stride + color + channel] *= light;
    }
    return result;
}
