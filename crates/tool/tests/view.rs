//! The viewer on a virtual display: moving pointer, keys, resized, minimized and restored window, lost device. Its
//! pictures are compared with those of `run` on the same gaze path.

use std::fs::{self, File};
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

const TOOL: &str = env!("CARGO_BIN_EXE_afterimage");
/// Timeout for the display and the viewer.
const PATIENCE: Duration = Duration::from_secs(60);
const SIZE: [u32; 2] = [320, 180];

/// The tool, on the adapter that the tests take.
fn tool() -> Command {
    let mut tool = Command::new(TOOL);
    tool.envs(afterimage_testing::gpu::choice());
    tool
}

/// Not eprintln!, which the test harness captures: skips must be visible in a passing run.
fn say(line: &str) {
    let _ = writeln!(std::io::stderr().lock(), "{line}");
}

/// A child process that is killed at the end of the test.
struct Running(Child);

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// A virtual display with a window manager that can minimize windows.
struct Display {
    name: String,
    _server: Running,
    manager: Running,
}

impl Display {
    /// Starts it. Prints a line and returns `None` if a program is missing.
    fn open() -> Option<Self> {
        let missing: Vec<_> = ["Xvfb", "xdotool", "openbox"].into_iter().filter(|program| !is_there(program)).collect();
        if !missing.is_empty() {
            say(&format!("SKIPPED the viewer's window: no {} (Debian: xvfb xdotool openbox)", missing.join(", ")));
            return None;
        }
        let mut server = Command::new("Xvfb")
            .args(["-displayfd", "1", "-screen", "0", "1600x1000x24", "-nolisten", "tcp"])
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let mut number = String::new();
        BufReader::new(server.stdout.take().unwrap()).read_line(&mut number).unwrap();
        let (name, server) = (format!(":{}", number.trim()), Running(server));
        let start =
            |name: &str| Running(Command::new("openbox").env("DISPLAY", name).stderr(Stdio::null()).spawn().unwrap());
        let manager = start(&name);
        let mut display = Self { name, _server: server, manager };
        // The window manager may ignore a window that opens while it starts, and ends if it finds the display too
        // early.
        wait_for("the window manager", || {
            if display.manager.0.try_wait().unwrap().is_some() {
                display.manager = start(&display.name);
            }
            display.xdotool(&["get_num_desktops"]).status.success().then_some(())
        });
        Some(display)
    }

    /// What the tool says, which has to succeed.
    fn tool(&self, folder: &Path, words: &[&str]) -> String {
        let out = tool().args(words).current_dir(folder).env("DISPLAY", &self.name).output().unwrap();
        assert!(out.status.success(), "{}", String::from_utf8_lossy(&out.stderr));
        String::from_utf8(out.stdout).unwrap()
    }

    fn xdotool(&self, words: &[&str]) -> Output {
        Command::new("xdotool").args(words).env("DISPLAY", &self.name).output().unwrap()
    }
}

fn is_there(program: &str) -> bool {
    let folders = std::env::var_os("PATH").unwrap_or_default();
    std::env::split_paths(&folders).any(|folder| folder.join(program).is_file())
}

/// Polls until the function returns a value.
#[track_caller]
fn wait_for<T>(what: &str, mut look: impl FnMut() -> Option<T>) -> T {
    let begun = Instant::now();
    loop {
        if let Some(found) = look() {
            return found;
        }
        assert!(begun.elapsed() < PATIENCE, "waited in vain for {what}");
        pause(50);
    }
}

fn pause(ms: u64) {
    std::thread::sleep(Duration::from_millis(ms));
}

/// A running viewer, its window, and its output.
struct Viewer<'a> {
    display: &'a Display,
    folder: PathBuf,
    child: Running,
    window: String,
    /// Number of pictures that it reported so far.
    pictures: usize,
}

impl<'a> Viewer<'a> {
    fn open(display: &'a Display, folder: &Path, words: &[&str]) -> Self {
        let file = |name| File::create(folder.join(name)).unwrap();
        let mut child = tool()
            .args(["view", "still.png", "--internal-scale", "1", "--record", "gaze.csv", "--screenshot", "shown.png"])
            .args(words)
            .current_dir(folder)
            .env("DISPLAY", &display.name)
            .env_remove("WAYLAND_DISPLAY")
            // Silences a message of a Mesa layer about Wayland.
            .env("NODEVICE_SELECT", "1")
            .stdout(file("said.txt"))
            .stderr(file("complaints.txt"))
            .spawn()
            .unwrap();
        let window = wait_for("the window", || {
            if let Some(status) = child.try_wait().unwrap() {
                let complaints = fs::read_to_string(folder.join("complaints.txt")).unwrap();
                panic!("the viewer ended before its window opened, {status}: {complaints}");
            }
            let found = display.xdotool(&["search", "--onlyvisible", "--name", "^afterimage: "]);
            String::from_utf8(found.stdout).unwrap().lines().next().map(str::to_owned)
        });
        let mut viewer = Self { display, folder: folder.to_owned(), child: Running(child), window, pictures: 0 };
        viewer.activate();
        // The first picture shows that frames are drawn.
        viewer.picture();
        viewer
    }

    fn activate(&self) {
        wait_for("the window's focus", || {
            self.display.xdotool(&["windowactivate", &self.window]);
            pause(100);
            let active = String::from_utf8(self.display.xdotool(&["getactivewindow"]).stdout).unwrap();
            (active.trim() == self.window).then_some(())
        });
    }

    /// Minimizes the window. Repeats the request, since window managers may ignore the first.
    fn minimise(&self) {
        wait_for("the window to be gone", || {
            self.display.xdotool(&["windowminimize", &self.window]);
            pause(200);
            let seen = self.display.xdotool(&["search", "--onlyvisible", "--name", "^afterimage: "]);
            seen.stdout.is_empty().then_some(())
        });
        pause(300);
    }

    fn key(&self, key: &str) {
        self.display.xdotool(&["key", key]);
        pause(80);
    }

    /// Presses keys one after another.
    fn keys(&self, keys: &str) {
        self.display.xdotool(&["key", "--delay", "30"].into_iter().chain(keys.split(' ')).collect::<Vec<_>>());
        pause(300);
    }

    /// Moves the pointer along points, given as fractions of the window.
    fn look_along(&self, points: &[[f32; 2]]) {
        let [width, height] = self.numbers(&["getwindowgeometry", "--shell", &self.window], ["WIDTH=", "HEIGHT="]);
        for [x, y] in points {
            let at = [x * width as f32, y * height as f32].map(|v| format!("{v:.0}"));
            self.display.xdotool(&["mousemove", "--window", &self.window, &at[0], &at[1]]);
            pause(60);
        }
    }

    /// Moves the pointer from the center of the window by some pixels and presses F12 at once. The next frame, whose
    /// picture is saved, must use the new gaze. (Relative moves take the same path as keys, which preserves their
    /// order.)
    fn looks_in_the_next_frame(&mut self, by_px: [i32; 2]) {
        self.look_along(&[[0.5, 0.5]]);
        let middle = self.pointer();
        let [x, y] = by_px.map(|v| v.to_string());
        self.display.xdotool(&["mousemove_relative", "--", &x, &y, "key", "F12"]);
        wait_for("a picture", || (self.said() > self.pictures).then_some(()));
        self.pictures = self.said();
        let record = self.record();
        let last: Vec<f32> = record.last().unwrap().split(',').skip(1).take(2).map(|v| v.parse().unwrap()).collect();
        let now = self.pointer();
        assert_ne!(middle, now);
        // Four window pixels per picture pixel.
        let expected = [0, 1].map(|i| (2 * SIZE[i] as i32 + now[i] - middle[i]) as f32 / 4.0);
        assert_eq!(last, expected, "the picture after a move is for an earlier gaze");
    }

    /// Position of the pointer on the screen.
    fn pointer(&self) -> [i32; 2] {
        self.numbers(&["getmouselocation", "--shell"], ["X=", "Y="])
    }

    /// Two numbers from the output of xdotool.
    fn numbers(&self, words: &[&str], names: [&str; 2]) -> [i32; 2] {
        let said = String::from_utf8(self.display.xdotool(words).stdout).unwrap();
        names.map(|name| said.lines().find_map(|line| line.strip_prefix(name)?.parse().ok()).unwrap())
    }

    /// Rows of the gaze record.
    fn record(&self) -> Vec<String> {
        let record = fs::read_to_string(self.folder.join("gaze.csv")).unwrap();
        record.lines().filter(|l| !l.starts_with('#')).skip(1).map(str::to_owned).collect()
    }

    fn said(&self) -> usize {
        fs::read_to_string(self.folder.join("said.txt")).unwrap().lines().count()
    }

    fn complaints(&self) -> String {
        fs::read_to_string(self.folder.join("complaints.txt")).unwrap()
    }

    /// Saves a picture; returns the number of frames since the last history reset.
    fn picture(&mut self) -> usize {
        wait_for("a picture", || {
            self.key("F12");
            let complaints = self.complaints();
            (0..20).find_map(|_| {
                pause(50);
                assert!(!complaints.contains("the device says"), "{complaints}");
                (self.said() > self.pictures).then_some(())
            })
        });
        // Let repeated key presses finish before the next key.
        pause(500);
        self.pictures = self.said();
        self.record().len()
    }

    /// Checks that the picture equals that of `run` with the recorded gaze.
    fn is_as_of_run(&mut self, method: &str) {
        let frames = self.picture();
        let run = "run still.png --gaze gaze.csv --backend gpu --no-flip --no-jod --out run --method";
        let count = frames.to_string();
        let words: Vec<&str> = run.split(' ').chain([method, "--frames", &count]).collect();
        self.display.tool(&self.folder, &words);
        let pixels = |path: PathBuf| image::open(path).unwrap().into_rgb8();
        let shown = pixels(self.folder.join("shown.png"));
        let expected = pixels(self.folder.join(format!("run/{method}/{:06}.png", frames - 1)));
        let differ = shown.pixels().zip(expected.pixels()).filter(|(a, b)| a != b).count();
        say(&format!(
            "{method}: after {frames} frames {differ} of {} pixels differ from those of run",
            shown.len() / 3
        ));
        assert_eq!((shown.dimensions(), differ), (expected.dimensions(), 0), "{method}");
    }

    /// Freezes the picture, and follows the command for the pixel at a quarter of its width and half of its height: the
    /// frame is the picture.
    fn explains_the_pixel(&mut self) {
        self.look_along(&[[0.25, 0.5]]);
        self.key("space");
        self.picture();
        let [x, y] = [SIZE[0] / 4, SIZE[1] / 2];
        self.key("x");
        wait_for("a command", || (self.said() > self.pictures).then_some(()));
        self.pictures = self.said();
        let said = fs::read_to_string(self.folder.join("said.txt")).unwrap();
        let command = said.lines().last().unwrap();
        say(command);
        let (words, frame) = (command.strip_prefix("afterimage ").unwrap(), self.record().len() - 1);
        assert!(words.contains(&format!("--pixel {x},{y} --pixel-frames {frame}..{frame} ")), "{command}");
        let said = self.display.tool(&self.folder, &words.split(' ').collect::<Vec<_>>());
        assert!(said.contains(&format!("frame {frame}, pixel {x},{y}, wrs")));
        let pixels = |path: &str| image::open(self.folder.join(path)).unwrap().into_rgb8();
        let (shown, repeated) = (pixels("shown.png"), pixels(&format!("out/pixel/wrs/{frame:06}.png")));
        assert!(shown == repeated, "the command shows another picture");
        self.key("space");
    }

    /// Quits by key; checks that stderr contains the `expected` lines only.
    fn close(mut self, expected: &[&str]) {
        self.key("Escape");
        let status = wait_for("the end", || self.child.0.try_wait().unwrap());
        let complaints = self.complaints();
        let lines: Vec<&str> = complaints.lines().collect();
        assert!(status.success() && lines == expected, "{status}: {complaints}");
    }
}

/// Stripes and blocks with structure at every level of detail.
fn write_still(folder: &Path) {
    let picture = image::RgbImage::from_fn(SIZE[0], SIZE[1], |x, y| {
        let hash = (x / 3 * 7 + y / 2 * 13 + (x / 20) * (y / 15) * 31) % 97;
        image::Rgb([(hash * 2 + 40) as u8, (255 - hash * 2) as u8, ((x * y / 64) % 200) as u8])
    });
    picture.save(folder.join("still.png")).unwrap();
}

#[test]
fn a_window_shows_what_run_writes_whatever_happens_to_it() {
    let Some(display) = Display::open() else { return };
    let folder = tempfile::tempdir().unwrap();
    write_still(folder.path());
    let mut viewer = Viewer::open(&display, folder.path(), &["--method", "wrs", "--no-panel"]);
    viewer.look_along(&[[0.2, 0.3], [0.4, 0.6], [0.8, 0.5], [0.6, 0.2], [0.3, 0.8]]);
    viewer.is_as_of_run("wrs");
    viewer.explains_the_pixel();

    for by in [[-440, -260], [90, -200]] {
        viewer.looks_in_the_next_frame(by);
    }

    // Toggle methods, debug views, filters, split and panel, and back.
    viewer.keys("1 2 5 shift+2 v v f f f f f minus equal h h g g v v v v v Tab 4");
    viewer.look_along(&[[0.7, 0.7], [0.2, 0.5]]);
    viewer.is_as_of_run("smr");

    // Changes of the window reset the history: the record begins at the pointer's position at that time, not at an
    // earlier one.
    let before = viewer.record()[0].clone();
    viewer.display.xdotool(&["windowsize", "--sync", &viewer.window, "900", "620"]);
    pause(300);
    viewer.is_as_of_run("smr");
    let resized = viewer.record()[0].clone();
    viewer.look_along(&[[0.5, 0.3], [0.8, 0.4], [0.6, 0.6]]);
    viewer.is_as_of_run("smr");
    let later = viewer.record()[0].clone();
    viewer.minimise();
    viewer.activate();
    viewer.is_as_of_run("smr");
    let restored = viewer.record()[0].clone();
    let gaze = |row: &String| row.split_once(',').unwrap().1.to_owned();
    assert_ne!(gaze(&before), gaze(&resized), "the record goes on after a resize");
    assert_eq!(later, resized, "the record goes on where nothing happens");
    assert_ne!(gaze(&later), gaze(&restored), "the record goes on after the window was minimised");

    viewer.look_along(&[[0.3, 0.3], [0.7, 0.3]]);
    viewer.key("ctrl+shift+l");
    viewer.look_along(&[[0.5, 0.5], [0.4, 0.4]]);
    viewer.is_as_of_run("smr");
    viewer.close(&["afterimage: the device is lost; opening another"]);
}

/// Scenes are rendered on the window's device, with their quad views below each other; `run` renders them in place,
/// whose pixels differ by rounding.
#[test]
fn a_scene_is_rendered_foveated_for_the_gaze_and_nothing_is_read_back() {
    let Some(display) = Display::open() else { return };
    let folder = tempfile::tempdir().unwrap();
    let tool = |words: &[&str]| display.tool(folder.path(), words);
    let pixels = |path: &str| image::open(folder.path().join(path)).unwrap().into_rgb8();
    for (foveation, jitter, methods) in [("planned", "halton", "taau,smr"), ("layers", "off", "none,smr")] {
        let scene = ["builtin:cubes", "--size", "320x180", "--camera", "walk", "--frames", "4"];
        let regions = ["--foveation", foveation, "--fovea", "12", "--mid", "30", "--rate-mid", "2", "--rate-far", "4"];
        let common = [&scene[..], &regions, &["--jitter", jitter]].concat();
        let view = ["view", "--internal-scale", "1", "--split", methods, "--screenshot", "shown.png"];
        let said = tool(&[&view[..], &common, &["--gaze", "200,60"]].concat());
        assert!(said.starts_with("4 frames, 0 read back\n"), "{said}");
        let run = "run --source raster --backend gpu --reference-samples 1 --no-flip --no-jod --out run --method";
        let run: Vec<&str> = run.split(' ').chain([methods]).collect();
        let geometry: &[&str] = if foveation == "planned" { &[] } else { &["--geometry", "samples"] };
        let psnr_db = |gaze: &str| {
            tool(&[&run[..], &common, geometry, &["--gaze", gaze]].concat());
            let (left, right) = methods.split_once(',').unwrap();
            let (shown, sides) = (pixels("shown.png"), [left, right].map(|m| pixels(&format!("run/{m}/000003.png"))));
            let error = |(x, y, p): (u32, u32, &image::Rgb<u8>)| {
                let expected = sides[usize::from(x >= SIZE[0] / 2)].get_pixel(x, y);
                (0..3).map(|i| (f64::from(p[i]) - f64::from(expected[i])).powi(2)).sum::<f64>() / 3.0
            };
            let mean = shown.enumerate_pixels().map(error).sum::<f64>() / f64::from(SIZE[0] * SIZE[1]);
            10.0 * (255.0 * 255.0 / mean).log10()
        };
        let same = psnr_db("200,60");
        say(&format!("{foveation}, jitter {jitter}, {methods}: {same:.1} dB of run's pictures"));
        assert!(same > 45.0);
        if foveation == "planned" {
            // Planted: another gaze.
            let planted = psnr_db("120,110");
            say(&format!("for another gaze {planted:.1} dB"));
            assert!(planted < 45.0);
        }
    }
}

#[test]
fn what_is_shown_has_a_running_jod() {
    let Some(display) = Display::open() else { return };
    let view = |words: &[&str]| {
        let common = "view analytic:lateral --size 320x180 --internal-scale 1 --gaze synthetic:3 --frames 30";
        display.tool(Path::new("."), &[&common.split(' ').collect::<Vec<_>>()[..], words].concat())
    };
    // The JOD of a method, as it is said at the end.
    let jod = |said: &str, name: &str| -> f64 {
        let (_, after) = said.split_once(&format!("{name} ")).unwrap_or_else(|| panic!("no {name} in {said}"));
        after[..after.find([',', ' ']).unwrap()].parse().unwrap()
    };
    let full_rate = view(&["--foveation", "off", "--split", "none,reference"]);
    say(&full_rate);
    assert_eq!([jod(&full_rate, "none"), jod(&full_rate, "reference")], [10.0; 2]);
    let foveated = view(&["--foveation", "mip", "--fovea", "8", "--split", "reference,none"]);
    say(&foveated);
    assert_eq!(jod(&foveated, "reference"), 10.0);
    assert!((0.0..9.9).contains(&jod(&foveated, "none")), "{foveated}");
    assert_eq!(view(&["--no-panel"]), "30 frames, 0 read back\n", "only the panel asks for it");
}

#[test]
fn without_a_display_it_says_so_in_one_line() {
    let folder = tempfile::tempdir().unwrap();
    write_still(folder.path());
    for display in [None, Some(":4099")] {
        let mut tool = self::tool();
        tool.args(["view", "still.png"]).current_dir(folder.path());
        tool.env_remove("WAYLAND_DISPLAY").env_remove("WAYLAND_SOCKET").env_remove("DISPLAY");
        let out = tool.envs(display.map(|d| ("DISPLAY", d))).output().unwrap();
        let text = String::from_utf8(out.stderr).unwrap();
        assert_eq!((out.status.code(), text.lines().count()), (Some(1), 1), "{text}");
        assert!(text.contains("there is no display"), "{text}");
    }
}

#[test]
fn what_it_cannot_show_is_refused_before_any_window() {
    let folder = tempfile::tempdir().unwrap();
    write_still(folder.path());
    let refused: [(&[&str], &str); 8] = [
        (&["none.png"], "does not exist"),
        (&["still.png", "--split", "smr"], "expected two"),
        (&["still.png", "--split", "smr,oracle"], "oracle"),
        (&["still.png", "--internal-scale", "2"], "at most 1"),
        (&["still.png", "--fovea=-1"], "fovea"),
        (&["still.png", "--gaze", "none.csv"], "none.csv"),
        (&["analytic:still", "--jitter", "halton"], "of scenes only"),
        (&["builtin:courtyard", "--foveation", "mip", "--jitter", "halton"], "--foveation planned"),
    ];
    for (words, expected) in refused {
        let out = tool().arg("view").args(words).current_dir(folder.path()).output().unwrap();
        let text = String::from_utf8(out.stderr).unwrap();
        assert_eq!((out.status.code(), text.lines().count()), (Some(2), 1), "{words:?}: {text}");
        assert!(text.contains(expected), "{words:?}: {text}");
    }
}
