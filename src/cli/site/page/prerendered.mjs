/**
 * Pictures that were drawn when the site was generated, for browsers and techniques without frames by WebGPU.
 *
 * Input: a request of the picture. Output: the image of its technique, which is always of the same scene, camera and k.
 */
import { address, api } from "./api.mjs";

export class PrerenderedFrames {
    /** Reads the picture of a request's technique. */
    async draw({ text }, signal) {
        const { picture } = api.techniqueOf(text);
        const response = await fetch(address(picture), { signal });
        if (!response.ok) throw new Error(`This site has no file ${picture}.`);
        const image = await createImageBitmap(await response.blob(), { colorSpaceConversion: "none" });
        return { image, statistics: { mode: "prerendered" } };
    }
}
