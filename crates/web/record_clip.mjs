// Records page/clip.webm, which browsers without WebGPU show: node record_clip.mjs [FOLDER THAT build.sh MADE]. Needs Chromium
// and ffmpeg.

import { spawnSync } from "node:child_process";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { launch, serve } from "../../tests/web/chromium.mjs";

const here = dirname(fileURLToPath(import.meta.url));
const size = [640, 360];
const frames_per_second = 20;
const server = await serve({ demo: process.argv[2] ?? join(here, "dist") });
const browser = await launch({ size: [1280, 900] });
const folder = mkdtempSync(join(tmpdir(), "clip-"));
try {
    const [width, height] = [1280, 900];
    await browser.send("Emulation.setDeviceMetricsOverride", { width, height, deviceScaleFactor: 1, mobile: false });
    await browser.goto(`${server.url}/demo/?size=${size.join("x")}`);
    while (!(await browser.evaluate("window.frames_shown > 0"))) await new Promise((resolve) => setTimeout(resolve, 100));
    // The page's own frames wait for this job.
    await browser.evaluate("void page.later(() => new Promise(() => {}))");
    await browser.evaluate("new Promise((resolve) => setTimeout(resolve, 1000))");
    // The canvas alone, at its size.
    await browser.evaluate(`Object.assign(document.getElementById("stage").style, {
        position: "fixed", left: 0, top: 0, width: "${size[0]}px", height: "${size[1]}px", borderRadius: 0, zIndex: 9,
    })`);
    const clip = { x: 0, y: 0, width: size[0], height: size[1], scale: 1 };
    let number = 0;
    for (const scene of ["text", "space"]) {
        const chosen = `document.querySelector("input[name=scene][value=${scene}]").checked = true`;
        await browser.evaluate(`${chosen}; page.show()`);
        for (let i = 0; i < 5 * frames_per_second; i++) {
            const seconds = i / frames_per_second;
            await browser.evaluate(`page.draw(${seconds}); page.demo().finished()`);
            const { data } = await browser.send("Page.captureScreenshot", { format: "png", clip });
            writeFileSync(join(folder, `${String(number++).padStart(4, "0")}.png`), data, "base64");
        }
    }
} finally {
    await browser.close();
    server.close();
}
const codec = ["-c:v", "libvpx-vp9", "-crf", "34", "-b:v", "0", "-pix_fmt", "yuv420p"];
const input = ["-framerate", String(frames_per_second), "-i", join(folder, "%04d.png")];
const { status } = spawnSync("ffmpeg", ["-y", "-loglevel", "error", ...input, ...codec, join(here, "page/clip.webm")], { stdio: "inherit" });
rmSync(folder, { recursive: true });
process.exit(status ?? 1);
