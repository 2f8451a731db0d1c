//! Options of the viewer and properties of the input, checked before the window opens.

use super::ViewArgs;
use super::state::{Shows, State};
use crate::args::gaze::GazeArgs;
use crate::args::head::head_path;
use crate::args::input;
use crate::args::{FilterName, FoveationArgs};
use crate::failure::Failure;
use afterimage::ViewGeometry;
use afterimage::internal::{FoveationKind, MethodKind, Settings};
use afterimage_lab::quad_views::QuadViewLayout;
use afterimage_lab::scanpath::HeadPath;
use afterimage_lab::source::SourceInfo;

/// Options, and properties of the input.
pub struct Setup {
    pub args: ViewArgs,
    pub info: SourceInfo,
    pub fps: f32,
    pub hfov_deg: f32,
    /// Gaze per frame, in pixels of the input; `None`: tracking lost.
    pub track: Vec<Option<[f32; 2]>>,
}

/// The head that moves the camera, with `--camera head`.
pub fn head(args: &ViewArgs) -> Result<Option<HeadPath>, Failure> {
    head_path(args.input.camera.as_deref(), &gaze(args), &args.input.name, args.input.fps, args.frames)
}

fn gaze(args: &ViewArgs) -> GazeArgs {
    let gaze = args.gaze.clone().unwrap_or_else(|| "synthetic:0".into());
    GazeArgs { gaze, gaze_map: args.gaze_map, start: args.start, log: args.log.clone() }
}

impl Setup {
    /// Checks everything that can be checked without a device.
    pub fn new(args: &ViewArgs, info: &SourceInfo, head: Option<&HeadPath>) -> Result<Self, Failure> {
        let refuse = |text: String| Err(Failure::Input(text));
        if !matches!(args.split.len(), 0 | 2) {
            return refuse(format!("--split: {} names, expected two, such as none,smr", args.split.len()));
        }
        if let Some(scale) = args.internal_scale.filter(|s| !(*s > 0.0 && *s <= 1.0)) {
            return refuse(format!("--internal-scale {scale}: expected above 0 and at most 1"));
        }
        args.foveation.check(args.input.is_rasterised(), args.input.is_analytic())?;
        if args.foveation.is_jittered() && !(args.input.is_rasterised() && args.foveation.is_quads()) {
            return refuse(
                "--jitter halton: the viewer jitters planned frames of scenes only; give a scene (.gltf, .glb, \
                 builtin:NAME) and --foveation planned, or use run"
                    .into(),
            );
        }
        let (fps, geometry) = (args.input.fps(info), args.input.geometry(info)?);
        let track = gaze(args).resolve(&geometry, fps, input::frames(args.frames, info), head, 0.0)?.px;
        let setup = Self { args: args.clone(), info: info.clone(), fps, hfov_deg: geometry.hfov_deg(), track };
        let mut state = setup.state();
        for &side in state.shown_sides() {
            setup.settings(&state, state.sides[side as usize]).validate()?;
        }
        // Keys lead to the other methods and filters.
        state.filter = FilterName::Of(FoveationKind::Mip);
        for method in MethodKind::ALL {
            setup.settings(&state, Shows::Post(method)).validate()?;
        }
        Ok(setup)
    }

    /// Initial state.
    pub fn state(&self) -> State {
        let args = &self.args;
        State {
            sides: match args.split[..] {
                [left, right] => [left, right],
                _ => [args.method, Shows::Reference],
            },
            is_split: !args.split.is_empty(),
            divider: 0.5,
            filter: args.foveation.filter(),
            is_rasterised: args.input.is_rasterised(),
            fovea_deg: args.foveation.fovea,
            mid_deg: args.foveation.mid,
            debug: None,
            is_frozen: false,
            is_playing: args.gaze.is_some(),
            is_flying: None,
            is_examined: false,
            is_marked: true,
            has_panel: !args.no_panel,
        }
    }

    /// Settings of the method, as in `run`.
    pub fn settings(&self, state: &State, shows: Shows) -> Settings {
        let method = shows.method().unwrap_or_default();
        let foveation = self.foveation(state).foveation();
        let settings = Settings { foveation, ..self.args.method_settings.settings(method, self.args.seed, false) };
        self.args.foveation.antialiased(settings)
    }

    /// Quad views of rendered frames, if they are composed of such.
    pub fn quad_views(&self, state: &State) -> Option<QuadViewLayout> {
        self.foveation(state).quad_views()
    }

    fn foveation(&self, state: &State) -> FoveationArgs {
        let args = FoveationArgs { filter: Some(state.filter), fovea: state.fovea_deg, ..self.args.foveation.clone() };
        // Rates that suit blocks need not suit quads.
        match args.is_quads() && !self.args.foveation.is_quads() {
            true => FoveationArgs { rate_mid: None, rate_far: None, ..args },
            false => args,
        }
    }

    /// View geometry at a factor on the input's resolution.
    pub fn geometry(&self, scale: f32) -> Result<ViewGeometry, Failure> {
        let size = self.info.size.map(|s| ((s as f32 * scale).round() as u32).max(1));
        Ok(ViewGeometry::flat(size, self.hfov_deg)?)
    }

    /// Gaze of the scanpath in a frame, in pixels at a factor on the input's resolution.
    pub fn played_px(&self, position: u64, scale: f32) -> Option<[f32; 2]> {
        let px = self.track[(position % self.track.len() as u64) as usize]?;
        Some(if scale == 1.0 { px } else { px.map(|v| (v + 0.5) * scale - 0.5) })
    }

    /// Exposure factor, linear.
    pub fn gain(&self) -> f32 {
        self.args.exposure.exp2()
    }
}
