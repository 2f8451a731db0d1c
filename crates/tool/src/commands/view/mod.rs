//! `afterimage view`: show the methods live in a window; the mouse is the gaze.

mod app;
mod auto_scale;
mod burst;
mod device;
mod examiner;
mod explain;
mod fly_camera;
mod frame_loader;
mod frames;
mod graph;
mod jod;
mod keys;
mod layout;
mod measuring_pass;
mod panel;
mod panel_stats;
mod pictures;
mod pipeline;
mod quality;
mod record;
mod resources;
mod screen;
mod setup;
mod shader;
mod shader_folder;
mod state;
mod surface;
mod times;
mod viewer;

use crate::args::backend::BackendName;
use crate::args::gaze_log::GazeLogArgs;
use crate::args::input::{InputArgs, Rendering};
use crate::args::{FoveationArgs, MethodArgs, by_name, parse_frames, parse_stops};
use crate::failure::Failure;
use afterimage::internal::FoveationKind;
use afterimage_lab::scanpath::GazeMap;
use app::App;
use clap::Args;
use frame_loader::FrameLoader;
use frames::Frames;
use setup::Setup;
use state::Shows;
use std::path::PathBuf;
use winit::event_loop::EventLoop;

/// Show the methods live in a window; the mouse is the gaze
#[derive(Args, Clone, Debug)]
#[command(
    after_help = keys::help() + "\n\nExample:\n  afterimage view photo.jpg --split none,smr --fovea 8"
)]
pub struct ViewArgs {
    #[command(flatten)]
    pub input: InputArgs,
    /// Method to show
    #[arg(long, value_parser = by_name::<Shows>(), default_value = "smr", value_name = "NAME")]
    pub method: Shows,
    /// Two methods to show side by side
    #[arg(
        long, value_parser = by_name::<Shows>(), value_delimiter = ',', conflicts_with = "method", value_name = "A,B"
    )]
    pub split: Vec<Shows>,
    /// Scanpath to play instead of following the mouse: FILE, as for run, one fixed frame pixel (X,Y), or
    /// synthetic[:SEED]. One position per frame, at most --fps frames a second, so that pictures are the same as with
    /// run; key P
    #[arg(long, value_name = "GAZE", allow_hyphen_values = true)]
    pub gaze: Option<String>,
    /// Map from screen to frame: keep visual angles, or stretch; default: angle if the file states the screen's
    /// geometry
    #[arg(long, value_parser = by_name::<GazeMap>())]
    pub gaze_map: Option<GazeMap>,
    #[command(flatten)]
    pub log: GazeLogArgs,
    /// Start time in the scanpath, seconds
    #[arg(long, default_value_t = 0.0, value_name = "S")]
    pub start: f64,
    /// Quit after N frames; default: never
    #[arg(long, value_parser = parse_frames, value_name = "N")]
    pub frames: Option<u64>,
    #[command(flatten)]
    pub foveation: FoveationArgs,
    #[command(flatten)]
    pub method_settings: MethodArgs,
    /// Seed of the random numbers
    #[arg(long, default_value_t = 0, value_name = "N")]
    pub seed: u64,
    /// Exposure before sRGB encoding, stops
    #[arg(long, default_value_t = 0.0, value_parser = parse_stops, value_name = "EV", allow_negative_numbers = true)]
    pub exposure: f32,
    /// Rendering resolution as a factor on the input's, above 0 and at most 1; default: 1, lowered on a software device
    /// that is too slow
    #[arg(long, value_name = "X")]
    pub internal_scale: Option<f32>,
    /// File that F12 saves the picture to, as run writes it; with --frames the last picture is saved too
    #[arg(long, value_name = "FILE.png")]
    pub screenshot: Option<PathBuf>,
    /// File for the gaze of every frame since the last history reset, as a scanpath for --gaze; written with each
    /// picture and at the end
    #[arg(long, value_name = "FILE.csv")]
    pub record: Option<PathBuf>,
    /// Start with the panel hidden
    #[arg(long)]
    pub no_panel: bool,
    /// For who changes the method: its shaders from here, read again as the files change; the folder shaders of the
    /// sources, or one with some of its files
    #[arg(long, value_name = "DIR")]
    pub shaders: Option<PathBuf>,
}

/// The subcommand.
pub fn view(args: &ViewArgs) -> Result<(), Failure> {
    let is_rendered = args.input.is_rasterised();
    let default = if is_rendered { FoveationKind::Quads } else { FoveationKind::Mip };
    let foveation = args.foveation.clone().with_defaults(default, false);
    let args = &ViewArgs { foveation, ..args.clone() };
    let (setup, frames) = if args.input.is_rasterised() {
        let head = setup::head(args)?;
        let scene = args.input.scene(head.clone())?;
        (Setup::new(args, scene.info(), head.as_ref())?, Frames::of_scene(scene))
    } else {
        let backend = BackendName::Auto.open_for(&args.input.name)?;
        let head = setup::head(args)?;
        let rendering = Rendering { backend, seed: args.seed, foveated: None, head: head.clone() };
        let source = args.input.open(&rendering)?;
        (Setup::new(args, source.info(), head.as_ref())?, Frames::Loaded(FrameLoader::new(source)))
    };
    let events = EventLoop::new().map_err(|_| {
        Failure::Work("there is no display for a window; start it on a desktop, or use afterimage run".into())
    })?;
    let mut app = App::new(setup, frames);
    events.run_app(&mut app).map_err(|e| Failure::Work(format!("the window's event loop failed ({e})")))?;
    app.outcome?;
    match device::validation_errors() {
        0 => Ok(()),
        n => Err(Failure::Work(format!(
            "the device reported {n} validation errors, the first is shown above; please report it"
        ))),
    }
}
