// Shows that test.mjs can fail: applies each mutant to a copy of the built page and runs the test that must catch it.
// node mutants.mjs [FOLDER THAT build.sh MADE] [PART OF A NAME]

import { spawnSync } from "node:child_process";
import { cpSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";

const here = dirname(fileURLToPath(import.meta.url));
const [built = join(here, "dist"), part = ""] = process.argv.slice(2);

// Name; the test that must catch it; the file; what is there, and what is put in its place. Texts in the library must
// be of equal length, because they are data there.
const MUTANTS = [
    ["halves swapped", "each_half_shows_its_frames", "afterimage_web_bg.wasm", "at.x < show.divider_px", "at.x > show.divider_px"],
    ["right half without memory", "each_half_shows_its_frames", "afterimage_web_bg.wasm", "at.x < show.divider_px", "at.x >-show.divider_px"],
    ["a label on the wrong side", "ten_seconds", "style.css", ".side.left {\n    left:", ".side.left {\n    right:"],
    ["a label that lies", "ten_seconds", "index.html", "Without memory</p>", "With memory</p>"],
    ["pointer dead", "pointer_and_keys_move_gaze_and_line", "gaze.js", 'stage.addEventListener("pointermove", follow);', ""],
    ["arrow keys dead", "pointer_and_keys_move_gaze_and_line", "gaze.js", "if (!arrow) return;", "return;"],
    ["bracket keys dead", "pointer_and_keys_move_gaze_and_line", "main.js", 'if (key !== "[" && key !== "]") return;', "return;"],
    ["divider dead", "pointer_and_keys_move_gaze_and_line", "main.js", '(number("divider") / 100) * size[0]', "0.5 * size[0]"],
    ["divider not in the picture", "pointer_and_keys_move_gaze_and_line", "style.css", "pointer-events: auto;", ""],
    ["gaze follows the dragged line", "pointer_and_keys_move_gaze_and_line", "gaze.js", "if (event.target !== canvas && event.buttons !== 0) return;", ""],
    ["divider from right to left", "pointer_and_keys_move_gaze_and_line", "index.html", '<main id="stage" dir="ltr">', '<main id="stage">'],
    ["scanpath stays on the right", "the_scanpath_is_fair_and_goes_on", "gaze.js", "v / 1000", "0.5 + v / 2000"],
    ["scanpath never resumes", "the_scanpath_is_fair_and_goes_on", "gaze.js", "const IDLE_MS = 5000;", "const IDLE_MS = Infinity;"],
    ["a recorded path", "the_scanpath_is_fair_and_goes_on", "index.html", "a synthetic path", "a recorded path"],
    ["scene by the clock", "a_slow_device_moves_by_frames", "main.js", "Math.min((now - before) / 1000, LONGEST_STEP_S)", "(now - before) / 1000"],
    ["scene without antialiasing", "a_slow_device_moves_by_frames", "afterimage_web_bg.wasm", "const RAYS:u32=4u", "const RAYS:u32=1u"],
    ["clicks queue", "choices_are_kept_and_do_not_queue", "main.js", "    changed = { ...changed, ...what };", "    jobs.push(() => apply(what));"],
    ["address not written", "choices_are_kept_and_do_not_queue", "address.js", "history.replaceState(", "(() => {})("],
    ["address not read", "choices_are_kept_and_do_not_queue", "main.js", "        read_address();", ""],
    ["comparison forgets", "comparing_keeps_history", "main.js", "        await show_scene(twin, compared_size);", "        configure(demo);\n        await show_scene(twin, compared_size);"],
    ["upload dead", "a_picture_of_ones_own", "main.js", 'take_picture($("own").files[0]);', ""],
    ["drop dead", "a_picture_of_ones_own", "main.js", "event.dataTransfer.files", "[]"],
    ["paste dead", "a_picture_of_ones_own", "main.js", "event.clipboardData.files", "[]"],
    ["own picture cut", "a_picture_of_ones_own", "main.js", "return letterboxed(own_picture, size);", "return filling(own_picture, size);"],
    ["transparent is black", "a_picture_of_ones_own", "pictures.js", 'surface.fillStyle = "#fff";', 'surface.fillStyle = "#000";'],
    ["refusals silent", "a_picture_of_ones_own", "main.js", '$("notice").textContent = text;', ""],
    ["Try again dead", "a_lost_device_is_replaced", "main.js", "location.reload()", "{}"],
    ["loading moves the button", "a_lost_device_is_replaced", "style.css", "    aspect-ratio: 16/9;\n", ""],
    ["raw error as reason", "a_lost_device_is_replaced", "trouble.js", '$("raw").hidden = !raw;', '$("reason").textContent = raw;\n    $("raw").hidden = !raw;'],
    ["no recording", "without_webgpu_there_is_a_recording", "trouble.js", '$("clip").src = "clip.webm";', ""],
    ["nothing without JavaScript", "without_javascript_there_is_a_picture", "index.html", '<img src="card.jpg"', "<img"],
    ["resize dead", "frames_follow_window_and_speed", "main.js", ").observe(stage);", ");"],
    ["screen's density ignored", "frames_follow_window_and_speed", "main.js", "side * devicePixelRatio", "side"],
    ["speed ignored", "frames_follow_window_and_speed", "main.js", "tried % TRIED_FRAMES === 0", "false"],
    ["full screen dead", "full_screen", "main.js", "else stage.requestFullscreen();", ""],
    ["choices below the screen", "ten_seconds", "style.css", "    height: 100vh;\n    height: 100dvh;", "    height: 130vh;"],
    ["an unneeded file", "the_first_picture_is_light", "main.js", 'import init, { Demo } from "./afterimage_web.js";', 'import init, { Demo } from "./afterimage_web.js";\nimport "./compare.js";\nfetch("courtyard.jpg");'],
    ["reduced motion ignored", "nothing_moves_for_those_who_want_that", "main.js", "gaze.advance(is_still.matches ? 0 : clock_s);", "gaze.advance(clock_s);"],
].filter(([name]) => name.includes(part));

let caught = 0;
for (const [name, test, file, right, wrong] of MUTANTS) {
    const folder = mkdtempSync(join(tmpdir(), "mutant-"));
    cpSync(built, folder, { recursive: true });
    // Bytes of the library stay what they are in this encoding.
    const text = readFileSync(join(folder, file), "latin1");
    const [from, to] = [right, wrong].map((words) => Buffer.from(words).toString("latin1"));
    const is_library = file.endsWith(".wasm");
    if (!text.includes(from) || (is_library && from.length !== to.length)) throw new Error(`${name}: cannot be applied to ${file}`);
    const bytes = Buffer.from(text.replaceAll(from, () => to), "latin1");
    writeFileSync(join(folder, file), bytes);
    writeFileSync(join(folder, `${file}.gz`), gzipSync(bytes, { level: 9 }));
    const { status, stdout } = spawnSync("node", [join(here, "test.mjs"), folder, test], { encoding: "utf8", timeout: 300_000 });
    rmSync(folder, { recursive: true });
    const words = stdout.match(/^FAILED .*/m)?.[0].slice(7);
    // A test that ends by an error has caught nothing that it names.
    const is_caught = status !== 0 && words !== undefined;
    caught += is_caught ? 1 : 0;
    console.log(`${is_caught ? "caught    " : "NOT CAUGHT"} ${name}: ${words ?? `status ${status}`}`);
}
console.log(`${caught} of ${MUTANTS.length} mutants are caught`);
if (caught < MUTANTS.length) process.exit(1);
