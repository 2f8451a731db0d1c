//! Frames of other renderers: each layout of docs/renderers.md, written small and read with the page's options.

use super::rig::{Folder, refuses, succeeds, tool, words};
use afterimage::Image;
use afterimage_lab::source::exr_file::write_channels;
use afterimage_lab::source::{ChannelNames, FrameSource, ReadLimits, SequenceSource};
use std::fs;
use std::path::Path;

const SIZE: [u32; 2] = [96, 60];
const FRAMES: u32 = 3;
/// What the picture moves by in a frame, pixels, y down.
const MOVED_PX: [f32; 2] = [4.0, 2.0];
const QUICK: &str = "--foveation off --method none --backend cpu --no-jod --no-flip --gaze 8,4";

/// A frame: its files, by name with `#` for the number, and in each its channels, by name and in these terms.
type Layout = &'static [(&'static str, &'static [(&'static str, Value)])];

/// What a channel holds.
#[derive(Clone, Copy)]
enum Value {
    /// A channel of the picture.
    Color(usize),
    /// This, of the distance along the view axis in meters.
    Depth(fn(f32) -> f32),
    /// This number.
    Number(f32),
}

use Value::{Color, Depth, Number};

const W: f32 = SIZE[0] as f32;
const H: f32 = SIZE[1] as f32;
const DX: f32 = MOVED_PX[0];
const DY: f32 = MOVED_PX[1];

struct Row {
    /// As in the page's table.
    renderer: &'static str,
    layout: Layout,
    /// Options of the page that read it; none where its names tell all.
    options: &'static str,
    /// Whether it has vectors to the next frame.
    has_next: bool,
}

const fn row(renderer: &'static str, layout: Layout, options: &'static str) -> Row {
    Row { renderer, layout, options, has_next: false }
}

const R: (&str, Value) = ("R", Color(0));
const G: (&str, Value) = ("G", Color(1));
const B: (&str, Value) = ("B", Color(2));
const Z: (&str, Value) = ("Z", Depth(|d| d));

/// Movie Render Queue: 0.5 is no motion; 1, one width or two half heights of motion from the previous frame, y up.
const UNREAL_X: Value = Number(0.5 + 0.5 * DX / W);
const UNREAL_Y: Value = Number(0.5 - 0.5 * DY / H);
const CENTIMETERS: Value = Depth(|d| 100.0 * d);

const ROWS: [Row; 14] = [
    Row {
        has_next: true,
        ..row(
            "Blender",
            &[(
                "f_#.exr",
                &[
                    ("ViewLayer.Combined.R", Color(0)),
                    ("ViewLayer.Combined.G", Color(1)),
                    ("ViewLayer.Combined.B", Color(2)),
                    ("ViewLayer.Depth.Z", Depth(|d| d)),
                    ("ViewLayer.Vector.X", Number(-DX)),
                    ("ViewLayer.Vector.Y", Number(DY)),
                    ("ViewLayer.Vector.Z", Number(-DX)),
                    ("ViewLayer.Vector.W", Number(DY)),
                ],
            )],
            "",
        )
    },
    row(
        "afterimage trace",
        &[
            ("color/#.exr", &[R, G, B]),
            ("depth/#.exr", &[Z]),
            ("motion/#.exr", &[("motion.X", Number(-DX)), ("motion.Y", Number(-DY))]),
        ],
        "",
    ),
    row(
        "Unreal, Movie Render Queue, one file",
        &[(
            "Shot.#.exr",
            &[
                R,
                G,
                B,
                ("FinalImageMovieRenderQueue_MotionVectors.R", UNREAL_X),
                ("FinalImageMovieRenderQueue_MotionVectors.G", UNREAL_Y),
                ("FinalImageMovieRenderQueue_MotionVectors.B", Number(0.0)),
                ("FinalImageMovieRenderQueue_WorldDepth.R", CENTIMETERS),
                ("FinalImageMovieRenderQueue_WorldDepth.G", CENTIMETERS),
                ("FinalImageMovieRenderQueue_WorldDepth.B", CENTIMETERS),
            ],
        )],
        "",
    ),
    row(
        "Unreal, Movie Render Queue, a file a pass",
        &[
            ("Shot.FinalImage.#.exr", &[R, G, B]),
            (
                "Shot.FinalImageMovieRenderQueue_MotionVectors.#.exr",
                &[("R", UNREAL_X), ("G", UNREAL_Y), ("B", Number(0.0))],
            ),
            (
                "Shot.FinalImageMovieRenderQueue_WorldDepth.#.exr",
                &[("R", CENTIMETERS), ("G", CENTIMETERS), ("B", CENTIMETERS)],
            ),
        ],
        "",
    ),
    row(
        "Unreal, Movie Render Queue, a folder a pass",
        &[
            ("FinalImage/Shot.#.exr", &[R, G, B]),
            (
                "FinalImageMovieRenderQueue_MotionVectors/Shot.#.exr",
                &[("R", UNREAL_X), ("G", UNREAL_Y), ("B", Number(0.0))],
            ),
            (
                "FinalImageMovieRenderQueue_WorldDepth/Shot.#.exr",
                &[("R", CENTIMETERS), ("G", CENTIMETERS), ("B", CENTIMETERS)],
            ),
        ],
        "",
    ),
    row(
        "Arnold",
        &[(
            "beauty.#.exr",
            &[
                R,
                G,
                B,
                Z,
                ("motionvector.R", Number(DX)),
                ("motionvector.G", Number(-DY)),
                ("motionvector.B", Number(0.0)),
            ],
        )],
        "",
    ),
    Row {
        has_next: true,
        ..row(
            "Nuke",
            &[(
                "comp.#.exr",
                &[
                    R,
                    G,
                    B,
                    ("depth.Z", Depth(|d| 1.0 / d)),
                    ("backward.u", Number(-DX)),
                    ("backward.v", Number(DY)),
                    ("forward.u", Number(DX)),
                    ("forward.v", Number(-DY)),
                ],
            )],
            "",
        )
    },
    row(
        "V-Ray",
        &[(
            "v_#.exr",
            &[R, G, B, Z, ("velocity.R", Number(DX)), ("velocity.G", Number(-DY)), ("velocity.B", Number(0.0))],
        )],
        "--motion velocity --motion-convention vray",
    ),
    row(
        "Unity Recorder",
        &[
            ("movie_Beauty_#.exr", &[R, G, B]),
            ("movie_MotionVectors_#.exr", &[("R", Number(DX / W)), ("G", Number(DY / H)), ("B", Number(0.0))]),
        ],
        "--motion motionvectors --motion-convention unity",
    ),
    row(
        "Karma",
        &[("k.#.exr", &[R, G, B, Z, ("mv.R", Number(DX / W)), ("mv.G", Number(-DY / H))])],
        "--motion mv --motion-convention karma",
    ),
    row(
        "MoonRay",
        &[(
            "m.#.exr",
            &[R, G, B, Z, ("motion_vectors.R", Number(2.0 * DX / W)), ("motion_vectors.G", Number(-2.0 * DY / H))],
        )],
        "--motion motion_vectors --motion-convention ndc,from-previous,up",
    ),
    row(
        "vectors from 0 to 1",
        &[(
            "r.#.exr",
            &[
                R,
                G,
                B,
                Z,
                ("MotionVectors.R", Number(0.5 + 0.5 * DX / 64.0)),
                ("MotionVectors.G", Number(0.5 - 0.5 * DY / 64.0)),
            ],
        )],
        "--motion MotionVectors --motion-convention px,from-previous,up,centered,scale=64",
    ),
    row(
        "texture coordinates",
        &[("f_#.exr", &[R, G, B, Z, ("motion.X", Number(-DX / W)), ("motion.Y", Number(-DY / H))])],
        "--motion-convention uv,to-previous,down",
    ),
    row(
        "an engine's buffers",
        &[(
            "e_#.exr",
            &[
                R,
                G,
                B,
                ("buffers.depth", Depth(|d| 0.5 / d)),
                ("buffers.mx", Number(2.0 * DX / W)),
                ("buffers.my", Number(-2.0 * DY / H)),
            ],
        )],
        "--depth buffers.depth --motion buffers.mx,buffers.my --motion-convention ndc,from-previous,up \
          --depth-convention reversed,near=0.5",
    ),
];

/// Smooth waves that move.
fn picture(frame: u32) -> Image<[f32; 3]> {
    let shift = MOVED_PX.map(|moved| moved * frame as f32);
    Image::from_fn(SIZE, |[x, y]| {
        let (x, y) = (x as f32 - shift[0], y as f32 - shift[1]);
        [[0.31, 0.17], [0.11, -0.29], [-0.23, 0.37]]
            .map(|[kx, ky]: [f32; 2]| 0.5 + 0.2 * (kx * x + ky * y).sin() + 0.15 * (ky * x - kx * y + 1.0).sin())
    })
}

fn distance() -> Image<f32> {
    Image::from_fn(SIZE, |[x, y]| 2.0 + 0.125 * x as f32 + 0.5 * y as f32)
}

fn write(folder: &Path, layout: &[(&str, &[(&str, Value)])], frames: impl Iterator<Item = u32>) {
    for frame in frames {
        for (name, channels) in layout {
            let path = folder.join(name.replace('#', &format!("{frame:04}")));
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            let images: Vec<(&str, Image<f32>)> = channels
                .iter()
                .map(|(name, value)| {
                    (
                        *name,
                        match value {
                            Color(i) => picture(frame).map(|c| c[*i]),
                            Depth(stored) => distance().map(stored),
                            Number(number) => Image::filled(SIZE, *number),
                        },
                    )
                })
                .collect();
            write_channels(&path, &images.iter().map(|(name, image)| (*name, image)).collect::<Vec<_>>()).unwrap();
        }
    }
}

fn names(options: &str) -> ChannelNames {
    let words = words(options);
    let of = |option: &str| words.iter().position(|word| *word == option).map(|at| words[at + 1]);
    ChannelNames {
        depth: of("--depth").map(str::to_owned),
        motion: of("--motion").map(str::to_owned),
        motion_convention: of("--motion-convention").map(|text| text.parse().unwrap()),
        depth_convention: of("--depth-convention").map(|text| text.parse().unwrap()),
        ..ChannelNames::default()
    }
}

fn holds_everywhere<T: Copy + PartialEq + std::fmt::Debug>(image: &Image<T>, is_right: impl Fn([usize; 2], T) -> bool) {
    for (y, x) in (0..SIZE[1] as usize).flat_map(|y| (0..SIZE[0] as usize).map(move |x| (y, x))) {
        assert!(is_right([x, y], image.at(x, y)), "pixel {x},{y}: {:?}", image.at(x, y));
    }
}

/// Value, unit, direction and vertical axis of every layout.
#[test]
fn layouts_of_renderers_arrive_as_distances_and_pixels() {
    for Row { renderer, layout, options, has_next } in &ROWS {
        println!("{renderer}");
        let folder = Folder::new();
        write(&folder.path("in"), layout, 1..=FRAMES);
        let mut source =
            SequenceSource::open_named(&folder.path("in"), &ReadLimits::default(), &names(options)).unwrap();
        let frame = source.frame(1).unwrap();
        let near = |a: f32, b: f32| (a - b).abs() < 2e-4 * b.abs();
        let moved = |sign: f32| move |_: [usize; 2], m: [f32; 2]| near(m[0], sign * DX) && near(m[1], sign * DY);
        holds_everywhere(&frame.motion.unwrap(), moved(-1.0));
        let distance = distance();
        match frame.depth {
            Some(depth) => holds_everywhere(&depth, |[x, y], d| near(d, distance.at(x, y))),
            None => assert_eq!(*renderer, "Unity Recorder"),
        }
        let expected = picture(2);
        holds_everywhere(&frame.color, |[x, y], c| (0..3).all(|i| near(c[i], expected.at(x, y)[i])));
        match source.frame(u64::from(FRAMES)) {
            Ok(back) => holds_everywhere(&back.motion.unwrap(), moved(1.0)),
            Err(error) => assert!(!has_next && error.to_string().contains("to the next frame"), "{error}"),
        }
    }
}

/// `info` finds each convention without being told it, and the command that it prints reads the frames.
#[test]
fn info_prints_a_command_that_reads_each_layout() {
    for Row { renderer, layout, options, .. } in &ROWS {
        let folder = Folder::new();
        write(&folder.path("in"), layout, 1..=FRAMES);
        let input = folder.text("in");
        // Names that say nothing must be told; so must 0.5 for no motion, which looks like constant motion.
        let told = names(options);
        let mut given = vec!["info".to_owned(), input.clone()];
        let centered = told.motion_convention.filter(|reading| reading.is_centered);
        let mut tell =
            |option: &str, value: Option<String>| value.into_iter().for_each(|v| given.extend([option.into(), v]));
        tell("--motion", told.motion.clone());
        tell("--motion-convention", centered.map(|reading| reading.to_string()));
        tell("--depth", told.depth.clone());
        tell("--depth-convention", told.depth_convention.map(|reading| reading.to_string()));
        let text = succeeds(&given.iter().map(String::as_str).collect::<Vec<_>>());
        let line = text.lines().find_map(|line| line.strip_prefix("read it with: afterimage "));
        let command = line.unwrap_or_else(|| panic!("{renderer}: {text}"));
        let out = folder.text("out");
        let command = command.replace("--out out", &format!("--out {out} {QUICK}"));
        // Nuke's depth is read with a warning.
        let ran = tool(&words(&command));
        assert!(ran.status.success(), "{renderer}: {}", String::from_utf8_lossy(&ran.stderr));
        // Read so, the convention fits: nothing is wrong any more.
        let options = command.strip_prefix(&format!("run {input}")).unwrap().split("--out").next().unwrap();
        let again = succeeds(&[&["info", &input][..], &words(options)].concat());
        assert!(again.contains("motion convention: as read"), "{renderer}: {again}");
        assert!(!again.contains("MotionConvention") && !text.contains("MotionConvention"), "{renderer}: {text}");
        let expected = told.motion_convention.map(|reading| format!("--motion-convention {reading} "));
        assert!(expected.is_none_or(|expected| command.contains(&expected)), "{renderer}: {command}");
    }
}

#[test]
fn the_page_of_renderers_has_every_layout() {
    let page = fs::read_to_string(afterimage_testing::workspace().join("docs/renderers.md")).unwrap();
    for Row { renderer, options, .. } in &ROWS {
        let line = page.lines().find(|line| line.starts_with(&format!("| {renderer} |")));
        let line = line.unwrap_or_else(|| panic!("docs/renderers.md lacks {renderer}"));
        assert!(options.is_empty() || line.contains(options), "{renderer}: {line}");
    }
}

#[test]
fn names_that_are_not_there_are_refused_with_those_that_are() {
    let folder = Folder::new();
    write(&folder.path("in"), ROWS[7].layout, 1..=FRAMES);
    let input = folder.text("in");
    let out = folder.text("out");
    let has = "velocity.B, velocity.G, velocity.R";
    for (option, expected) in
        [("--motion", "a layer with X/Y"), ("--color", "R/G/B"), ("--depth", "a channel or a layer")]
    {
        refuses(&["info", &input, option, "nothing"], &["has no nothing for the", has, expected, option]);
    }
    // The name does not tell the convention: the commands that find and give it.
    let run = ["run", &input, "--out", &out, "--frames", "1"];
    let find = format!("find it with afterimage info {input} --motion velocity");
    refuses(&run, &["velocity may be motion vectors", &find, "--motion velocity --motion-convention vray"]);
    assert!(!folder.path("out").exists());
    let text = succeeds(&["info", &input]);
    assert!(text.contains("the convention of velocity is not known; it is read as px,to-previous,down"), "{text}");
    assert!(text.contains("WRONG? px,from-previous,up fits"), "{text}");
    // Without any, the channels are listed.
    write(&folder.path("none"), &[("f_#.exr", &[R, G, B, Z])], 1..=FRAMES);
    refuses(
        &["info", &folder.text("none")],
        &["no motion vectors", "it has B, G, R, Z", "docs/renderers.md", "--motion"],
    );
    // Values that are none.
    for (option, value, expected) in [
        ("--motion-convention", "px,up", "UNIT,DIRECTION,YAXIS"),
        ("--motion-convention", "maya", "blender|unreal|unity|arnold|karma|vray|nuke"),
        ("--motion-convention", "px,to-previous,up,scale=0", "scale=0"),
        ("--depth-convention", "reversed", "needs near=D"),
        ("--depth-convention", "view,near=1", "has no planes"),
        ("--depth-convention", "forward,near=2,far=1", "near 2, far 1"),
    ] {
        refuses(&["info", &input, option, value], &[option, expected]);
    }
    for input in ["builtin:cornell", "analytic:still"] {
        refuses(&["info", input, "--motion", "x"], &["--motion", "has no channels"]);
        refuses(&["run", input, "--out", &out, "--motion", "x"], &["--motion", "has no channels"]);
    }
}

#[test]
fn passes_that_do_not_fit_together_are_refused_in_one_line() {
    let passes = ROWS[3].layout;
    let folder = Folder::new();
    write(&folder.path("in"), passes, 1..=FRAMES);
    let input = folder.text("in");
    fs::remove_file(folder.path("in/Shot.FinalImageMovieRenderQueue_MotionVectors.0002.exr")).unwrap();
    let pass = "lacks the pass finalimagemovierenderqueue_motionvectors";
    refuses(&["info", &input], &["frame 2 has the pass finalimage ", pass, "add the missing file"]);
    // A pass that is not read may lack frames.
    write(&folder.path("in"), passes, 2..=2);
    write(&folder.path("in"), &[("Shot.Normals.#.exr", &[("N.X", Number(0.0)), ("N.Y", Number(0.0))])], 1..=1);
    assert!(succeeds(&["info", &input]).contains("motion convention: as read"));
    // Two whole sequences are no passes.
    write(&folder.path("two"), &[("a_#.exr", ROWS[5].layout[0].1), ("b_#.exr", ROWS[5].layout[0].1)], 1..=FRAMES);
    refuses(
        &["info", &folder.text("two")],
        &["holds two sequences: a_0001.exr and b_0001.exr", "one sequence in a folder"],
    );
    // Passes of another size.
    let small = Image::filled([8, 4], 0.0);
    for frame in 1..=FRAMES {
        write_channels(
            &folder.path(&format!("in/Shot.FinalImage.{frame:04}.exr")),
            &["R", "G", "B"].map(|c| (c, &small)),
        )
        .unwrap();
    }
    refuses(&["info", &input], &["parts of different sizes"]);
}

/// `info` says when it cannot tell.
#[test]
fn a_scene_at_rest_decides_no_convention() {
    let folder = Folder::new();
    let still: Layout = &[(
        "f_#.exr",
        &[("R", Number(0.5)), ("G", Number(0.5)), ("B", Number(0.5)), ("flow.X", Number(0.0)), ("flow.Y", Number(0.0))],
    )];
    write(&folder.path("in"), still, 1..=FRAMES);
    let output = tool(&["info", &folder.text("in")]);
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(output.status.success(), "{text}");
    assert!(text.contains("motion convention: not known, nothing moves") && !text.contains("read it with"), "{text}");
}
