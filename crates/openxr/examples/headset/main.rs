//! A room in a headset: quads around the gaze of either eye, objects in the hands, a page to read.
//!
//! `cargo run --release -p afterimage-openxr --example headset -- --help`

mod measure;
mod plant;
mod room;

use afterimage_eval::scanpath::{Scanpath, read_csv};
use afterimage_openxr::afterimage::internal::{Method, MethodKind, Settings, Smr};
use afterimage_openxr::{Error, Headset, HeadsetDesc, HeadsetFrame, openxr as xr};
use clap::Parser;
use glam::{Mat4, Quat, Vec3};
use plant::Plant;
use room::{Hands, Room};
use std::io::BufRead;
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

type Failure = Box<dyn std::error::Error>;

/// A room in a headset, shaded by quads around the gaze
///
/// While it runs, a line on standard input chooses: 1 antialiased smr, 2 taau, 3 nothing, 4 smr, q the end. The trigger
/// of a controller chooses the next of these.
///
/// Example: headset --gaze fixtures/scanpath_viewing.csv --dump 100 eyes.png
#[derive(Parser)]
struct Options {
    /// Frames to show, then the end; default: until the runtime or q ends it
    #[arg(long)]
    frames: Option<u64>,
    /// Seconds to run, then the end
    #[arg(long)]
    seconds: Option<u64>,
    /// Method at the start: antialias (smr with a jittered projection), smr, taau or none
    #[arg(long, default_value = "antialias")]
    method: String,
    /// Gaze of a recorded scanpath (CSV) where the runtime has no eye tracker; default: straight ahead
    #[arg(long, value_name = "FILE.csv")]
    gaze: Option<PathBuf>,
    /// Width and height of a view in pixels; default: what the runtime recommends
    #[arg(long, value_name = "PX")]
    side: Option<u32>,
    /// Write the picture of a frame: what is shown, the samples without memory, full rate; left and right eye
    #[arg(long, num_args = 2, value_names = ["FRAME", "PNG"])]
    dump: Option<Vec<String>>,
    /// Print the quality of every N-th frame, dB against full rate; slow
    #[arg(long, value_name = "N")]
    check: Option<u64>,
    /// Change the size of the views in this frame
    #[arg(long, num_args = 2, value_names = ["FRAME", "PX"])]
    resize: Option<Vec<u64>>,
    /// Do nothing for half a second in this frame, so that frames are dropped
    #[arg(long, value_name = "FRAME")]
    stall: Option<u64>,
    /// An error that tests must see
    #[arg(long, hide = true)]
    plant: Option<Plant>,
}

/// The trigger and the hands of both controllers.
struct Controls {
    trigger: xr::Action<bool>,
    grip: xr::Action<xr::Posef>,
    hands: [xr::Path; 2],
}

fn main() -> ExitCode {
    let (options, keys) = (Options::parse(), keys());
    let mut shown_frames = 0;
    loop {
        match show(&options, &keys, &mut shown_frames) {
            Ok(()) => {
                println!("{shown_frames} frames shown");
                return ExitCode::SUCCESS;
            }
            // A runtime that restarts.
            Err(error) if matches!(error.downcast_ref(), Some(Error::InstanceLost)) => println!("again: {error}"),
            Err(error) => {
                eprintln!("headset: {error}");
                return ExitCode::FAILURE;
            }
        }
    }
}

/// Shows frames on a headset until the end, and counts them.
fn show(options: &Options, keys: &Receiver<String>, shown_frames: &mut u64) -> Result<(), Failure> {
    let page = image::load_from_memory(include_bytes!("../../../../fixtures/text_page.png"))?.into_luma8();
    let (created, controls) = channel();
    let mut settings = Settings { method: method(&options.method)?, ..Settings::headset() };
    let mut desc = HeadsetDesc { size_px: options.side.map(|side| [side; 2]), ..HeadsetDesc::default() };
    if let Some(path) = &options.gaze {
        let path = read_csv(path)?;
        desc.gaze = Some(Box::new(move |seconds| direction(&path, seconds)));
    }
    desc.actions = Some(Box::new(move |instance| {
        let (set, controls) = Controls::new(instance)?;
        created.send(controls).ok();
        Ok(vec![set])
    }));
    let mut headset = Headset::new("headset", desc)?;
    // Other methods than smr are there for comparison.
    headset.set_settings(settings)?;
    let controls = controls.recv()?;
    println!("runtime: {}", headset.instance().properties()?.runtime_name);
    println!("eye tracker: {}", if headset.has_eye_tracker() { "yes" } else { "no" });
    println!("depth layer: {}", if headset.has_depth_layer() { "yes" } else { "no" });
    let mut size = headset.size_px();
    println!("views: {size:?} pixels each");
    let mut room = Room::new(headset.device(), headset.queue(), &page);
    for eye in 0..2 {
        let hidden = headset.hidden_mesh(eye).cloned();
        println!("eye {eye}: the lens hides {} triangles", hidden.as_ref().map_or(0, |mesh| mesh.indices.len() / 3));
        room.hide(headset.device(), eye, hidden.as_ref());
    }
    if let Some(plant) = options.plant {
        plant.before(&headset);
    }
    let mut measure = measure::Measure::new(headset.device(), headset.queue(), settings.foveation);
    let began = Instant::now();
    let mut hands_before: Option<Hands> = None;
    let mut is_over = false;
    while let Some(mut frame) = headset.next_frame()? {
        let hands = controls.hands(&mut frame)?;
        let pressed = controls.is_pressed(&frame)?;
        let moved = [hands, hands_before.unwrap_or(hands)];
        hands_before = Some(hands);
        if let Some(plant) = options.plant {
            plant.spoil(&mut frame);
        }
        let (eyes, reset) = (frame.eyes, frame.reset);
        let queue = frame.queue().clone();
        let (encoder, targets) = frame.encoder_and_targets();
        for (eye, views) in eyes.iter().zip(&targets.views) {
            room.prepass(&queue, encoder, views, eye, moved);
        }
        if options.plant != Some(Plant::Choice) {
            frame.choose()?;
        }
        let half = frame.halve()?;
        let (encoder, targets) = frame.encoder_and_targets();
        for (eye, views) in half.iter().flatten().zip(&targets.half_views) {
            room.half_colors(&queue, encoder, views, eye, moved);
        }
        for (i, eye) in eyes.iter().enumerate() {
            let depth_of = options.plant.map_or(i, |plant| plant.depth_of(i));
            room.colors(encoder, eye, &targets.views[i].color, &targets.views[depth_of].primed);
        }
        let shown = frame.submit()?;
        let index = shown.index;
        let dump =
            options.dump.as_ref().filter(|dump| dump[0].parse() == Ok(index)).map(|dump| PathBuf::from(&dump[1]));
        if dump.is_some() || options.check.is_some_and(|every| index.is_multiple_of(every)) {
            let found = measure.frame(&shown, &room, &eyes, moved)?;
            println!(
                "frame {index}: {reset:?}, shown {:.2} dB, without memory {:.2} dB, {:.1} % of the pixels shaded, gaze {:.0?}",
                found.shown_db,
                found.none_db,
                found.shaded_percent,
                eyes.map(|eye| eye.gaze_px)
            );
            if let Some(path) = dump {
                found.sheet.save(&path)?;
                println!("wrote {}", path.display());
            }
        }
        *shown_frames += 1;
        if options.stall == Some(index) {
            std::thread::sleep(Duration::from_millis(500));
        }
        if let Some(resize) = options.resize.as_ref().filter(|resize| resize[0] == index) {
            headset.resize([resize[1] as u32; 2])?;
        }
        if headset.size_px() != size {
            size = headset.size_px();
            println!("views: {size:?} pixels each, from frame {} on", index + 1);
        }
        let key = keys.try_recv().ok().or_else(|| pressed.then(|| "next".into()));
        if let Some(chosen) = key.filter(|key| {
            key != "q" || {
                is_over = true;
                false
            }
        }) {
            settings.method = chosen_by(&chosen, settings.method)?;
            headset.set_settings(settings)?;
            println!("method: {}", settings.method.kind().name());
        }
        is_over |= options.seconds.is_some_and(|seconds| began.elapsed().as_secs() >= seconds);
        if is_over || options.frames.is_some_and(|frames| *shown_frames >= frames) {
            headset.exit()?;
            is_over = true;
        }
    }
    Ok(())
}

fn method(name: &str) -> Result<Method, Failure> {
    match name {
        "smr" => Ok(MethodKind::Smr.into()),
        "taau" => Ok(MethodKind::Taau.into()),
        "none" => Ok(MethodKind::None.into()),
        "antialias" => Ok(Method::Smr(Smr { antialias: true, ..Smr::default() })),
        _ => Err(format!("--method {name}: expected antialias, smr, taau or none").into()),
    }
}

/// Method of a key; the next one after `now` for the trigger.
fn chosen_by(key: &str, now: Method) -> Result<Method, Failure> {
    let names = ["antialias", "taau", "none", "smr"];
    let name = match key {
        "1" => "antialias",
        "2" => "taau",
        "3" => "none",
        "4" => "smr",
        _ => {
            let is_now = |name: &&str| method(name).is_ok_and(|method| method == now);
            names[(names.iter().position(is_now).unwrap_or(0) + 1) % names.len()]
        }
    };
    method(name)
}

/// Lines of standard input.
fn keys() -> Receiver<String> {
    let (send, receive) = channel();
    std::thread::spawn(move || {
        for line in std::io::stdin().lock().lines().map_while(Result::ok) {
            if send.send(line.trim().to_owned()).is_err() {
                break;
            }
        }
    });
    receive
}

/// Direction of a recorded gaze in the head's space; from the start again after the end.
fn direction(path: &Scanpath, seconds: f64) -> Option<[f32; 3]> {
    let samples = path.samples();
    let at_s = samples[0].t_s + seconds.rem_euclid(path.duration_s().max(1e-3));
    let sample = &samples[samples.partition_point(|sample| sample.t_s <= at_s).max(1) - 1];
    let screen = path.screen();
    let ([x, y], [w, h]) = (sample.px?, screen.size_px.map(|n| n as f32));
    let ([w_cm, h_cm], distance_cm) = (screen.size_cm?, screen.distance_cm?);
    Some([(x / w - 0.5) * w_cm, (0.5 - y / h) * h_cm, -distance_cm])
}

impl Controls {
    fn new(instance: &xr::Instance) -> Result<(xr::ActionSet, Self), xr::sys::Result> {
        let set = instance.create_action_set("room", "Room", 0)?;
        let hands = [instance.string_to_path("/user/hand/left")?, instance.string_to_path("/user/hand/right")?];
        let trigger = set.create_action("trigger", "Next method", &hands)?;
        let grip = set.create_action("grip", "Hands", &hands)?;
        let profile = instance.string_to_path("/interaction_profiles/khr/simple_controller")?;
        let mut bindings = vec![];
        for hand in ["left", "right"] {
            let path = |input: &str| instance.string_to_path(&format!("/user/hand/{hand}/input/{input}"));
            bindings.push(xr::Binding::new(&trigger, path("select/click")?));
            bindings.push(xr::Binding::new(&grip, path("grip/pose")?));
        }
        instance.suggest_interaction_profile_bindings(profile, &bindings)?;
        Ok((set, Self { trigger, grip, hands }))
    }

    /// Poses of the hands; without controllers, they move by themselves.
    fn hands(&self, frame: &mut HeadsetFrame<'_>) -> Result<Hands, afterimage_openxr::Error> {
        let time_s = frame.time_s as f32;
        let mut hands = [-1.0, 1.0].map(|side| {
            let place = Vec3::new(0.2 * side + 0.05 * (1.3 * time_s + side).sin(), -0.15, -0.5);
            let turn = Quat::from_rotation_y(0.4 * (0.9 * time_s + side).sin());
            Mat4::from_rotation_translation(turn, place)
        });
        for (hand, path) in hands.iter_mut().zip(self.hands) {
            if let Some(pose) = frame.pose(&self.grip, path)? {
                *hand = Mat4::from_cols_array_2d(&pose);
            }
        }
        Ok(hands)
    }

    /// Whether a trigger was pressed since the last frame.
    fn is_pressed(&self, frame: &HeadsetFrame<'_>) -> Result<bool, xr::sys::Result> {
        let state = self.trigger.state(frame.session(), xr::Path::NULL)?;
        Ok(state.is_active && state.changed_since_last_sync && state.current_state)
    }
}
