//! GPU passes of the viewer: render a scene or foveate the full-rate frame, then run the method of each side. Nothing
//! is read back.

use super::examiner::Examiner;
use super::setup::Setup;
use super::shader_folder::ShaderFolder;
use super::state::{Shows, Side, State};
use super::times::{Pass, PassTimes};
use crate::failure::Failure;
use afterimage::doctor::Finding;
use afterimage::gpu::Frame;
use afterimage::internal::{ContextDesc, Foveation, FoveationKind, MethodKind, Reset, Settings, ViewFrame};
use afterimage::wgpu::{CommandEncoder, Texture};
use afterimage::{Gaze, ViewGeometry};
use afterimage_lab::device::Headless;
use afterimage_lab::frame::{Content, RenderedFrame};
use afterimage_lab::pipeline::{DeviceFormats, DeviceInputs, DeviceRun};
use afterimage_lab::quad_views::{Geometry, QuadViewLayout};
use afterimage_lab::source::{FrameRequest, RasterSource, Wanted};
use std::convert::Infallible;
use std::sync::Arc;

/// Same formats as in `run`, so that both give the same pictures.
const FORMATS: DeviceFormats = DeviceFormats::EXACT;

/// One side of the window.
struct SideRun {
    shows: Shows,
    /// `None`: the full-rate frame is shown.
    run: Option<DeviceRun>,
}

/// Textures and passes for frames of one size.
pub struct ViewPipeline {
    gpu: Arc<Headless>,
    geometry: ViewGeometry,
    inputs: DeviceInputs,
    runs: Vec<SideRun>,
    /// While the inputs are checked.
    examiner: Option<Examiner>,
    desc: ContextDesc,
    /// Depth and motion of quad views.
    view_geometry: Geometry,
    /// With `--shaders`.
    shaders: Option<ShaderFolder>,
    /// Whether planned frames are jittered.
    is_jittered: bool,
    /// Quad views of rendered frames.
    quad_views: Option<QuadViewLayout>,
    // Properties of the uploaded or posed frame.
    /// Position of the frame to render.
    position: u64,
    /// Whether the full-rate frame is on the device.
    has_full: bool,
    previous_from_current: Option<[[f32; 4]; 4]>,
    cut: bool,
    /// Frames since the last history reset.
    index: u64,
}

fn desc(geometry: &ViewGeometry, settings: Settings) -> ContextDesc {
    ContextDesc { settings, keep_alpha: false, ..ContextDesc::new(geometry.size_px()) }
}

impl ViewPipeline {
    /// Creates textures of `geometry`'s size.
    pub fn new(
        gpu: &Arc<Headless>,
        geometry: ViewGeometry,
        state: &State,
        view_geometry: Geometry,
        setup: &Setup,
    ) -> Result<Self, Failure> {
        let desc = desc(&geometry, setup.settings(state, Shows::Post(MethodKind::None)));
        let mut pipeline = Self {
            inputs: DeviceInputs::new(gpu, &desc, FORMATS)?,
            runs: vec![],
            examiner: None,
            desc,
            view_geometry,
            shaders: setup.args.shaders.as_deref().map(|dir| ShaderFolder::open(dir, &gpu.device)).transpose()?,
            is_jittered: setup.args.foveation.is_jittered(),
            quad_views: None,
            position: 0,
            has_full: false,
            previous_from_current: None,
            cut: false,
            index: 0,
            geometry,
            gpu: gpu.clone(),
        };
        pipeline.adapt(state, setup)?;
        Ok(pipeline)
    }

    /// Applies changes of the state to methods and foveation. Resets all history.
    pub fn adapt(&mut self, state: &State, setup: &Setup) -> Result<(), Failure> {
        let settings = |shows| setup.settings(state, shows);
        self.quad_views = setup.quad_views(state);
        self.desc = desc(&self.geometry, settings(Shows::Post(MethodKind::None)));
        self.inputs.set_foveation(&self.desc)?;
        let sides = state.shown_sides();
        self.runs.truncate(sides.len());
        for (i, &side) in sides.iter().enumerate() {
            let shows = state.sides[side as usize];
            match self.runs.get_mut(i) {
                Some(side) if side.shows == shows => {
                    if let Some(run) = &mut side.run {
                        run.post_mut().set_settings(&self.gpu.device, settings(shows))?;
                    }
                }
                Some(_) => self.runs[i] = self.side_run(shows, settings(shows))?,
                None => self.runs.push(self.side_run(shows, settings(shows))?),
            }
        }
        self.forget();
        Ok(())
    }

    fn side_run(&self, shows: Shows, settings: Settings) -> Result<SideRun, Failure> {
        let sources = || self.shaders.as_ref().map(|shaders| shaders.sources.clone()).unwrap_or_default();
        let new = |_| DeviceRun::with_sources(&self.gpu, &desc(&self.geometry, settings), FORMATS, sources());
        Ok(SideRun { shows, run: shows.method().map(new).transpose()? })
    }

    /// Takes shaders whose files have changed since the last call, and returns whether any did.
    pub fn reload(&mut self, state: &State, setup: &Setup) -> Result<bool, Failure> {
        let has_changed = self.shaders.as_mut().is_some_and(|shaders| shaders.has_changed(&self.gpu.device));
        if has_changed {
            self.runs.clear();
            self.adapt(state, setup)?;
        }
        Ok(has_changed)
    }

    /// Size in pixels and field of view of the frames.
    pub fn geometry(&self) -> &ViewGeometry {
        &self.geometry
    }

    /// Frames since the last history reset.
    pub fn index(&self) -> u64 {
        self.index
    }

    /// Resets the history of all methods.
    pub fn forget(&mut self) {
        self.index = 0;
        self.examiner = None;
        self.runs.iter_mut().filter_map(|side| side.run.as_mut()).for_each(|run| run.post_mut().forget());
    }

    /// Uploads a full-rate frame.
    pub fn upload(&mut self, frame: &RenderedFrame) {
        self.record_now(|inputs, encoder| inputs.set(encoder, frame));
        self.previous_from_current = frame.reference.previous_from_current;
        self.cut = frame.reference.cut;
        self.has_full = true;
    }

    /// Frame to render when it is shown. `cut`: the camera jumped.
    pub fn pose(&mut self, position: u64, cut: bool) {
        (self.position, self.cut) = (position, cut);
    }

    /// Records and submits changes of the inputs, untimed.
    fn record_now(&mut self, record: impl FnOnce(&mut DeviceInputs, &mut CommandEncoder)) {
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        record(&mut self.inputs, &mut encoder);
        self.gpu.queue.submit([encoder.finish()]);
    }

    /// Foveates the uploaded frame around `gaze_px`, or renders the posed one foveated, and runs the methods. `again`:
    /// the frame is that of the last call, so motion is zero.
    pub fn show(
        &mut self,
        gaze_px: [f32; 2],
        again: bool,
        state: &State,
        mut renderer: Option<&mut RasterSource>,
        times: &mut PassTimes,
    ) -> Result<(), Failure> {
        let by_quads = self.desc.settings.foveation.kind == FoveationKind::Quads;
        // Rendered frames are shown again only after a reset of the history, which needs no motion.
        let again = again && renderer.is_none();
        let rendered = renderer.as_deref_mut().map(|renderer| self.render(renderer, gaze_px, state, times));
        let is_simulated = rendered.as_ref().is_none_or(|(content, _)| matches!(content, Content::FullRate));
        let jitter_px = rendered.map_or([0.0; 2], |(_, jitter_px)| jitter_px);
        let views = [ViewFrame {
            previous_from_current: self.previous_from_current.filter(|_| !again),
            jitter_px,
            ..ViewFrame::new(self.geometry, Gaze::At { px: gaze_px })
        }];
        let gpu = &self.gpu;
        if is_simulated && !by_quads {
            times.pass(gpu, Pass::Foveation, |encoder, timestamps| self.inputs.foveate(encoder, &views, timestamps))?;
        }
        // A cut resets the history once, not again each time its frame is shown.
        let cut = std::mem::take(&mut self.cut);
        let reset = if cut || self.index == 0 { Reset::All } else { Reset::None };
        let frame = self.inputs.frame(&views, self.index, reset, false);
        let frame = if again { self.inputs.again(frame) } else { frame };
        // The doctor does not know frames with few samples.
        if state.is_examined && !by_quads {
            let examiner = match &mut self.examiner {
                Some(examiner) => examiner,
                none => none.insert(Examiner::new(gpu, &self.desc)?),
            };
            examiner.examine(gpu, &frame)?;
        } else {
            self.examiner = None;
        }
        for (side, pass) in self.runs.iter_mut().zip([Pass::Left, Pass::Right]) {
            let Some(run) = &mut side.run else { continue };
            if by_quads {
                // Of a given frame, the pixels are those of its full-rate picture.
                let full = self.inputs.full();
                times.span(gpu, pass, |encoder| {
                    run.post_mut().plan(&gpu.device, encoder, &frame)?;
                    let color = match renderer.as_deref_mut() {
                        Some(renderer) => {
                            // After a cut all of them, though one pixel of each is read.
                            let list = run.post().quad_list(0).expect("the settings ask for a plan");
                            renderer.record_quads(encoder, self.position, jitter_px, list)
                        }
                        None => full.clone(),
                    };
                    let frame = Frame { color: (&color).into(), ..frame };
                    if let Some(debug) = state.debug {
                        run.record_view(encoder, &frame, debug)?;
                    }
                    run.record(encoder, &frame, None).map(drop)
                })?;
                continue;
            }
            if let Some(debug) = state.debug {
                let mut encoder = gpu.device.create_command_encoder(&Default::default());
                run.record_view(&mut encoder, &frame, debug)?;
                gpu.queue.submit([encoder.finish()]);
            }
            times.pass(gpu, pass, |encoder, timestamps| run.record(encoder, &frame, timestamps).map(drop))?;
        }
        self.index += 1;
        Ok(())
    }

    /// Renders the posed frame, and the full-rate frame besides, untimed, where a side shows it. What the methods get,
    /// and its jitter in pixels.
    fn render(
        &mut self,
        renderer: &mut RasterSource,
        gaze_px: [f32; 2],
        state: &State,
        times: &mut PassTimes,
    ) -> (Content, [f32; 2]) {
        let quad_views = self
            .quad_views
            .map(|layout| Wanted::QuadViews(layout.views(&self.desc.settings.foveation, &self.geometry, gaze_px)));
        // As in run: the sequence starts with a corner of the pixel.
        let by_quads = self.desc.settings.foveation.kind == FoveationKind::Quads;
        let jitter_px = (self.is_jittered && by_quads).then(|| Foveation::jitter_px(self.index + 1));
        let otherwise = if by_quads { Wanted::Surfaces } else { Wanted::FullRate };
        let wanted = quad_views.unwrap_or(otherwise);
        let full_rate = FrameRequest { reference: false, ..FrameRequest::full_rate(self.position) };
        let request = FrameRequest { gaze_px, wanted, jitter_px, geometry: self.view_geometry, ..full_rate.clone() };
        self.has_full = request.needs_full_rate();
        if !self.has_full && state.shows_reference() {
            self.record_now(|inputs, encoder| {
                let frame = renderer.record(encoder, &full_rate);
                inputs.set(encoder, &frame);
            });
            if self.gpu.is_software() {
                self.gpu.wait();
            }
            self.has_full = true;
        }
        let mut rendered = (Content::FullRate, [0.0; 2]);
        let timed = times.span(&self.gpu, Pass::Render, |encoder| {
            let frame = renderer.record(encoder, &request);
            self.inputs.set(encoder, &frame);
            self.previous_from_current = frame.reference.previous_from_current;
            rendered = (frame.content, frame.jitter_px);
            Ok::<(), Infallible>(())
        });
        let Ok(()) = timed;
        rendered
    }

    /// What is found about the inputs; nothing unless they are checked.
    pub fn findings(&self) -> Vec<Finding> {
        self.examiner.as_ref().map(Examiner::findings).unwrap_or_default()
    }

    /// Whether [`full`](Self::full) is the frame on screen at full rate.
    pub fn has_full(&self) -> bool {
        self.has_full
    }

    /// The full-rate frame.
    pub fn full(&self) -> &Texture {
        self.inputs.full()
    }

    fn side(&self, side: Side) -> &SideRun {
        self.runs.get(side as usize).unwrap_or(&self.runs[0])
    }

    /// A side's output, without overlays; the left side's if `side` is not shown.
    pub fn picture(&self, side: Side) -> &Texture {
        self.side(side).run.as_ref().map_or(self.full(), DeviceRun::output)
    }

    /// The texture that the window shows for a side, and whether it is a debug view.
    pub fn on_screen(&self, side: Side, state: &State) -> (&Texture, bool) {
        let run = self.side(side).run.as_ref();
        match state.debug.and_then(|_| run?.debug()) {
            Some(debug) => (debug, true),
            None => (self.picture(side), false),
        }
    }
}
