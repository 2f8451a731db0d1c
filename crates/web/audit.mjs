// Audits of the demo by others' rules: node audit.mjs [FOLDER THAT build.sh MADE]. axe on three screens, in light and
// in dark, and Lighthouse's performance on a desktop. Takes both from npm's registry. The figures are of a software
// device, and differ from run to run.

import { spawn, spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { FLAGS, launch, serve } from "../../tests/web/chromium.mjs";

const RUNS = 3;
const here = dirname(fileURLToPath(import.meta.url));
const server = await serve({ demo: process.argv[2] ?? join(here, "dist") });
const folder = mkdtempSync(join(tmpdir(), "audit-"));
const until = async (browser, expression) => {
    while (!(await browser.evaluate(expression))) await new Promise((resolve) => setTimeout(resolve, 100));
};
let violations = 0;
try {
    spawnSync("npm", ["install", "--silent", "--prefix", folder, "axe-core@4.14.1", "lighthouse@13.5.0"], { stdio: "inherit" });
    const axe = readFileSync(join(folder, "node_modules/axe-core/axe.min.js"), "utf8");
    for (const [[width, height], scheme] of [[[1280, 800], "light"], [[390, 844], "dark"], [[844, 390], "light"]]) {
        const browser = await launch({ size: [width, height] });
        await browser.send("Emulation.setDeviceMetricsOverride", { width, height, deviceScaleFactor: 1, mobile: width < 900 });
        await browser.send("Emulation.setEmulatedMedia", { features: [{ name: "prefers-color-scheme", value: scheme }] });
        await browser.goto(`${server.url}/demo/?size=320x180`);
        await until(browser, "window.frames_shown > 1");
        await browser.evaluate(axe);
        const audit = async (what) => {
            const found = JSON.parse(await browser.evaluate("axe.run().then(({ violations }) => JSON.stringify(violations.map(({ id, nodes }) => `${id}: ${nodes.map((node) => node.target)}`)))"));
            violations += found.length;
            console.log(`axe, ${width}x${height}, ${scheme}, ${what}: ${found.length} violations ${found.join("; ")}`);
        };
        await audit("page");
        await browser.evaluate("page.later(async () => page.demo().lose())");
        await until(browser, "document.getElementById('trouble').open");
        await audit("message");
        await browser.close();
    }
    const flags = FLAGS.filter((flag) => flag !== "--remote-debugging-pipe").join(" ");
    for (let run = 0; run < RUNS; run++) {
        const options = ["--preset=desktop", "--quiet", "--output=json", `--chrome-flags=${flags}`];
        const program = join(folder, "node_modules/.bin/lighthouse");
        // Not spawnSync: the server is in this process.
        const child = spawn(program, [`${server.url}/demo/`, ...options], { env: { ...process.env, CHROME_PATH: "/usr/bin/chromium" } });
        let json = "";
        child.stdout.on("data", (chunk) => (json += chunk));
        await new Promise((resolve) => child.on("exit", resolve));
        const { categories, audits } = JSON.parse(json);
        const scores = Object.values(categories).map(({ title, score }) => `${title} ${Math.round(100 * score)}`);
        const times = ["first-contentful-paint", "largest-contentful-paint", "total-blocking-time", "speed-index", "cumulative-layout-shift"];
        console.log(`Lighthouse: ${scores.join(", ")}; ${times.map((name) => `${name} ${audits[name].displayValue}`).join(", ")}`);
    }
} finally {
    server.close();
    rmSync(folder, { recursive: true });
}
if (violations > 0) process.exit(1);
