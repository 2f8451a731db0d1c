// The last step of build.sh: node pack.mjs FOLDER minifies the bindings, leaves out comments and compresses what
// a server may send compressed. Without a registry of packages the bindings stay as they are.

import { spawnSync } from "node:child_process";
import { readdirSync, readFileSync, writeFileSync } from "node:fs";
import { extname, join } from "node:path";
import { brotliCompressSync, constants, gzipSync } from "node:zlib";

const folder = process.argv[2];
const ESBUILD = "esbuild@0.28.2";
const bindings = ["afterimage_web.js", "compare.js"].map((name) => join(folder, name));
const options = ["--minify", "--format=esm", `--outdir=${folder}`, "--allow-overwrite", "--log-level=warning"];
const { status } = spawnSync("npx", ["--yes", ESBUILD, ...bindings, ...options], { stdio: "inherit", timeout: 120_000 });
if (status !== 0) console.log(`${ESBUILD} could not run: the bindings are not minified`);

// Comments are for readers of the repository: lines of nothing else are not sent.
const COMMENTS = { ".css": /^ *\/\*[^]*?\*\/\n/gm, ".js": /^ *\/\/.*\n/gm };

for (const name of readdirSync(folder)) {
    if (COMMENTS[extname(name)]) {
        const text = readFileSync(join(folder, name), "utf8");
        writeFileSync(join(folder, name), text.replace(COMMENTS[extname(name)], ""));
    }
    if (![".css", ".csv", ".html", ".js", ".txt", ".wasm"].includes(extname(name))) continue;
    const bytes = readFileSync(join(folder, name));
    const params = { [constants.BROTLI_PARAM_SIZE_HINT]: bytes.length };
    writeFileSync(join(folder, `${name}.gz`), gzipSync(bytes, { level: 9 }));
    writeFileSync(join(folder, `${name}.br`), brotliCompressSync(bytes, { params }));
}
