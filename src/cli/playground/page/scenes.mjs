/**
 * Names of generated scenes: `NAME`, with `,parameter=value` for every parameter that differs from its default.
 *
 * Input: the server's list of scenes, a name. Output: its parts, and a name of parts. A name that is not in the list has no parts.
 */

/** @typedef {{ name: string, summary: string, parameters: { name: string, default: number }[] }} Scene */

/**
 * Returns the row of a scene and the values of its parameters; null if the server does not list it.
 * @param {Scene[]} scenes
 * @param {string} name
 */
export function parseScene(scenes, name) {
    const [key, ...given] = name.split(",");
    const scene = scenes.find((scene) => scene.name === key);
    if (!scene) return null;
    const values = Object.fromEntries(scene.parameters.map((parameter) => [parameter.name, parameter.default]));
    for (const part of given) {
        const [parameter, value] = part.split("=");
        if (parameter in values && Number.isFinite(Number(value))) values[parameter] = Number(value);
    }
    return { scene, values };
}

/**
 * @param {Scene} scene
 * @param {Record<string, number>} values
 */
export function sceneName(scene, values = {}) {
    const changed = scene.parameters.filter(({ name, default: usual }) => (values[name] ?? usual) !== usual);
    return [scene.name, ...changed.map(({ name }) => `${name}=${values[name]}`)].join(",");
}
