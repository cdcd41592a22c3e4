/**
 * Images as the server sends them: PNG in base64, within JSON.
 */

/**
 * Returns the bitmap of an image; its caller closes it. No value is changed: neither by alpha nor by a profile.
 * @param {string} png base64
 */
export function bitmapOf(png) {
    const bytes = Uint8Array.from(atob(png), (letter) => letter.charCodeAt(0));
    const options = { premultiplyAlpha: "none", colorSpaceConversion: "none" };
    return createImageBitmap(new Blob([bytes], { type: "image/png" }), options);
}
