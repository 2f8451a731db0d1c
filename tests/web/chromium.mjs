// Headless Chromium, driven by its DevTools protocol over a pipe, and a server of local files. No packages are needed.

import { spawn } from "node:child_process";
import { createServer } from "node:http";
import { existsSync, mkdtempSync, readFileSync, rmSync, statSync } from "node:fs";
import { tmpdir } from "node:os";
import { extname, join, normalize } from "node:path";

const TYPES = {
    ".css": "text/css",
    ".html": "text/html; charset=utf-8",
    ".js": "text/javascript",
    ".mjs": "text/javascript",
    ".png": "image/png",
    ".wasm": "application/wasm",
};

// SwiftShader is the software Vulkan device that Chromium brings; Dawn is its WebGPU. What Dawn draws on a canvas reaches
// the page only if the page is composed by SwiftShader, too: otherwise the device is lost at the first frame. The rest keeps
// Chromium off the network.
export const FLAGS = [
    "--headless=new",
    "--no-sandbox",
    "--enable-unsafe-webgpu",
    "--use-webgpu-adapter=swiftshader",
    "--use-angle=swiftshader",
    "--use-vulkan=swiftshader",
    "--enable-features=Vulkan",
    "--enable-unsafe-swiftshader",
    "--no-first-run",
    "--disable-quic",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--remote-debugging-pipe",
];

// Serves files: `folders` maps the first part of a path to a folder; `FILE.gz` beside a file is sent in its place.
// Resolves to the server's address.
export function serve(folders) {
    const server = createServer((request, response) => {
        const path = normalize(decodeURIComponent(new URL(request.url, "http://localhost").pathname));
        const [, first, ...rest] = path.split("/");
        try {
            let file = join(folders[first] ?? "/nonexistent", ...rest);
            if (statSync(file).isDirectory()) file = join(file, "index.html");
            const is_gzip = existsSync(`${file}.gz`) && /gzip/.test(request.headers["accept-encoding"]);
            const body = readFileSync(is_gzip ? `${file}.gz` : file);
            const encoding = is_gzip ? { "Content-Encoding": "gzip" } : {};
            response.writeHead(200, { "Content-Type": TYPES[extname(file)] ?? "application/octet-stream", ...encoding });
            response.end(body);
        } catch {
            response.writeHead(404);
            response.end();
        }
    });
    return new Promise((resolve) => {
        server.listen(0, "127.0.0.1", () => {
            resolve({ url: `http://localhost:${server.address().port}`, close: () => server.close() });
        });
    });
}

// A browser with one page. `flags` are added to the command line; those in `without` are left out.
export async function launch({ flags = [], without = [], size = [1280, 800] } = {}) {
    const profile = mkdtempSync(join(tmpdir(), "chromium-"));
    const kept = FLAGS.filter((flag) => !without.includes(flag));
    const args = [...kept, ...flags, `--user-data-dir=${profile}`, `--window-size=${size}`, "about:blank"];
    const process = spawn("chromium", args, { stdio: ["ignore", "ignore", "ignore", "pipe", "pipe"] });
    const waiting = new Map();
    const listeners = new Map();
    let number = 0;
    let rest = Buffer.alloc(0);
    process.stdio[4].on("data", (chunk) => {
        rest = Buffer.concat([rest, chunk]);
        for (let end = rest.indexOf(0); end >= 0; end = rest.indexOf(0)) {
            const message = JSON.parse(rest.subarray(0, end).toString());
            rest = rest.subarray(end + 1);
            if (message.id === undefined) {
                for (const listener of listeners.get(message.method) ?? []) listener(message.params);
                continue;
            }
            const { resolve, reject } = waiting.get(message.id);
            waiting.delete(message.id);
            if (message.error) reject(new Error(message.error.message));
            else resolve(message.result);
        }
    });
    const lost = () => {
        for (const { reject } of waiting.values()) reject(new Error("Chromium ended"));
        waiting.clear();
    };
    process.on("error", lost);
    process.on("exit", lost);
    process.stdio[3].on("error", lost);
    let sessionId;
    const send = (method, params = {}) =>
        new Promise((resolve, reject) => {
            if (process.exitCode !== null) return reject(new Error("Chromium ended"));
            waiting.set(++number, { resolve, reject });
            process.stdio[3].write(`${JSON.stringify({ id: number, method, params, sessionId })}\0`);
        });
    const { targetInfos } = await send("Target.getTargets");
    const { targetId } = targetInfos.find((target) => target.type === "page");
    ({ sessionId } = await send("Target.attachToTarget", { targetId, flatten: true }));
    const on = (event, listener) => listeners.set(event, [...(listeners.get(event) ?? []), listener]);
    await Promise.all(["Page", "Runtime", "Log"].map((domain) => send(`${domain}.enable`)));
    return {
        send,
        on,
        // Value of an expression of the page; of a promise, what it resolves to.
        async evaluate(expression) {
            const options = { expression, awaitPromise: true, returnByValue: true };
            const { result, exceptionDetails } = await send("Runtime.evaluate", options);
            if (exceptionDetails) throw new Error(exceptionDetails.exception?.description ?? exceptionDetails.text);
            return result.value;
        },
        async goto(url) {
            const loaded = new Promise((resolve) => on("Page.loadEventFired", resolve));
            await send("Page.navigate", { url });
            await loaded;
        },
        async close() {
            const ended = new Promise((resolve) => process.once("exit", resolve));
            process.kill("SIGKILL");
            await ended;
            // Its helpers end a little later.
            for (let tries = 0; tries < 20; tries++) {
                try {
                    return rmSync(profile, { recursive: true, force: true });
                } catch {
                    await new Promise((resolve) => setTimeout(resolve, 100));
                }
            }
        },
    };
}
