// Tests of the demo in headless Chromium on SwiftShader: node test.mjs [FOLDER THAT build.sh MADE] [NAME OF A TEST].
// AFTERIMAGE_SHOTS=FOLDER keeps pictures. mutants.mjs shows that they can fail.

import { existsSync, mkdtempSync, readFileSync, rmSync, statSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { launch, serve } from "../../tests/web/chromium.mjs";

const here = dirname(fileURLToPath(import.meta.url));
const folder = process.argv[2] ?? join(here, "dist");
// What is loaded to the first picture, every file compressed by gzip.
const MOST_BYTES = 200_000;
// So many more where no registry of packages was there to minify the bindings (pack.mjs).
const UNMINIFIED_BYTES = 5_000;
const server = await serve({ demo: folder });
const files = mkdtempSync(join(tmpdir(), "pictures-"));
let failures = 0;

function check(is_right, what) {
    console.log(`${is_right ? "ok    " : "FAILED"} ${what}`);
    if (!is_right) failures++;
}

const wait = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

// In the page: what tests ask of it.
const IN_PAGE = `window.test = {
    // Resolves to what look() makes of the canvas's pixels after the frame that draw() draws.
    canvas: (draw, look) => page.later(async () => {
        const canvas = document.getElementById("canvas");
        const surface = new OffscreenCanvas(canvas.width, canvas.height).getContext("2d");
        draw();
        surface.drawImage(canvas, 0, 0);
        return look(surface.getImageData(0, 0, canvas.width, canvas.height));
    }),
    // Middle of the ring around the gaze, and the divider's column, as shares of the canvas.
    marks: () => test.canvas(page.draw, ({ data, width, height }) => {
        const columns = Array.from({ length: width }, () => []);
        for (let i = 0; i < data.length; i += 4) {
            const [r, g, b] = data.slice(i, i + 3);
            if (r > 225 && g > 150 && g < 205 && b < 70) columns[(i / 4) % width].push(Math.floor(i / 4 / width));
        }
        const line = columns.findIndex((rows) => rows.length > 0.6 * height);
        let [x, y, n] = [[], [], 0];
        columns.forEach((rows, column) => {
            if (Math.abs(column - line) < 4 || rows.length === 0) return;
            x.push(column);
            y.push(...rows);
        });
        const middle = (values) => (Math.min(...values) + Math.max(...values)) / 2;
        return { line: (line + 1) / width, ring: [(middle(x) + 0.5) / width, (middle(y) + 0.5) / height] };
    }),
    configure: (demo, method, filter = "quads") => demo.configure(method, filter, 12, 26, 4, 8),
    gaze: (i, [width, height]) => [width * (0.3 + 0.125 * i), height * (0.4 + 0.075 * i)],
    encoded: (v) => 255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055),
    twin: async () => {
        const library = await import("./compare.js");
        await library.default();
        return library.Demo.open(document.createElement("canvas"), ...page.size());
    },
    // A picture's file, which draw() paints.
    picture: async (size, name, draw) => {
        const canvas = new OffscreenCanvas(...size);
        draw(canvas.getContext("2d"), size);
        return new File([await canvas.convertToBlob()], name, { type: "image/png" });
    },
    give: (kind, file) => {
        const data = new DataTransfer();
        if (file) data.items.add(file);
        const [paste, drop] = [{ clipboardData: data, bubbles: true }, { dataTransfer: data, bubbles: true }];
        document.body.dispatchEvent(kind === "paste" ? new ClipboardEvent("paste", paste) : new DragEvent("drop", drop));
    },
};`;

// A page of the demo. `script` runs before the page's own; `features` are media features.
async function open({ size = [1280, 800], query = "size=320x180", script, features = [], density = 1, is_ready = true } = {}) {
    const browser = await launch({ size });
    const errors = [];
    browser.on("Runtime.exceptionThrown", ({ exceptionDetails: e }) => errors.push(e.exception?.description ?? e.text));
    browser.on("Runtime.consoleAPICalled", ({ type, args }) => {
        if (type === "error" || type === "warning") errors.push(args.map((a) => a.value ?? a.description).join(" "));
    });
    browser.on("Log.entryAdded", ({ entry }) => {
        if (entry.level === "error" || entry.level === "warning") errors.push(`${entry.text} ${entry.url ?? ""}`);
    });
    const requests = [];
    browser.on("Network.requestWillBeSent", ({ request }) => requests.push(request.url));
    await browser.send("Network.enable");
    const resize = ([width, height], density = 1) =>
        browser.send("Emulation.setDeviceMetricsOverride", { width, height, deviceScaleFactor: density, mobile: width < 900 });
    await resize(size, density);
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
    // Until the page has shown frames with the last settings.
    const settled = async () => {
        await browser.evaluate("page.later(async () => {})");
        const shown = await browser.evaluate("frames_shown");
        await until(`frames_shown > ${shown + 1}`);
    };
    const choose = async (name, value) => {
        await browser.evaluate(`{
            const control = document.querySelector('input[name="${name}"][value="${value}"]') ?? document.getElementById("${name}");
            if (control.type === "radio") control.click();
            else {
                control.value = "${value}";
                control.dispatchEvent(new Event("change", { bubbles: true }));
            }
        }`);
        await settled();
    };
    const text = (id) => browser.evaluate(`document.getElementById("${id}").textContent`);
    // Numbers of values compared with the CPU and of those that differ.
    const compare = async () => {
        await browser.evaluate('document.getElementById("compare").click()');
        await until('/differ|could not/.test(document.getElementById("compared").textContent)', 120);
        return ((await text("compared")).match(/^(\d+) of ([\d,]+)/)?.slice(1) ?? [NaN, NaN]).map((n) => Number(String(n).replaceAll(",", "")));
    };
    const box = async (selector) => JSON.parse(await browser.evaluate(`JSON.stringify(document.querySelector("${selector}").getBoundingClientRect())`));
    const mouse = (type, x, y, buttons = 0) =>
        browser.send("Input.dispatchMouseEvent", { type, x, y, button: buttons || type === "mouseReleased" ? "left" : "none", buttons, clickCount: 1 });
    const click = async (selector) => {
        const { x, y, width, height } = await box(selector);
        await mouse("mousePressed", x + width / 2, y + height / 2, 1);
        await mouse("mouseReleased", x + width / 2, y + height / 2);
    };
    const key = async (name, code) => {
        await browser.send("Input.dispatchKeyEvent", { type: "keyDown", key: name, code });
        await browser.send("Input.dispatchKeyEvent", { type: "keyUp", key: name, code });
    };
    const no_errors = () => check(errors.length === 0, `errors in the console: ${errors.length}${errors.map((e) => `\n       ${e}`).join("")}`);
    const page = { ...browser, errors, requests, until, picture, choose, settled, compare, text, box, mouse, click, key, resize, no_errors };
    if (is_ready) {
        if (!(await until("window.frames_shown > 1"))) {
            throw new Error(`no frames within a minute; the page says:\n${await browser.evaluate("document.body.innerText")}\nand its console:\n${errors.join("\n")}`);
        }
        await browser.evaluate(IN_PAGE);
    }
    return page;
}

const tests = {
    async frames_are_those_of_the_cpu() {
        const page = await open({ query: "size=480x270" });
        console.log(`       first frame after ${(await page.evaluate("first_frame_ms")).toFixed(0)} ms`);
        // Every scene and method in the library of the comparison; the page's frames wait.
        const compare = (scene, method, filter) => page.evaluate(`page.later(async () => {
            window.twin ??= await test.twin();
            document.querySelector("input[value=${scene}]").checked = true;
            if ("${scene}" === "space") twin.space();
            else twin.picture(await page.picture(page.size()));
            test.configure(twin, "${method}", "${filter}");
            return [...await twin.compare(4)];
        })`);
        const all = ["text", "courtyard", "space"].flatMap((scene) => ["smr", "wrs", "taa", "none"].map((method) => [scene, method, "quads"]));
        for (const [scene, method, filter] of [...all, ...["mip", "block", "gauss"].map((filter) => ["courtyard", "smr", filter])]) {
            const [values, different] = await compare(scene, method, filter);
            check(different === 0 && values === 2 * 4 * 3 * 480 * 270, `${scene}, ${method}, ${filter}: ${different} of ${values} values differ from the CPU`);
        }
        // As the page's button does it.
        for (const scene of ["space", "courtyard"]) {
            await page.choose("scene", scene);
            const [different, values] = await page.compare();
            check(different === 0 && values === 2 * 4 * 3 * 480 * 270, `the button, ${scene}: ${different} of ${values} values differ from the CPU`);
            await page.picture(`${scene}.png`);
        }
        page.no_errors();
        await page.close();
    },

    async a_planted_error_is_caught() {
        // Another text of one shader than the one that the library wrote.
        const script = `
            const make = GPUDevice.prototype.createShaderModule;
            GPUDevice.prototype.createShaderModule = function (descriptor) {
                return make.call(this, { ...descriptor, code: descriptor.code.replace("const ACCUMULATE:f32=0.5;", "const ACCUMULATE:f32=0.499;") });
            };`;
        const page = await open({ script });
        const [different, values] = await page.compare();
        check(different > 0, `a planted error is caught: ${different} of ${values} values differ from the CPU`);
        await page.close();
    },

    // Left of the line the canvas shows the CPU's frames without a method, right of it those with it.
    async each_half_shows_its_frames() {
        const page = await open();
        for (const scene of ["text", "space"]) {
            await page.choose("scene", scene);
            const result = await page.evaluate(`(async () => {
                const [size, twin] = [page.size(), await test.twin()];
                const [width, height] = size;
                const shown_of = async (demo) => "${scene}" === "space" ? demo.space() : demo.picture(await page.picture(size));
                await shown_of(twin);
                test.configure(twin, "smr");
                const different = (await twin.compare(4))[1];
                // The same bits as the CPU's.
                const cpu = [await twin.delivered(), await twin.shown()].map((texels) => texels.map(test.encoded));
                await page.later(() => shown_of(page.demo()));
                const line = width / 2;
                const [x, y] = test.gaze(3, size);
                return test.canvas(() => {
                    test.configure(page.demo(), "smr");
                    for (let i = 0; i < 4; i++) page.demo().frame(...test.gaze(i, size), i / 4, line, 1);
                }, ({ data }) => {
                    const ring_px = 0.5 * width * Math.tan((6 * Math.PI) / 180) / Math.tan((35 * Math.PI) / 180);
                    let [wrong, compared, telling] = [0, 0, 0];
                    for (let i = 0; i < data.length; i++) {
                        const [px, py] = [(i >> 2) % width, Math.floor((i >> 2) / width)];
                        const is_marked = Math.abs(px - line) < 4 || Math.abs(Math.hypot(px - x, py - y) - ring_px) < 4;
                        if (i % 4 === 3 || is_marked) continue;
                        const half = px < line ? 0 : 1;
                        compared++;
                        wrong += Math.abs(data[i] - cpu[half][i]) > 1 ? 1 : 0;
                        telling += Math.abs(cpu[0][i] - cpu[1][i]) > 3 ? 1 : 0;
                    }
                    return { different, wrong, compared, telling };
                });
            })()`);
            const { different, wrong, compared, telling } = result;
            check(different === 0 && wrong === 0 && compared > 150_000, `${scene}: ${wrong} of ${compared} bytes of the canvas are not those of the CPU's frames`);
            check(telling > 20_000, `of which ${telling} tell the halves apart`);
        }
        await page.close();
    },

    async what_was_looked_at_stays_sharp() {
        const page = await open();
        // Error around A: of what the renderer delivers, and with memory before and after somebody looked there. Means,
        // because single pixels that move show a still picture by and by without any gaze.
        const [plain, before, after] = await page.evaluate(`page.later(async () => {
            const demo = page.demo();
            const [[width], rgba] = [page.size(), await page.picture(page.size())];
            const [a, b] = [[85, 75], [240, 75]];
            const look_at = (at) => { for (let i = 0; i < 3; i++) demo.frame(...at, 0, 160, 1); };
            const error = (texels) => {
                let [sum, n] = [0, 0];
                for (let i = 0; i < texels.length; i++) {
                    const px = [(i >> 2) % width, Math.floor((i >> 2) / width)];
                    if (i % 4 === 3 || Math.hypot(px[0] - a[0], px[1] - a[1]) > 17) continue;
                    sum += (test.encoded(texels[i]) / 255 - rgba[i] / 255) ** 2;
                    n++;
                }
                return Math.min(99, -10 * Math.log10(sum / n));
            };
            demo.picture(rgba);
            test.configure(demo, "smr", "mip");
            look_at(b);
            const [plain, before] = [error(await demo.delivered()), error(await demo.shown())];
            look_at(a);
            look_at(b);
            return [plain, before, error(await demo.shown())];
        })`);
        check(Math.abs(before - plain) < 1, `before anybody looks, memory shows no more than the renderer: ${before.toFixed(1)} and ${plain.toFixed(1)} dB`);
        check(after > before + 15, `what was looked at stays sharp: ${after.toFixed(1)} dB`);
        await page.until("/^[1-9]/.test(document.getElementById('gain').textContent)");
        check(/^[\d.]+ dB$/.test(await page.text("gain")), `the page says “sharper by ${await page.text("gain")}”`);
        check(/^[1-9]\d? %$/.test(await page.text("shaded")), `and “pixels shaded: ${await page.text("shaded")}”`);
        await page.close();
    },

    async pointer_and_keys_move_gaze_and_line() {
        const page = await open();
        const { x, y, width, height } = await page.box("#canvas");
        const at = (share_x, share_y) => [x + width * share_x, y + height * share_y];
        const near = (a, b, tolerance = 0.01) => Math.abs(a - b) < tolerance;
        await page.mouse("mouseMoved", ...at(0.25, 0.4));
        let marks = await page.evaluate("test.marks()");
        check(near(marks.ring[0], 0.25) && near(marks.ring[1], 0.4), `the ring is at the pointer: ${marks.ring.map((v) => v.toFixed(3))}`);
        check(near(marks.line, 0.5), `the line is in the middle: ${marks.line.toFixed(3)}`);

        const drag = async (from, to) => {
            await page.mouse("mouseMoved", ...at(from, 0.8));
            await page.mouse("mousePressed", ...at(from, 0.8), 1);
            for (const share of [0.7 * from + 0.3 * to, to]) await page.mouse("mouseMoved", ...at(share, 0.8), 1);
            await page.mouse("mouseReleased", ...at(to, 0.8));
            return page.evaluate("test.marks()");
        };
        marks = await drag(0.5, 0.7);
        check(near(marks.line, 0.7), `the line is dragged in the picture: ${marks.line.toFixed(3)}`);
        check(near(marks.ring[0], 0.5), `the gaze stays meanwhile: ${marks.ring[0].toFixed(3)}`);
        check((await page.evaluate("location.search")).includes("divider=70"), "and the address says where it is");
        await page.evaluate("document.documentElement.dir = 'rtl'");
        marks = await drag(0.7, 0.4);
        check(near(marks.line, 0.4), `on a page from right to left, too: ${marks.line.toFixed(3)}`);
        await page.evaluate("document.documentElement.dir = 'ltr'");

        await page.mouse("mouseMoved", ...at(0.6, 0.5));
        await page.evaluate("document.getElementById('canvas').focus()");
        await page.key("ArrowLeft", "ArrowLeft");
        await page.key("ArrowDown", "ArrowDown");
        const moved = await page.evaluate("page.gaze.at");
        check(moved[0] < 0.6 - 0.005 && moved[1] > 0.5 + 0.01, `arrow keys move the gaze: ${moved.map((v) => v.toFixed(3))}`);
        await page.key("]", "BracketRight");
        check(near((await page.evaluate("test.marks()")).line, 0.42), "a key moves the line");
        await page.evaluate("document.getElementById('divider').focus()");
        await page.key("Home", "Home");
        check((await page.evaluate("document.getElementById('divider').value")) === "0", "and so does the slider's");
        check(await page.evaluate("document.querySelector('.side.left').hidden && !document.querySelector('.side.right').hidden"), "a half that is not there has no label");
        page.no_errors();
        await page.close();
    },

    async the_scanpath_is_fair_and_goes_on() {
        const page = await open();
        const words = await page.evaluate("document.body.textContent");
        check(/synthetic/.test(words) && !/recorded path/.test(words), "the page says that its scanpath is synthetic");
        const shares = await page.evaluate("[0.5, 1].map((part) => page.gaze.scanpath.slice(0, part * page.gaze.scanpath.length)).map((rows) => rows.filter(([x]) => x < 0.5).length / rows.length)");
        check(shares.every((left) => left > 0.4 && left < 0.6), `it looks at the left half for ${shares.map((left) => (100 * left).toFixed(0)).join(" and ")} % of its first half and of all`);
        const { x, y } = await page.box("#canvas");
        await page.mouse("mouseMoved", x + 9, y + 9);
        await page.settled();
        check((await page.evaluate("page.gaze.at")).every((share) => share < 0.02), "the pointer takes the gaze");
        check(!(await page.evaluate("getComputedStyle(document.getElementById('hint')).display !== 'none'")), "and the hint goes");
        check(await page.until("page.gaze.at[0] > 0.03", 10), "the scanpath goes on when nobody moves it");
        check(await page.until("getComputedStyle(document.getElementById('hint')).display !== 'none'", 2), "with the hint");
        await page.close();
    },

    async a_slow_device_moves_by_frames() {
        const page = await open({ query: "size=320x180&scene=space" });
        await page.evaluate("page.gaze.advance = () => (page.gaze.at = [0.6, 0.6])");
        const start = await page.evaluate("[page.clock(), frames_shown]");
        for (let i = 0; i < 24; i++) await page.evaluate("page.later(() => new Promise((resolve) => setTimeout(resolve, 250)))");
        const end = await page.evaluate("[page.clock(), frames_shown]");
        const step_s = (end[0] - start[0]) / (end[1] - start[1]);
        check(step_s > 0.001 && step_s < 0.04, `at under four frames a second the camera moves on by ${(1000 * step_s).toFixed(0)} ms a frame`);
        const [left, right] = await page.evaluate("page.later(async () => [...await page.demo().quality()])");
        check(right > left + 1.5, `and memory is of use: ${left.toFixed(1)} and ${right.toFixed(1)} dB`);
        await page.picture("space_slow.png");
        // An edge between two even colors has a pixel of neither where it is a mean of rays.
        const [smooth, hard] = await page.evaluate(`page.later(async () => {
            const [demo, [width]] = [page.demo(), page.size()];
            demo.space();
            demo.configure("none", "quads", 120, 120, 2, 2);
            demo.frame(160, 90, 0, 160, 1);
            const red = (await demo.delivered()).filter((_, i) => i % 4 === 0).map(test.encoded);
            let [smooth, hard] = [0, 0];
            for (let i = 2; i + 2 < red.length; i++) {
                const [a, b, c, d, e] = red.slice(i - 2, i + 3);
                const is_edge = Math.abs(a - b) < 6 && Math.abs(d - e) < 6 && Math.abs(b - d) > 40;
                if (!is_edge || i % width < 2 || i % width > width - 3) continue;
                if (Math.min(Math.abs(c - b), Math.abs(c - d)) > 8) smooth++;
                else hard++;
            }
            return [smooth, hard];
        })`);
        check(smooth > 1.5 * hard, `${smooth} of its edges are smooth, ${hard} are hard`);
        page.no_errors();
        await page.close();
    },

    async choices_are_kept_and_do_not_queue() {
        const page = await open();
        const before = await page.evaluate("history.length");
        const applied = await page.evaluate(`(async () => {
            const demo = page.demo();
            const configure = demo.configure;
            let count = 0;
            demo.configure = function (...args) {
                count++;
                return configure.apply(this, args);
            };
            page.later(() => new Promise((resolve) => setTimeout(resolve, 600)));
            for (let i = 0; i < 10; i++) for (const method of ["wrs", "taa"]) document.querySelector("input[value=" + method + "]").click();
            await page.later(async () => {});
            const shown = frames_shown;
            while (frames_shown < shown + 3) await new Promise(requestAnimationFrame);
            return count;
        })()`);
        check(applied === 1, `twenty quick clicks are applied ${applied} time`);
        await page.choose("scene", "courtyard");
        await page.choose("filter", "block");
        await page.choose("rate_far", "16");
        const query = await page.evaluate("location.search");
        check(query === "?size=320x180&method=taa&scene=courtyard&filter=block&rate_far=16", `the address has the choices: ${query}`);
        check((await page.evaluate("history.length")) === before, "and the way back is as short as before");
        await page.close();
        const again = await open({ query: query.slice(1) });
        const chosen = await again.evaluate("['scene', 'method'].map((name) => document.querySelector(`input[name=${name}]:checked`).value).concat(document.getElementById('filter').value, document.getElementById('rate_far').value)");
        check(String(chosen) === "courtyard,taa,block,16", `which another page opens with: ${chosen}`);
        again.no_errors();
        await again.close();
    },

    async comparing_keeps_history() {
        const page = await open();
        await page.choose("filter", "mip");
        for (const at of ["[0.2, 0.4]", "[0.5, 0.4]", "[0.8, 0.4]"]) {
            await page.evaluate(`page.gaze.advance = () => (page.gaze.at = ${at})`);
            await page.settled();
        }
        const quality = () => page.evaluate("page.later(async () => [...await page.demo().quality()])");
        const [left, before] = await quality();
        const [different] = await page.compare();
        const [, after] = await quality();
        const figures = [left, before, after].map((db) => db.toFixed(1)).join(", ");
        check(different === 0 && before > left + 1 && after > before - 0.2, `a comparison leaves history as it was (without it, before, after: ${figures} dB)`);
        check(!(await page.evaluate("document.getElementById('compare').disabled")), "and can be made again");
        await page.close();
    },

    async a_picture_of_ones_own() {
        const page = await open();
        const look = `test.canvas(page.draw, ({ data, width, height }) => [0.02, 0.4, 0.6, 0.98].map((x) => [...data.slice(4 * (Math.floor(0.25 * height) * width + Math.floor(x * width)), 4 * (Math.floor(0.25 * height) * width + Math.floor(x * width)) + 3)]))`;
        const is_bar = ([r, g, b]) => Math.max(r, g, b) < 40;
        const is_near = (color, expected) => color.every((v, i) => Math.abs(v - expected[i]) < 12);
        // Portrait: left half red, right half transparent.
        const portrait = "test.picture([300, 600], 'portrait.png', (s) => { s.fillStyle = '#c02020'; s.fillRect(0, 0, 150, 600); })";
        // Of another color, as a file on the disk.
        const bytes = await page.evaluate("test.picture([40, 40], 'green.png', (s) => { s.fillStyle = '#20c020'; s.fillRect(0, 0, 40, 40); }).then(async (file) => [...new Uint8Array(await file.arrayBuffer())])");
        writeFileSync(join(files, "green.png"), Buffer.from(bytes));
        writeFileSync(join(files, "notes.txt"), "no picture");

        const upload = async (name) => {
            const { root } = await page.send("DOM.getDocument");
            const { nodeId } = await page.send("DOM.querySelector", { nodeId: root.nodeId, selector: "#own" });
            await page.send("DOM.setFileInputFiles", { nodeId, files: [join(files, name)] });
            await wait(300);
            await page.settled();
            await page.settled();
        };
        await upload("green.png");
        let seen = await page.evaluate(look);
        check(is_near(seen[1], [32, 192, 32]) && is_near(seen[2], [32, 192, 32]), `a chosen file is shown: ${seen[1]}`);
        check(is_bar(seen[0]) && is_bar(seen[3]), "between bars, whole");
        check(await page.evaluate("document.getElementById('own_label').classList.contains('is-chosen') && !document.querySelector('input[name=scene]:checked')"), "and marked as chosen");

        for (const kind of ["paste", "drop"]) {
            await page.choose("scene", "text");
            await page.evaluate(`${portrait}.then((file) => test.give("${kind}", file))`);
            await wait(300);
            await page.settled();
            await page.settled();
            seen = await page.evaluate(look);
            check(is_near(seen[1], [192, 32, 32]) && is_bar(seen[0]) && is_bar(seen[3]), `${kind}: a portrait is shown, between bars: ${seen[1]}`);
            check(is_near(seen[2], [255, 255, 255]), `${kind}: white under what is transparent: ${seen[2]}`);
        }
        await page.picture("own.png");

        const [stage, refused] = [await page.box("#stage"), async (what, words) => {
            const [text, box] = [await page.text("notice"), await page.box("#notice")];
            const is_there = box.height > 0 && box.top > stage.top && box.bottom < stage.bottom;
            check(words.test(text) && is_there, `${what}: “${text}”, on the picture`);
        }];
        await upload("notes.txt");
        await refused("a text", /“notes.txt” is not a picture/);
        await page.evaluate("test.give('drop', new File(['broken'], 'broken.png', { type: 'image/png' }))");
        await wait(300);
        await refused("a broken picture", /cannot read “broken.png”/);
        await page.evaluate("test.give('paste')");
        await refused("an empty clipboard", /no picture/);
        await page.settled();
        seen = await page.evaluate(look);
        check(is_near(seen[1], [192, 32, 32]), "what was shown stays");
        page.no_errors();
        await page.close();
    },

    async a_lost_device_is_replaced() {
        const page = await open({ query: "size=320x180&scene=courtyard" });
        await page.evaluate("page.later(async () => page.demo().lose())");
        check(await page.until("document.getElementById('trouble').open", 20), "a lost device is reported");
        const reason = await page.text("reason");
        check(/driver/.test(reason) && !/Destroyed|Device/.test(reason), `in a sentence: ${reason}`);
        check((await page.text("raw")).length > 30, "with the browser's words for a report");
        await page.until("document.getElementById('clip').readyState >= 1", 10);
        const loaded = await page.box("#again");
        await page.evaluate("document.getElementById('clip').removeAttribute('src'); document.getElementById('clip').load()");
        const empty = await page.box("#again");
        check(loaded.top === empty.top, `the button stays where it is while the recording loads: ${empty.top}, ${loaded.top}`);
        await page.evaluate("window.is_old = true");
        await page.click("#again");
        await wait(500);
        check(await page.until("!window.is_old && window.frames_shown > 1"), "Try again shows frames again");
        check((await page.evaluate("document.querySelector('input[name=scene]:checked').value")) === "courtyard", "of the same scene");
        await page.close();
    },

    async without_webgpu_there_is_a_recording() {
        for (const [what, script, words] of [
            ["without WebGPU", "delete Navigator.prototype.gpu", /no WebGPU/],
            ["without an adapter", "GPU.prototype.requestAdapter = async () => null", /no graphics device/],
            ["at an address that is not secure", "Object.defineProperty(window, 'isSecureContext', { value: false })", /not secure/],
        ]) {
            const page = await open({ script, is_ready: false });
            check(await page.until("document.getElementById('trouble').open"), `${what} there is a message`);
            const title = await page.text("trouble_title");
            check(words.test(title), `which says: ${title}`);
            check(await page.until("document.getElementById('clip').readyState >= 2", 10), "and a recording");
            await page.picture("without.png");
            page.no_errors();
            await page.close();
        }
    },

    async without_javascript_there_is_a_picture() {
        const page = await launch({});
        await page.send("Emulation.setScriptExecutionDisabled", { value: true });
        await page.goto(`${server.url}/demo/`);
        await wait(500);
        const { width, height, natural } = await page.evaluate("(() => { const img = document.querySelector('#stage img'); return img ? { width: img.clientWidth, height: img.clientHeight, natural: img.naturalWidth } : {}; })()");
        check(natural > 600 && width > 600 && height > 300, `without JavaScript there is a picture, ${width}x${height} pixels large`);
        await page.close();
    },

    async frames_follow_window_and_speed() {
        const size = "[document.getElementById('canvas').width, document.getElementById('canvas').height]";
        const page = await open({ size: [390, 844], query: "", density: 2 });
        const stage = await page.box("#stage");
        const upright = await page.evaluate(size);
        check(Math.abs(upright[0] / upright[1] - stage.width / stage.height) < 0.02, `frames have the shape of the stage: ${upright.join("x")}`);
        // A device whose speed changes nothing, and forgets that it was another before.
        const frames_take = (ms) => `{ const demo = page.demo(); demo.frame = () => {}; demo.quality = async () => [1, 2]; demo.finished = () => new Promise((resolve) => setTimeout(resolve, ${ms})); }`;
        await page.evaluate(frames_take(25));
        await page.choose("filter", "mip");
        await page.resize([844, 390], 2);
        check(await page.until(`${size}[0] > ${size}[1]`, 20), "and of the phone that was turned");
        await page.settled();
        const [different, values] = await page.compare();
        check(different === 0 && values > 0, `after which ${different} of ${values} values differ from the CPU`);
        page.no_errors();
        await page.close();

        // Devices of other speeds: frames that take no time, and then such that take long.
        const other = await open({ size: [844, 390], query: "", density: 2 });
        await other.evaluate(frames_take(0));
        await other.choose("filter", "mip");
        const wide = await other.box("#stage");
        check(await other.until(`${size}[0] === ${Math.round(2 * wide.width)}`, 30), `on a fast device every pixel of the screen is one of the frame: ${await other.evaluate(size)}`);
        await other.evaluate(frames_take(100));
        check(await other.until(`${size}[0] * ${size}[1] < 150000`, 60), `on a slow one frames are smaller: ${await other.evaluate(size)}`);
        other.no_errors();
        await other.close();
    },

    async full_screen() {
        const page = await open();
        await page.click("#fullscreen");
        check(await page.until("document.fullscreenElement?.id === 'stage'", 5), "a button makes the picture as large as the screen");
        await page.settled();
        await page.click("#fullscreen");
        check(await page.until("!document.fullscreenElement", 5), "and small again");
        await page.close();
    },

    // What a stranger needs is there without scrolling.
    async ten_seconds() {
        for (const [name, size, density] of [["desktop", [1280, 800], 1], ["phone", [390, 844], 2], ["phone across", [844, 390], 2]]) {
            const page = await open({ size, density, query: "" });
            for (const [what, selector] of [
                ["title", "h1"], ["picture", "#stage"], ["label of the left half", ".side.left"], ["label of the right half", ".side.right"],
                ["what to do", "#hint"], ["a choice", "#scenes label:nth-of-type(1)"], ["the last choice", "#own_label"],
                ["share of pixels", "#shaded"], ["gain", "#gain"], ["link to the code", "nav a:nth-of-type(1)"], ["link to the paper", "nav a:nth-of-type(3)"],
            ]) {
                const { left, top, right, bottom } = await page.box(selector);
                const is_inside = left >= 0 && top >= 0 && right <= size[0] && bottom <= size[1] && right > left && bottom > top;
                if (!is_inside) check(false, `${name}: ${what} is at ${[left, top, right, bottom].map(Math.round)}`);
            }
            const { width, height } = await page.box("#stage");
            check((width * height) / (size[0] * size[1]) > 0.45, `${name}: everything is there, and the picture takes ${((100 * width * height) / (size[0] * size[1])).toFixed(0)} % of the screen`);
            const [left, right] = [await page.box(".side.left"), await page.box(".side.right")];
            const labels = await page.evaluate("[...document.querySelectorAll('.side')].map((label) => label.textContent)");
            check(left.right < right.left && left.height < 40 && String(labels) === "Without memory,With memory", `${name}: each half has a label, in a line: ${labels.join(", ")}`);
            check(await page.evaluate("document.documentElement.scrollWidth <= innerWidth"), `${name}: nothing is wider than the screen`);
            page.no_errors();
            await page.picture(`${name}.png`);
            await page.close();
        }
    },

    async the_first_picture_is_light() {
        const page = await open();
        const meta = await page.evaluate("Object.fromEntries([...document.querySelectorAll('meta[property]')].map((m) => [m.getAttribute('property'), m.content]))");
        check(meta["og:title"] && meta["og:description"] && existsSync(join(folder, meta["og:image"].split("/").at(-1))), "there is a preview card, and its picture");
        const names = [...new Set(page.requests.map((url) => new URL(url).pathname.split("/").at(-1) || "index.html"))];
        const bytes = (name) => statSync(join(folder, existsSync(join(folder, `${name}.gz`)) ? `${name}.gz` : name)).size;
        const sum = names.filter((name) => existsSync(join(folder, name))).reduce((sum, name) => sum + bytes(name), 0);
        const is_minified = readFileSync(join(folder, "afterimage_web.js"), "utf8").split("\n").length < 100;
        if (!is_minified) console.log("WARNING: the bindings are not minified: the size is compared with a larger one");
        check(names.length > 5 && sum <= MOST_BYTES + (is_minified ? 0 : UNMINIFIED_BYTES), `${sum} bytes to the first picture, in ${names.length} files`);
        await page.close();
    },

    async nothing_moves_for_those_who_want_that() {
        // Whether two frames of a picture that does not change itself are the same.
        const is_still = async (features) => {
            const page = await open({ features });
            await page.choose("method", "none");
            await page.choose("filter", "mip");
            const shown = () => page.evaluate("page.later(async () => (await page.demo().shown()).reduce((sum, v, i) => (sum + v * (i % 8191)) % 1e9, 0))");
            const first = await shown();
            await wait(1500);
            const same = first === (await shown());
            await page.close();
            return same;
        };
        check(!(await is_still([])), "the gaze follows the scanpath");
        check(await is_still([{ name: "prefers-reduced-motion", value: "reduce" }]), "with reduced motion it stands still");
    },
};

const chosen = Object.entries(tests).filter(([name]) => process.argv[3] === undefined || name === process.argv[3]);
if (chosen.length === 0) throw new Error(`no such test; there are: ${Object.keys(tests).join(", ")}`);
try {
    for (const [name, test] of chosen) {
        const start = performance.now();
        await test();
        console.log(`       ${name}: ${((performance.now() - start) / 1000).toFixed(1)} s`);
    }
} finally {
    server.close();
    rmSync(files, { recursive: true });
}
if (failures > 0) {
    console.log(`${failures} failures`);
    process.exit(1);
}
