/**
 * The files of the site in place of the requests to a server: the same functions as the playground's `api.mjs`, as far as pictures need
 * them.
 *
 * Input: bodies as the playground sends them. Output: what its server would answer, read from static files, or an `ApiError` that says what
 * to do. Nothing here shows anything, and every address is relative to this module.
 */

/** An error of a request, in words for the person at the page. */
export class ApiError extends Error {
    /** @param {string} message @param {number} status 0 if no answer came, 422 if there are no passes */
    constructor(message, status) {
        super(message);
        this.name = "ApiError";
        this.status = status;
    }
}

/**
 * A variant: its manifest and its files are numbers of pieces, which the variants of a technique share.
 * @typedef {{ text: string, manifest: Record<string, number>, files: Record<string, number[]>, layout: string }} Variant
 */

/** Answers that are read again and again, by their paths. @type {Map<string, Promise<any>>} */
const answers = new Map();

/** What a description is: a variant, or why there is none. @type {Map<string, { technique: any, variant: Variant | null }>} */
const descriptions = new Map();

/**
 * Reads a file of the site once.
 * @param {string} path from the root of the site
 * @param {(response: Response) => Promise<any>} read
 */
function file(path, read) {
    if (!answers.has(path)) {
        const answer = load(path).then(read);
        // What failed is read again at the next request.
        answer.catch(() => answers.delete(path));
        answers.set(path, answer);
    }
    return answers.get(path);
}

async function load(path) {
    const response = await fetch(address(path)).catch(() => null);
    if (!response) throw new ApiError(`The file ${path} of this site could not be read: check the connection, and reload the page.`, 0);
    if (!response.ok) {
        const problem = `This site has no file ${path} (status ${response.status})`;
        throw new ApiError(`${problem}: copy the whole folder to its host again.`, response.status);
    }
    return response;
}

const json = (path) => file(path, (response) => response.json());

/** Returns the address of a file of the site. */
export const address = (path) => new URL(`../${path}`, import.meta.url).href;

export const api = {
    /** Returns the lists of techniques and scenes. */
    site: () => json("data/site.json"),
    /** Returns a technique with its variants, whose descriptions can be drawn from then on. */
    async technique({ data }) {
        const technique = await json(data);
        for (const variant of technique.variants) {
            if (variant.text) descriptions.set(variant.text, { technique, variant });
        }
        if (technique.unsupported) descriptions.set(technique.text, { technique, variant: null });
        return technique;
    },
    /** Returns the technique of a description. */
    techniqueOf: (description) => descriptions.get(description)?.technique,
    /** Returns the manifest and the passes of a description. */
    async generate({ text: description }) {
        const { variant, technique } = drawn(description);
        const piece = (number) => technique.pieces[number];
        const manifest = Object.fromEntries(Object.entries(variant.manifest).map(([field, number]) => [field, piece(number)]));
        const pass = (path) => manifest.files.find((file) => file.path === path)?.pass;
        const file = ([path, pieces]) => ({ path, pass: pass(path), text: pieces.map(piece).join("") });
        return { manifest, files: Object.entries(variant.files).map(file) };
    },
    /** Returns the triangles of a scene for a description. */
    async geometry({ text: description, scene }) {
        const { layout } = drawn(description).variant;
        const { scenes } = await api.site();
        const path = scenes.find(({ name }) => name === scene)?.triangles[layout];
        if (!path) throw new ApiError(`This site has no triangles of the scene ${scene} for this technique: choose another scene.`, 422);
        return file(path, (response) => response.arrayBuffer());
    },
};

/** Returns a variant with its technique. */
function drawn(description) {
    const { technique, variant } = descriptions.get(description) ?? {};
    if (variant) return { technique, variant };
    throw new ApiError(technique?.unsupported ?? "This site has no passes for this description.", 422);
}
