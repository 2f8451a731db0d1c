//! From a full-rate frame on the device to what each side shows: foveation, then the methods. Nothing is read back.

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

/// As of `run`, whose pictures are to be the same.
const COLOR: TextureFormat = TextureFormat::Rgba32Float;

const WRITTEN: TextureUsages =
    TextureUsages::TEXTURE_BINDING.union(TextureUsages::STORAGE_BINDING).union(TextureUsages::COPY_SRC);

/// A side: its method and what that shows.
struct Lane {
    shows: Shows,
    /// `None`: the full-rate frame is shown.
    post: Option<Afterimage>,
    output: Texture,
    /// A picture of its decisions.
    decisions: Texture,
}

/// Frames of one size on a device.
pub struct Lanes {
    gpu: Arc<Headless>,
    geometry: ViewGeometry,
    full: Texture,
    depth: Texture,
    motion: Texture,
    /// For a frame that is shown again.
    no_motion: Texture,
    lod: Texture,
    foveated: Texture,
    foveation: GpuSimulator,
    lanes: Vec<Lane>,
    /// What is known of the uploaded frame.
    has_depth: bool,
    has_motion: bool,
    previous_from_current: Option<[[f32; 4]; 4]>,
    cut: bool,
    /// Frames since the history started afresh.
    index: u64,
}

fn desc(geometry: &ViewGeometry, settings: Settings) -> GpuDesc {
    GpuDesc { context: ContextDesc::new(geometry.size_px()), output_format: COLOR, settings }
}

impl Lanes {
    /// For frames of `geometry`'s size. `settings` gives those of each method, its foveation included.
    pub fn new(
        gpu: &Arc<Headless>,
        geometry: ViewGeometry,
        state: &State,
        settings: &dyn Fn(Shows) -> Settings,
    ) -> Result<Self, Failure> {
        let texture = |format, usage| gpu.texture(geometry.size_px(), 1, format, usage);
        let read = TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST | TextureUsages::COPY_SRC;
        let mut made = Self {
            full: texture(COLOR, read),
            depth: texture(TextureFormat::R32Float, read),
            motion: texture(TextureFormat::Rg32Float, read),
            no_motion: texture(TextureFormat::Rg32Float, read),
            lod: texture(TextureFormat::R32Float, WRITTEN),
            foveated: texture(COLOR, WRITTEN),
            foveation: GpuSimulator::new(&gpu.device, &desc(&geometry, settings(Shows::None)))?,
            lanes: vec![],
            has_depth: false,
            has_motion: false,
            previous_from_current: None,
            cut: false,
            index: 0,
            geometry,
            gpu: gpu.clone(),
        };
        made.adapt(state, settings)?;
        Ok(made)
    }

    /// Follows the state: methods of the sides, foveation. All history starts afresh.
    pub fn adapt(&mut self, state: &State, settings: &dyn Fn(Shows) -> Settings) -> Result<(), Failure> {
        let device = &self.gpu.device;
        let foveation = settings(Shows::None).foveation;
        if foveation != self.foveation.desc().settings.foveation {
            self.foveation = GpuSimulator::new(device, &desc(&self.geometry, settings(Shows::None)))?;
        }
        let sides = state.shown_sides();
        self.lanes.truncate(sides.len());
        for (i, &side) in sides.iter().enumerate() {
            let shows = state.sides[side as usize];
            match self.lanes.get_mut(i) {
                Some(lane) if lane.shows == shows => {
                    if let Some(post) = &mut lane.post {
                        post.set_settings(device, settings(shows))?;
                    }
                }
                Some(_) => {
                    let post = self.post(shows, settings)?;
                    (self.lanes[i].post, self.lanes[i].shows) = (post, shows);
                }
                None => {
                    let texture = || self.gpu.texture(self.geometry.size_px(), 1, COLOR, WRITTEN);
                    let post = self.post(shows, settings)?;
                    self.lanes.push(Lane { shows, post, output: texture(), decisions: texture() });
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

    /// Pixels and angles of its frames.
    pub fn geometry(&self) -> &ViewGeometry {
        &self.geometry
    }

    /// Frames since the history started afresh.
    pub fn index(&self) -> u64 {
        self.index
    }

    /// Forgets all history.
    pub fn forget(&mut self) {
        self.index = 0;
        self.lanes.iter_mut().filter_map(|lane| lane.post.as_mut()).for_each(Afterimage::forget);
    }

    /// Puts a full-rate frame onto the device.
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

    /// Shows the uploaded frame to an eye that looks at `gaze_px`. `again`: it is the frame of the last call, and nothing has moved.
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
        // Blocks are decided by their centres, which the methods do not know.
        let told = self.foveation.desc().settings.foveation.filter == Filter::Block;
        let (gpu, device) = (&self.gpu, &self.gpu.device);
        times.pass(gpu, Pass::Foveation, |encoder, timestamps| {
            let lod = told.then_some(&self.lod);
            let frame = SimulatorFrame { lod, timestamps, ..SimulatorFrame::new(&self.full, &self.foveated, &views) };
            self.foveation.record(device, encoder, &frame)
        })?;
        // A cut is one when its frame comes, not for as long as it stays.
        let cut = std::mem::take(&mut self.cut);
        let fresh = cut || self.index == 0;
        let motion = if again { &self.no_motion } else { &self.motion };
        for (lane, pass) in self.lanes.iter_mut().zip([Pass::Left, Pass::Right]) {
            let Some(post) = &mut lane.post else { continue };
            let frame = Frame {
                depth: self.has_depth.then_some(&self.depth),
                motion: self.has_motion.then_some(motion),
                lod: told.then_some(&self.lod),
                reset: if fresh { Reset::All } else { Reset::None },
                ..Frame::new(&self.foveated, &lane.output, &views, self.index)
            };
            if let Some(debug) = state.debug {
                let mut encoder = device.create_command_encoder(&Default::default());
                let frame = Frame { output: &lane.decisions, ..frame };
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

    /// The picture of a side, without marks; of a side that is not shown that of the left one.
    pub fn picture(&self, side: Side) -> &Texture {
        let lane = self.lanes.get(side as usize).unwrap_or(&self.lanes[0]);
        if lane.shows == Shows::Reference { &self.full } else { &lane.output }
    }

    /// What is on screen of a side, and whether it is a picture of decisions.
    pub fn on_screen(&self, side: Side, state: &State) -> (&Texture, bool) {
        let lane = self.lanes.get(side as usize).unwrap_or(&self.lanes[0]);
        match state.debug {
            Some(_) if lane.post.is_some() => (&lane.decisions, true),
            _ => (self.picture(side), false),
        }
    }
}
