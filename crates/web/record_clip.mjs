// Records page/clip.webm, which browsers without WebGPU show, and page/card.jpg, the picture of the preview card and of
// the page without JavaScript: node record_clip.mjs [FOLDER THAT build.sh MADE]. Needs Chromium and ffmpeg.

import { spawnSync } from "node:child_process";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { launch, serve } from "../../tests/web/chromium.mjs";

const here = dirname(fileURLToPath(import.meta.url));
const FRAMES_PER_SECOND = 20;
const SECONDS = 5;
const server = await serve({ demo: process.argv[2] ?? join(here, "dist") });
const folder = mkdtempSync(join(tmpdir(), "clip-"));

// A page whose stage alone is seen, at a size, and whose frames are drawn one by one: resolves to what draws the next
// and takes its picture.
async function stage([width, height], scene) {
    const browser = await launch({ size: [width, height] });
    await browser.send("Emulation.setDeviceMetricsOverride", { width, height, deviceScaleFactor: 1, mobile: false });
    await browser.goto(`${server.url}/demo/?size=${width}x${height}&scene=${scene}`);
    while (!(await browser.evaluate("window.frames_shown > 0"))) await new Promise((resolve) => setTimeout(resolve, 100));
    // The page's own frames wait for this job.
    await browser.evaluate("new Promise((resolve) => page.later(() => (resolve(), new Promise(() => {}))))");
    await browser.evaluate(`{
        const style = document.createElement("style");
        style.textContent = "html { overflow: hidden } #stage { position: fixed !important; inset: 0; z-index: 9; border-radius: 0 !important } #hint, #fullscreen { display: none }";
        document.head.append(style);
    }`);
    const shoot = async (options) => (await browser.send("Page.captureScreenshot", options)).data;
    return {
        draw: (seconds) => browser.evaluate(`page.set_clock(${seconds}); page.gaze.advance(${seconds}); page.draw(); page.demo().finished()`),
        shoot,
        close: browser.close,
    };
}

try {
    let number = 0;
    for (const scene of ["text", "space"]) {
        const page = await stage([640, 360], scene);
        for (let i = 0; i < SECONDS * FRAMES_PER_SECOND; i++) {
            await page.draw(i / FRAMES_PER_SECOND);
            writeFileSync(join(folder, `${String(number++).padStart(4, "0")}.png`), await page.shoot({ format: "png" }), "base64");
        }
        await page.close();
    }
    const page = await stage([1200, 630], "text");
    for (let i = 0; i < 60; i++) await page.draw(i / FRAMES_PER_SECOND);
    writeFileSync(join(here, "page/card.jpg"), await page.shoot({ format: "jpeg", quality: 70 }), "base64");
    await page.close();
} finally {
    server.close();
}
const codec = ["-c:v", "libvpx-vp9", "-crf", "40", "-b:v", "0", "-pix_fmt", "yuv420p"];
const input = ["-framerate", String(FRAMES_PER_SECOND), "-i", join(folder, "%04d.png")];
const { status } = spawnSync("ffmpeg", ["-y", "-loglevel", "error", ...input, ...codec, join(here, "page/clip.webm")], { stdio: "inherit" });
rmSync(folder, { recursive: true });
process.exit(status ?? 1);
