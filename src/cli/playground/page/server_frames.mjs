/**
 * Frames from a device of the server.
 */
import { api } from "./api.mjs";

export class ServerFrames {
    /** Draws a request. Returns an image and the statistics of `fragbuf render --json`. */
    async draw({ text, scene, uniforms, k, size, camera, device }, signal) {
        const request = { text, scene, uniforms, k, size, camera, device };
        const { png, statistics, messages } = await api.render(request, signal);
        const bytes = Uint8Array.from(atob(png), (letter) => letter.charCodeAt(0));
        const image = await createImageBitmap(new Blob([bytes], { type: "image/png" }), { colorSpaceConversion: "none" });
        return { image, statistics: { mode: "server", ...statistics, messages } };
    }
}
