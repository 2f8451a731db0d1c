//! GPU passes of the viewer: foveate the full-rate frame, then run the method of each side. Nothing is read back.

use super::examiner::Examiner;
use super::state::{Shows, Side, State};
use super::times::{Pass, PassTimes};
use crate::failure::Failure;
use afterimage::wgpu::Texture;
use afterimage::{ContextDesc, Filter, Finding, Gaze, Method, Reset, Settings, ViewFrame, ViewGeometry};
use afterimage_lab::device::Headless;
use afterimage_lab::frame::SourceFrame;
use afterimage_lab::pipeline::{DeviceFormats, DeviceInputs, DeviceRun, SampleOrder, SparseGeometry};
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
    sparse_geometry: SparseGeometry,
    sample_order: SampleOrder,
    // Properties of the uploaded frame.
    /// Depth and motion, if sparse frames have them at their samples alone.
    previous_from_current: Option<[[f32; 4]; 4]>,
    cut: bool,
    /// Frames since the last history reset.
    index: u64,
}

fn desc(geometry: &ViewGeometry, settings: Settings) -> ContextDesc {
    ContextDesc { settings, ..ContextDesc::new(geometry.size_px()) }
}

impl ViewPipeline {
    /// Creates textures of `geometry`'s size. `settings` returns a method's settings, foveation included.
    pub fn new(
        gpu: &Arc<Headless>,
        geometry: ViewGeometry,
        state: &State,
        (sparse_geometry, sample_order): (SparseGeometry, SampleOrder),
        settings: &dyn Fn(Shows) -> Settings,
    ) -> Result<Self, Failure> {
        let desc = desc(&geometry, settings(Shows::Post(Method::None)));
        let mut pipeline = Self {
            inputs: DeviceInputs::new(gpu, &desc, FORMATS)?,
            runs: vec![],
            examiner: None,
            desc,
            sparse_geometry,
            sample_order,
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
        self.desc = desc(&self.geometry, settings(Shows::Post(Method::None)));
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
                Some(_) => self.runs[i] = self.side_run(shows, settings)?,
                None => self.runs.push(self.side_run(shows, settings)?),
            }
        }
        self.forget();
        Ok(())
    }

    fn side_run(&self, shows: Shows, settings: &dyn Fn(Shows) -> Settings) -> Result<SideRun, Failure> {
        let new = |_| DeviceRun::new(&self.gpu, &desc(&self.geometry, settings(shows)), FORMATS);
        Ok(SideRun { shows, run: shows.method().map(new).transpose()? })
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
    pub fn upload(&mut self, frame: &SourceFrame) {
        self.inputs.upload(frame);
        self.previous_from_current = frame.previous_from_current;
        self.cut = frame.cut;
    }

    /// Foveates the uploaded frame around `gaze_px` and runs the methods. `again`: the frame is that of the last call,
    /// so motion is zero.
    pub fn show(
        &mut self,
        gaze_px: [f32; 2],
        again: bool,
        state: &State,
        times: &mut PassTimes,
    ) -> Result<(), Failure> {
        let foveation = &self.desc.settings.foveation;
        let is_sparse = foveation.filter == Filter::Sparse;
        let lattices = is_sparse.then(|| {
            let lattices = self.sample_order.lattices(foveation, &self.geometry, gaze_px, self.index);
            self.sparse_geometry.of(lattices)
        });
        let views = [ViewFrame {
            previous_from_current: self.previous_from_current.filter(|_| !again),
            lattices,
            ..ViewFrame::new(self.geometry, Gaze::At { px: gaze_px })
        }];
        let gpu = &self.gpu;
        times.pass(gpu, Pass::Foveation, |encoder, timestamps| self.inputs.foveate(encoder, &views, timestamps))?;
        // A cut resets the history once, not again each time its frame is shown.
        let cut = std::mem::take(&mut self.cut);
        let reset = if cut || self.index == 0 { Reset::All } else { Reset::None };
        let frame = self.inputs.frame(&views, self.index, reset, false);
        let frame = if again { self.inputs.again(frame) } else { frame };
        // The doctor does not know sparse frames.
        if state.is_examined && !is_sparse {
            let examiner = match &mut self.examiner {
                Some(examiner) => examiner,
                none => none.insert(Examiner::new(gpu, &self.desc)?),
            };
            examiner.look(gpu, &frame)?;
        } else {
            self.examiner = None;
        }
        for (side, pass) in self.runs.iter_mut().zip([Pass::Left, Pass::Right]) {
            let Some(run) = &mut side.run else { continue };
            if let Some(debug) = state.debug {
                let mut encoder = gpu.device.create_command_encoder(&Default::default());
                run.record_view(&mut encoder, &frame, debug.view())?;
                gpu.queue.submit([encoder.finish()]);
            }
            times.pass(gpu, pass, |encoder, timestamps| run.record(encoder, &frame, timestamps).map(drop))?;
        }
        self.index += 1;
        Ok(())
    }

    /// What is found about the inputs; nothing unless they are checked.
    pub fn findings(&self) -> Vec<Finding> {
        self.examiner.as_ref().map(Examiner::findings).unwrap_or_default()
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
