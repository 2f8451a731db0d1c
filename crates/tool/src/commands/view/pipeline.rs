//! GPU passes of the viewer: foveate the full-rate frame, then run the method of each side. Nothing is read back.

use super::state::{Shows, Side, State};
use super::times::{Pass, PassTimes};
use crate::failure::Failure;
use afterimage::gpu::{Afterimage, Frame, GpuDesc};
use afterimage::simulator::{GpuSimulator, SimulatorFrame};
use afterimage::{ContextDesc, Filter, Gaze, Reset, Settings, ViewFrame, ViewGeometry};
use afterimage_lab::device::Headless;
use afterimage_lab::frame::SourceFrame;
use std::sync::Arc;
use wgpu::{Texture, TextureFormat, TextureUsages};

/// Same format as in `run`, so that both give the same pictures.
const COLOR: TextureFormat = TextureFormat::Rgba32Float;

const STORAGE: TextureUsages =
    TextureUsages::TEXTURE_BINDING.union(TextureUsages::STORAGE_BINDING).union(TextureUsages::COPY_SRC);

/// The method of one side of the window, and its output.
struct MethodRun {
    shows: Shows,
    /// `None`: the full-rate frame is shown.
    post: Option<Afterimage>,
    output: Texture,
    /// Debug view of the method's decisions.
    debug_view: Texture,
}

/// Textures and passes for frames of one size.
pub struct ViewPipeline {
    gpu: Arc<Headless>,
    geometry: ViewGeometry,
    full: Texture,
    depth: Texture,
    motion: Texture,
    /// All zero, for a frame that is shown again.
    no_motion: Texture,
    lod: Texture,
    foveated: Texture,
    foveation: GpuSimulator,
    runs: Vec<MethodRun>,
    // Properties of the uploaded frame.
    has_depth: bool,
    has_motion: bool,
    previous_from_current: Option<[[f32; 4]; 4]>,
    cut: bool,
    /// Frames since the last history reset.
    index: u64,
}

fn desc(geometry: &ViewGeometry, settings: Settings) -> GpuDesc {
    GpuDesc { context: ContextDesc::new(geometry.size_px()), output_format: COLOR, settings }
}

impl ViewPipeline {
    /// Creates textures of `geometry`'s size. `settings` returns a method's settings, foveation included.
    pub fn new(
        gpu: &Arc<Headless>,
        geometry: ViewGeometry,
        state: &State,
        settings: &dyn Fn(Shows) -> Settings,
    ) -> Result<Self, Failure> {
        let texture = |format, usage| gpu.texture(geometry.size_px(), 1, format, usage);
        let read = TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST | TextureUsages::COPY_SRC;
        let mut pipeline = Self {
            full: texture(COLOR, read),
            depth: texture(TextureFormat::R32Float, read),
            motion: texture(TextureFormat::Rg32Float, read),
            no_motion: texture(TextureFormat::Rg32Float, read),
            lod: texture(TextureFormat::R32Float, STORAGE),
            foveated: texture(COLOR, STORAGE),
            foveation: GpuSimulator::new(&gpu.device, &desc(&geometry, settings(Shows::None)))?,
            runs: vec![],
            has_depth: false,
            has_motion: false,
            previous_from_current: None,
            cut: false,
            index: 0,
            geometry,
            gpu: gpu.clone(),
        };
        pipeline.adapt(state, settings)?;
        Ok(pipeline)
    }

    /// Applies changes of the state to methods and foveation. Resets all history.
    pub fn adapt(&mut self, state: &State, settings: &dyn Fn(Shows) -> Settings) -> Result<(), Failure> {
        let device = &self.gpu.device;
        let foveation = settings(Shows::None).foveation;
        if foveation != self.foveation.desc().settings.foveation {
            self.foveation = GpuSimulator::new(device, &desc(&self.geometry, settings(Shows::None)))?;
        }
        let sides = state.shown_sides();
        self.runs.truncate(sides.len());
        for (i, &side) in sides.iter().enumerate() {
            let shows = state.sides[side as usize];
            match self.runs.get_mut(i) {
                Some(run) if run.shows == shows => {
                    if let Some(post) = &mut run.post {
                        post.set_settings(device, settings(shows))?;
                    }
                }
                Some(_) => {
                    let post = self.post(shows, settings)?;
                    (self.runs[i].post, self.runs[i].shows) = (post, shows);
                }
                None => {
                    let texture = || self.gpu.texture(self.geometry.size_px(), 1, COLOR, STORAGE);
                    let post = self.post(shows, settings)?;
                    self.runs.push(MethodRun { shows, post, output: texture(), debug_view: texture() });
                }
            }
        }
        self.forget();
        Ok(())
    }

    fn post(&self, shows: Shows, settings: &dyn Fn(Shows) -> Settings) -> Result<Option<Afterimage>, Failure> {
        let make = |_| Afterimage::new(&self.gpu.device, &desc(&self.geometry, settings(shows)));
        Ok(shows.method().map(make).transpose()?)
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
        self.runs.iter_mut().filter_map(|run| run.post.as_mut()).for_each(Afterimage::forget);
    }

    /// Uploads a full-rate frame.
    pub fn upload(&mut self, frame: &SourceFrame) {
        self.gpu.write_rgb(&self.full, 0, &frame.color);
        if let Some(depth) = &frame.depth {
            self.gpu.write(&self.depth, 0, depth);
        }
        if let Some(motion) = &frame.motion {
            self.gpu.write(&self.motion, 0, motion);
        }
        self.has_depth = frame.depth.is_some();
        self.has_motion = frame.motion.is_some();
        self.previous_from_current = frame.previous_from_current;
        self.cut = frame.cut;
    }

    /// Foveates the uploaded frame around `gaze_px` and runs the methods. `again`: the frame is that of the last call, so motion is
    /// zero.
    pub fn show(
        &mut self,
        gaze_px: [f32; 2],
        again: bool,
        state: &State,
        times: &mut PassTimes,
    ) -> Result<(), Failure> {
        let views = [ViewFrame {
            geometry: self.geometry,
            gaze: Gaze::At { px: gaze_px },
            previous_from_current: self.previous_from_current.filter(|_| !again),
        }];
        // `Filter::Block` takes each block's level of detail at the block's center. The methods cannot derive that from the gaze alone, so
        // they read it from the texture.
        let lod_given = self.foveation.desc().settings.foveation.filter == Filter::Block;
        let (gpu, device) = (&self.gpu, &self.gpu.device);
        times.pass(gpu, Pass::Foveation, |encoder, timestamps| {
            let lod = lod_given.then_some(&self.lod);
            let frame = SimulatorFrame { lod, timestamps, ..SimulatorFrame::new(&self.full, &self.foveated, &views) };
            self.foveation.record(device, encoder, &frame)
        })?;
        // A cut resets the history once, not again each time its frame is shown.
        let cut = std::mem::take(&mut self.cut);
        let reset = cut || self.index == 0;
        let motion = if again { &self.no_motion } else { &self.motion };
        for (run, pass) in self.runs.iter_mut().zip([Pass::Left, Pass::Right]) {
            let Some(post) = &mut run.post else { continue };
            let frame = Frame {
                depth: self.has_depth.then_some(&self.depth),
                motion: self.has_motion.then_some(motion),
                lod: lod_given.then_some(&self.lod),
                reset: if reset { Reset::All } else { Reset::None },
                ..Frame::new(&self.foveated, &run.output, &views, self.index)
            };
            if let Some(debug) = state.debug {
                let mut encoder = device.create_command_encoder(&Default::default());
                let frame = Frame { output: &run.debug_view, ..frame };
                post.record_view(device, &mut encoder, &frame, debug.view())?;
                gpu.queue.submit([encoder.finish()]);
            }
            times.pass(gpu, pass, |encoder, timestamps| {
                post.record(device, encoder, &Frame { timestamps, ..frame }).map(drop)
            })?;
        }
        self.index += 1;
        Ok(())
    }

    /// The full-rate frame.
    pub fn full(&self) -> &Texture {
        &self.full
    }

    /// A side's output, without overlays; the left side's if `side` is not shown.
    pub fn picture(&self, side: Side) -> &Texture {
        let run = self.runs.get(side as usize).unwrap_or(&self.runs[0]);
        if run.shows == Shows::Reference { &self.full } else { &run.output }
    }

    /// The texture that the window shows for a side, and whether it is a debug view.
    pub fn on_screen(&self, side: Side, state: &State) -> (&Texture, bool) {
        let run = self.runs.get(side as usize).unwrap_or(&self.runs[0]);
        match state.debug {
            Some(_) if run.post.is_some() => (&run.debug_view, true),
            _ => (self.picture(side), false),
        }
    }
}
