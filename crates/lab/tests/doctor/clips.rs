//! Clips of moving pictures, foveated by the simulators.

use afterimage::cpu;
use afterimage::doctor::Finding;
use afterimage::internal::{ContextDesc, Foveation, FoveationKind, Pyramid, Reset, ViewFrame};
use afterimage::{DepthConvention, Gaze, Image, MotionConvention, ViewGeometry};
use afterimage_lab::frame::SourceFrame;
use afterimage_lab::source::{self, ReadLimits, SceneOptions};

/// Full-rate frames.
pub struct Clip {
    pub name: String,
    pub geometry: ViewGeometry,
    pub frames: Vec<SourceFrame>,
}

impl Clip {
    /// Frames `from` and the following ones of an input, relative to the workspace.
    pub fn open(name: &str, size: Option<[u32; 2]>, from: u64, count: u64) -> Self {
        let path = match name.split_once(':') {
            Some(_) => name.to_owned(),
            None => afterimage_testing::workspace().join(name).to_string_lossy().into_owned(),
        };
        let options = SceneOptions { size, ..SceneOptions::default() };
        let mut source = source::open(&path, &ReadLimits::default(), &options).unwrap();
        let info = source.info().clone();
        Self {
            name: name.to_owned(),
            geometry: ViewGeometry::flat(info.size, info.hfov_deg.unwrap_or(70.0)).unwrap(),
            frames: (from..from + count).map(|i| source.frame(i).unwrap()).collect(),
        }
    }

    pub fn size(&self) -> [u32; 2] {
        self.geometry.size_px()
    }
}

/// A frame as a renderer delivers it, and what it says about it.
#[derive(Clone)]
pub struct Delivered {
    pub color: Image<[f32; 3]>,
    pub depth: Option<Image<f32>>,
    pub motion: Option<Image<[f32; 2]>>,
    pub view: ViewFrame,
}

/// A renderer's frames with their description.
#[derive(Clone)]
pub struct Delivery {
    pub desc: ContextDesc,
    pub frames: Vec<Delivered>,
}

/// Gaze of frame `index` of `count`: it drifts, and jumps once.
pub fn eye(size: [u32; 2], index: usize, count: usize) -> [f32; 2] {
    let [w, h] = size.map(|s| s as f32);
    let base = if index < count / 2 { [0.68, 0.30] } else { [0.30, 0.66] };
    [w * base[0] + 0.4 * index as f32, h * base[1] + 0.25 * index as f32]
}

/// Reversed depth, with which all clips are delivered rightly.
pub const REVERSED: DepthConvention = DepthConvention::Reversed { near: 0.1, far: f32::INFINITY };
/// The same, not reversed.
pub const FORWARD: DepthConvention = DepthConvention::Forward { near: 0.1, far: f32::INFINITY };

/// Value that `convention` stores for a distance.
pub fn stored(convention: DepthConvention, z: f32) -> f32 {
    match convention {
        DepthConvention::Reversed { near, .. } => (near / z).clamp(0.0, 1.0),
        DepthConvention::Forward { near, .. } => (1.0 - near / z).clamp(0.0, 1.0),
        _ => z,
    }
}

impl Delivery {
    /// The clip foveated as `foveation` says, rightly described.
    pub fn right(clip: &Clip, foveation: Foveation) -> Self {
        Self::looking(clip, foveation, |i| eye(clip.size(), i, clip.frames.len()))
    }

    /// The same, with the gaze at `gaze_px` in each frame.
    pub fn looking(clip: &Clip, foveation: Foveation, gaze_px: impl Fn(usize) -> [f32; 2]) -> Self {
        let mut desc = ContextDesc::new(clip.size());
        desc.settings.foveation = foveation;
        desc.depth = REVERSED;
        desc.motion = MotionConvention::default();
        let frames = clip.frames.iter().enumerate().map(|(i, frame)| {
            let (px, previous_from_current) = (gaze_px(i), frame.previous_from_current);
            Delivered {
                color: foveated(&frame.color, &foveation, &clip.geometry, px),
                depth: frame.depth.as_ref().map(|d| d.map(|z| stored(REVERSED, z))),
                motion: frame.motion.clone(),
                view: ViewFrame { previous_from_current, ..ViewFrame::new(clip.geometry, Gaze::At { px }) },
            }
        });
        Self { desc, frames: frames.collect() }
    }

    /// What the doctor says.
    pub fn findings(&self) -> Vec<Finding> {
        let mut doctor = cpu::Doctor::new(&self.desc, 0).unwrap();
        for (i, f) in self.frames.iter().enumerate() {
            let (color, views) = ([&f.color], [f.view]);
            let depth = f.depth.as_ref().map(|d| [d]);
            let motion = f.motion.as_ref().map(|m| [m]);
            let frame = cpu::Frame {
                depth: depth.as_ref().map(|d| &d[..]),
                motion: motion.as_ref().map(|m| &m[..]),
                reset: if i == 0 { Reset::All } else { Reset::None },
                ..cpu::Frame::new(&color, &views, i as u64)
            };
            doctor.observe(&frame).unwrap();
        }
        doctor.findings()
    }
}

/// A full-rate frame as a foveating renderer would have delivered it. The doctor sees frames by quads at full rate.
pub fn foveated(
    full: &Image<[f32; 3]>,
    foveation: &Foveation,
    geometry: &ViewGeometry,
    gaze_px: [f32; 2],
) -> Image<[f32; 3]> {
    if foveation.kind == FoveationKind::Quads {
        return full.clone();
    }
    let lods = foveation.lod_map(geometry, gaze_px);
    foveation.render(&Pyramid::new(full.clone(), foveation.max_level()), &lods)
}

/// Foveations of the clips: mip levels and blocks.
pub fn foveations() -> [Foveation; 2] {
    let regions = Foveation { fovea_deg: 16.0, mid_deg: 40.0, rate_mid: 4, rate_far: 8, ..Foveation::default() };
    let blocks = Foveation { kind: FoveationKind::Block, rate_mid: 2, rate_far: 4, ..regions };
    [Foveation { kind: FoveationKind::Mip, ..regions }, blocks]
}
