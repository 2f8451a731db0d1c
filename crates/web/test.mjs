// Tests of the demo in headless Chromium on SwiftShader: node test.mjs [FOLDER THAT build.sh MADE].

import { writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { launch, serve } from "../../tests/web/chromium.mjs";

const here = dirname(fileURLToPath(import.meta.url));
const folder = process.argv[2] ?? join(here, "dist");
const server = await serve({ demo: folder });
let failures = 0;

function check(is_right, what) {
    console.log(`${is_right ? "ok    " : "FAILED"} ${what}`);
    if (!is_right) failures++;
}

const wait = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

// A page of the demo. `script` runs before the page's own; `features` are media features.
async function open({ size = [1280, 900], query = "size=640x360", script, features = [] } = {}) {
    const browser = await launch({ size });
    const errors = [];
    browser.on("Runtime.exceptionThrown", ({ exceptionDetails: e }) => errors.push(e.exception?.description ?? e.text));
    browser.on("Runtime.consoleAPICalled", ({ type, args }) => {
        if (type === "error" || type === "warning") errors.push(args.map((a) => a.value ?? a.description).join(" "));
    });
    browser.on("Log.entryAdded", ({ entry }) => {
        if (entry.level === "error" || entry.level === "warning") errors.push(`${entry.text} ${entry.url ?? ""}`);
    });
    const [width, height] = size;
    await browser.send("Emulation.setDeviceMetricsOverride", { width, height, deviceScaleFactor: 1, mobile: width < 500 });
    await browser.send("Emulation.setEmulatedMedia", { features });
    if (script) await browser.send("Page.addScriptToEvaluateOnNewDocument", { source: script });
    await browser.goto(`${server.url}/demo/?${query}`);
    // Until an expression of the page is true.
    const until = async (expression, seconds = 60) => {
        for (const end = Date.now() + 1000 * seconds; Date.now() < end; await wait(50)) {
            if (await browser.evaluate(expression)) return true;
        }
        return false;
    };
    const picture = async (name) => {
        const { data } = await browser.send("Page.captureScreenshot", { format: "png" });
        if (process.env.AFTERIMAGE_SHOTS) writeFileSync(join(process.env.AFTERIMAGE_SHOTS, name), data, "base64");
    };
    const choose = async (name, value) => {
        await browser.evaluate(`document.querySelector("input[name=${name}][value=${value}]").click()`);
        await settled();
    };
    // Mean of what a frame leaves on the canvas, 0 to 1.
    const mean = () => browser.evaluate(`new Promise((resolve) => page.later(async () => {
        page.draw(1);
        const surface = new OffscreenCanvas(64, 36).getContext("2d");
        surface.drawImage(document.getElementById("canvas"), 0, 0, 64, 36);
        const bytes = surface.getImageData(0, 0, 64, 36).data.filter((_, i) => i % 4 < 3);
        resolve(bytes.reduce((sum, byte) => sum + byte, 0) / (255 * bytes.length));
    }))`);
    // Until the page has shown frames with the last settings.
    const settled = async () => {
        await browser.evaluate("page.later(async () => {})");
        const shown = await browser.evaluate("frames_shown");
        await until(`frames_shown > ${shown + 2}`);
    };
    // Numbers of values compared with the CPU and of those that differ.
    const compare = async () => {
        await browser.evaluate('document.getElementById("compare").click()');
        await until('document.getElementById("compared").textContent.includes("differ")');
        const text = await browser.evaluate('document.getElementById("compared").textContent');
        return text.match(/^(\d+) of ([\d,]+)/).slice(1).map((n) => Number(n.replaceAll(",", "")));
    };
    return { ...browser, errors, until, picture, choose, settled, compare, mean };
}

async function everything_works() {
    const page = await open();
    if (!(await page.until("window.first_frame_ms > 0"))) {
        const text = await page.evaluate("document.body.innerText");
        throw new Error(`no first frame within a minute; the page says:\n${text}\nand its console:\n${page.errors.join("\n")}`);
    }
    console.log(`       first frame after ${(await page.evaluate("first_frame_ms")).toFixed(0)} ms`);
    check(await page.until("window.frames_shown > 5"), "frames go on");
    check((await page.mean()) > 0.1, "and the canvas shows them");
    for (const scene of ["text", "courtyard", "space"]) {
        await page.choose("scene", scene);
        for (const method of ["smr", "wrs", "taa", "none"]) {
            await page.choose("method", method);
            const [different, values] = await page.compare();
            check(different === 0 && values === 4 * 3 * 640 * 360, `${scene}, ${method}: ${different} of ${values} values differ from the CPU`);
        }
    }
    await page.choose("scene", "courtyard");
    await page.choose("method", "smr");
    for (const filter of ["mip", "block", "gauss"]) {
        await page.evaluate(`{
            const filter = document.getElementById("filter");
            filter.value = "${filter}";
            filter.dispatchEvent(new Event("change", { bubbles: true }));
        }`);
        await page.settled();
        const [different, values] = await page.compare();
        check(different === 0 && values > 0, `${filter}, smr: ${different} of ${values} values differ from the CPU`);
    }
    await page.picture("courtyard.png");

    await page.choose("scene", "text");
    const move = (x, y) => page.send("Input.dispatchMouseEvent", { type: "mouseMoved", x, y });
    const box = JSON.parse(await page.evaluate("JSON.stringify(document.getElementById('canvas').getBoundingClientRect())"));
    for (let i = 0; i <= 20; i++) {
        await move(box.x + box.width * (0.1 + 0.04 * i), box.y + box.height * (0.3 + 0.3 * Math.abs(Math.sin(i))));
        await wait(60);
    }
    await page.settled();
    const [left, right] = await page.evaluate("new Promise((resolve) => page.later(async () => resolve([...await page.demo().quality()])))");
    check(right > left, `what was looked at stays sharp: ${left.toFixed(1)} dB without memory, ${right.toFixed(1)} dB with it`);
    await page.picture("text.png");

    await page.evaluate("document.getElementById('canvas').focus()");
    const key = async (name, code) => {
        await page.send("Input.dispatchKeyEvent", { type: "keyDown", key: name, code });
        await page.send("Input.dispatchKeyEvent", { type: "keyUp", key: name, code });
    };
    const divider = () => page.evaluate("Number(document.getElementById('divider').value)");
    const before = await divider();
    await key("]", "BracketRight");
    check((await divider()) > before, "a key moves the divider");
    const [x, y] = await page.evaluate("page.gaze()");
    await key("ArrowLeft", "ArrowLeft");
    const [moved_x, moved_y] = await page.evaluate("page.gaze()");
    check(moved_x === Math.max(x - 8, 0) && moved_y === y, "an arrow key moves the gaze");
    await page.evaluate("document.getElementById('divider').value = 20, document.getElementById('divider').dispatchEvent(new Event('input'))");
    await page.settled();
    await page.choose("scene", "space");
    await wait(3000);
    await page.picture("space.png");
    check((await page.evaluate("document.getElementById('shaded').textContent")).endsWith("%"), "the share of shaded pixels is shown");

    const frames = await page.evaluate("frames_shown");
    await page.send("Emulation.setDeviceMetricsOverride", { width: 390, height: 800, deviceScaleFactor: 1, mobile: true });
    await page.evaluate("history.replaceState(null, '', location.pathname)");
    await wait(400);
    await page.settled();
    check((await page.evaluate("frames_shown")) > frames, "frames go on after a change of the window");
    check(page.errors.length === 0, `errors in the console: ${page.errors.length}${page.errors.map((e) => `\n       ${e}`).join("")}`);

    await page.evaluate("page.later(async () => page.demo().lose())");
    check(await page.until("document.getElementById('trouble').open", 20), "a lost device is reported");
    console.log(`       ${await page.evaluate("document.getElementById('reason').textContent")}`);
    await page.close();
}

async function a_phone_and_its_size() {
    const page = await open({ size: [390, 800], query: "" });
    check(await page.until("window.frames_shown > 2"), "a phone's width shows frames");
    check((await page.evaluate("document.getElementById('canvas').width")) === 480, "of 480 pixels");
    check(await page.evaluate("document.documentElement.scrollWidth <= innerWidth"), "and nothing is wider than the screen");
    await page.picture("phone.png");
    // Rotated: frames of another size.
    await page.send("Emulation.setDeviceMetricsOverride", { width: 800, height: 390, deviceScaleFactor: 1, mobile: true });
    check(await page.until("document.getElementById('canvas').width === 640"), "a wider window has larger frames");
    await page.settled();
    const [different] = await page.compare();
    check(different === 0, `after the change of size ${different} values differ from the CPU`);
    check(page.errors.length === 0, `errors in the console: ${page.errors.length} ${page.errors.join("\n")}`);
    await page.close();
}

async function the_scanpath_is_fair() {
    const page = await open();
    await page.until("window.frames_shown > 2");
    const words = await page.evaluate("document.body.textContent");
    check(/synthetic/.test(words) && !/recorded path/.test(words), "the page says that its scanpath is synthetic");
    const left = await page.evaluate("page.scanpath().filter(([x]) => x < 0.5).length / page.scanpath().length");
    check(left > 0.4 && left < 0.6, `it looks at the left half for ${(100 * left).toFixed(0)} % of its time`);
    const { x, y } = JSON.parse(await page.evaluate("JSON.stringify(document.getElementById('canvas').getBoundingClientRect())"));
    await page.send("Input.dispatchMouseEvent", { type: "mouseMoved", x: x + 9, y: y + 9 });
    await page.settled();
    const taken = await page.evaluate("page.gaze()");
    check(taken[0] < 20 && taken[1] < 20, "the pointer takes the gaze");
    check(await page.until("page.gaze()[0] > 50", 10), "and the scanpath goes on after some seconds without it");
    await page.close();
}

async function nothing_moves_for_those_who_want_that() {
    // Whether two frames of a picture that does not change itself are the same.
    const is_still = async (features) => {
        const page = await open({ features });
        await page.until("window.frames_shown > 2");
        await page.choose("method", "none");
        await page.evaluate(`{
            const filter = document.getElementById("filter");
            filter.value = "mip";
            filter.dispatchEvent(new Event("change", { bubbles: true }));
        }`);
        await page.settled();
        const shown = () => page.evaluate(`new Promise((resolve) => page.later(async () => {
            resolve((await page.demo().shown()).reduce((sum, v, i) => (sum + v * (i % 8191)) % 1e9, 0));
        }))`);
        const first = await shown();
        await wait(1500);
        const same = first === (await shown());
        await page.close();
        return same;
    };
    check(!(await is_still([])), "the gaze follows the recorded path");
    check(await is_still([{ name: "prefers-reduced-motion", value: "reduce" }]), "with reduced motion it stands still");
}

async function without_webgpu() {
    const page = await open({ script: "delete Navigator.prototype.gpu" });
    check(await page.until("document.getElementById('trouble').open"), "without WebGPU there is a message");
    check(await page.until("document.getElementById('clip').readyState >= 2", 10), "and a recording");
    await page.picture("without.png");
    check(page.errors.length === 0, `errors in the console: ${page.errors.length} ${page.errors.join("\n")}`);
    await page.close();
}

async function a_planted_error_is_caught() {
    // Another text of one shader than the one that the library wrote.
    const script = `
        const make = GPUDevice.prototype.createShaderModule;
        GPUDevice.prototype.createShaderModule = function (descriptor) {
            return make.call(this, { ...descriptor, code: descriptor.code.replace("(history - r.candidate) * share", "(history - r.candidate) * (share * 0.999)") });
        };`;
    const page = await open({ script });
    await page.until("window.frames_shown > 2");
    const [different, values] = await page.compare();
    check(different > 0, `a planted error is caught: ${different} of ${values} values differ from the CPU`);
    await page.close();
}

try {
    await everything_works();
    await a_phone_and_its_size();
    await the_scanpath_is_fair();
    await nothing_moves_for_those_who_want_that();
    await without_webgpu();
    await a_planted_error_is_caught();
} finally {
    server.close();
}
if (failures > 0) {
    console.log(`${failures} failures`);
    process.exit(1);
}
