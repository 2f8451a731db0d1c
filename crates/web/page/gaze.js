// Where the gaze is: at the pointer, where the arrow keys move it, and on a synthetic scanpath while nobody does
// either.

const SCANPATH_HZ = 25;
// After this time without pointer and keys the scanpath goes on.
const IDLE_MS = 5000;
// What an arrow key moves the gaze by, as a share of the picture's height.
const KEY_STEP = 0.02;
const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

export class Gaze {
    #scanpath = [];
    #stage;
    #taken_ms = -Infinity;
    // Shares of the picture.
    at = [0.5, 0.5];

    constructor(stage, canvas) {
        this.#stage = stage;
        const follow = (event) => {
            // Not while the divider is dragged.
            if (event.target !== canvas && event.buttons !== 0) return;
            const box = canvas.getBoundingClientRect();
            this.#take([(event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height]);
        };
        stage.addEventListener("pointermove", follow);
        stage.addEventListener("pointerdown", follow);
        canvas.addEventListener("keydown", (event) => {
            const arrow = ARROWS[event.key];
            if (!arrow) return;
            const step = [(KEY_STEP * canvas.clientHeight) / canvas.clientWidth, KEY_STEP];
            this.#take([0, 1].map((i) => Math.min(Math.max(this.at[i] + arrow[i] * step[i], 0), 1)));
            event.preventDefault();
        });
    }

    get scanpath() {
        return this.#scanpath;
    }

    async load() {
        const text = await (await fetch("scanpath.csv")).text();
        const rows = text.split("\n").filter((line) => /^-?\d/.test(line));
        this.#scanpath = rows.map((line) => line.split(",").map((v) => v / 1000));
    }

    // To be called before a frame.
    advance(seconds) {
        const is_taken = performance.now() - this.#taken_ms < IDLE_MS;
        this.#stage.classList.toggle("is-taken", is_taken);
        if (!is_taken) this.at = this.#scanpath[Math.floor(seconds * SCANPATH_HZ) % this.#scanpath.length];
    }

    #take(at) {
        this.#taken_ms = performance.now();
        this.at = at;
    }
}
