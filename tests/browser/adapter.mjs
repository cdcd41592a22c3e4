// Opens Dawn, Chromium's WebGPU, in Node. VK_DRIVER_FILES selects the driver.
import { createRequire } from "node:module";
import { pathToFileURL } from "node:url";

// The package is installed beside the tests of Tint.
const require = createRequire(new URL("../tint/package.json", import.meta.url));
const { create, globals } = await import(pathToFileURL(require.resolve("webgpu")).href);

/** Returns the adapter of the driver. */
export async function adapter() {
    Object.assign(globalThis, globals);
    const gpu = create([]);
    const found = await gpu.requestAdapter();
    if (!found) throw new Error("Dawn finds no adapter");
    // If one of these is collected, Dawn frees what the others use.
    globalThis.kept = [...(globalThis.kept ?? []), gpu, found];
    return found;
}
