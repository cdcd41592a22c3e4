#!/bin/sh
# Writes codemirror.mjs from the packages of package-lock.json, and their licences to LICENSES.txt. Needs npm and its registry:
#
#     sh src/cli/playground/page/vendor/bundle.sh
#
# The bundle's first lines list the versions; a test compares them with the lock file.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
build=$(mktemp -d)
trap 'rm -rf "$build"' EXIT
cp "$here/package.json" "$here/package-lock.json" "$here/entry.js" "$build/"
cd "$build"
npm ci --silent --no-audit --no-fund
node --input-type=module - > head.txt <<'SCRIPT'
import { readFileSync, writeFileSync } from "node:fs";
import { build } from "esbuild";

const options = { entryPoints: ["entry.js"], bundle: true, format: "esm", minify: true, legalComments: "none", target: "es2022" };
const result = await build({ ...options, outfile: "bundle.mjs", metafile: true });
const inputs = Object.keys(result.metafile.inputs).map((path) => /^node_modules\/((?:@[^/]+\/)?[^/]+)/.exec(path)?.[1]);
const names = [...new Set(inputs.filter(Boolean))].sort();
const version = (name) => JSON.parse(readFileSync(`node_modules/${name}/package.json`, "utf8")).version;
console.log("/**\n * CodeMirror 6, bundled by bundle.sh; licences are in LICENSES.txt.\n *");
for (const name of names) console.log(` * ${name} ${version(name)}`);
console.log(" */");
const licence = (name) => `${name} ${version(name)}\n\n${readFileSync(`node_modules/${name}/LICENSE`, "utf8").trim()}\n`;
writeFileSync("LICENSES.txt", names.map(licence).join(`\n${"-".repeat(79)}\n\n`));
SCRIPT
cat head.txt bundle.mjs > "$here/codemirror.mjs"
cp LICENSES.txt "$here/LICENSES.txt"
