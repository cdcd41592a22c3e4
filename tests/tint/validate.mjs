// Validates WGSL sources with Tint, Chromium's compiler.
//
// Input on stdin: a JSON array of strings, each the source of a module. Output on stdout: a JSON array of the same length, each `null`
// or the errors as text. Dawn's null back end creates the device, so that no GPU is needed.
import { readFileSync } from "node:fs";

import { create } from "webgpu";

const sources = JSON.parse(readFileSync(0, "utf8"));
const gpu = create(["backend=null"]);
const adapter = await gpu.requestAdapter();
const device = await adapter.requestDevice();
// If one of these is collected, Dawn frees what the others use.
globalThis.kept = [gpu, adapter, device];
const results = [];
for (const code of sources) {
    device.pushErrorScope("validation");
    const module = device.createShaderModule({ code });
    const { messages } = await module.getCompilationInfo();
    const error = await device.popErrorScope();
    const errors = messages.filter((message) => message.type === "error");
    const text = errors.map((message) => `${message.lineNum}:${message.linePos}: ${message.message}`);
    results.push(errors.length > 0 || error ? text.join("\n") || error.message : null);
}
await new Promise((written) => process.stdout.write(JSON.stringify(results), written));
process.exit(0);
