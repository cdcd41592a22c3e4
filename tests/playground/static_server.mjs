/**
 * A web server for the files of a folder, and nothing else, under a path of its own, as a static host has it.
 *
 * Input: a folder. Output: the address of the folder. Requests of other paths, and of files that do not exist, have the status 404.
 */
import { readFile } from "node:fs/promises";
import { createServer } from "node:http";
import { extname, join, normalize, sep } from "node:path";

/** The path of the folder, which no page may know. */
const PREFIX = "/some/where/";

/** The types that every host knows. */
const TYPES = { ".html": "text/html", ".css": "text/css", ".js": "text/javascript", ".json": "application/json", ".png": "image/png" };

/** @param {string} folder */
export async function serve(folder) {
    const root = normalize(folder);
    const server = createServer(async (request, response) => {
        const { pathname } = new URL(request.url, "http://localhost");
        const path = join(root, decodeURIComponent(pathname.slice(PREFIX.length)));
        const content = pathname.startsWith(PREFIX) && path.startsWith(root + sep) ? await readFile(path).catch(() => null) : null;
        response.writeHead(content ? 200 : 404, { "content-type": TYPES[extname(path)] ?? "application/octet-stream" });
        response.end(content ?? "not found");
    });
    await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
    return { address: `http://127.0.0.1:${server.address().port}${PREFIX}`, close: () => server.close() };
}
