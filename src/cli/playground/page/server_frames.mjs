/**
 * Frames from a device of the server.
 */
import { api } from "./api.mjs";
import { bitmapOf } from "./png.mjs";

export class ServerFrames {
    /** Draws a request. Returns an image and the statistics of `fragbuf render --json`. */
    async draw({ text, scene, uniforms, k, size, camera, device }, signal) {
        const request = { text, scene, uniforms, k, size, camera, device };
        const { png, statistics, messages } = await api.render(request, signal);
        return { image: await bitmapOf(png), statistics: { mode: "server", ...statistics, messages } };
    }
}
