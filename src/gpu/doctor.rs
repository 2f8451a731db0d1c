//! Checker of a renderer's inputs, recorded into the caller's command encoder.

use super::buffer::filled;
use super::compute::{ComputeShader, Sources};
use super::input::{check_buffer, check_inputs};
use super::plane::{Plane, PlaneDesc, layer_view};
use super::{Frame, Textures};
use crate::context::ContextDesc;
use crate::doctor::{Chart, Description, Door, Finding, Observation, StillSurfaces, maps, tile_count};
use crate::error::{CreateError, FrameError};
use crate::kernel::doctor::{HYPOTHESES, WORDS};
use crate::kernel::foveate::level_len;
use crate::uniforms::CameraUniforms;
use bytemuck::{Pod, Zeroable};
use std::collections::VecDeque;
use wgpu::{BindingResource, Buffer, BufferUsages, CommandEncoder, ComputePassDescriptor, Device, TextureFormat};

/// Largest number of frames that may be recorded before the words of the first one are read.
const PENDING: usize = 16;

/// `DoctorUniforms` in `shaders/shared/doctor_pass.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
struct DoctorUniforms {
    size: [u32; 2],
    /// First pixel of the view in the color input: x in the low half, y in the high half.
    color_origin: u32,
    /// The same for depth.
    depth_origin: u32,
    /// The same for motion vectors.
    motion_origin: u32,
    /// Factor on colors.
    exposure: f32,
    /// `flags` of the `DisparityMap`.
    disparity_flags: u32,
    /// Padding to a multiple of 8 bytes.
    unused: u32,
    /// Change of a ray's x and y per pixel.
    ray_scale: [f32; 2],
    /// x and y of the ray through pixel (0, 0); its z is 1.
    ray_offset: [f32; 2],
    /// Jitter of the previous frame less that of this one.
    jitter_px: [f32; 2],
    /// `a` and `b` of the `DisparityMap`.
    disparity: [f32; 2],
    /// `ViewMotion`, and 16 bytes that are not read.
    camera: CameraUniforms,
    maps: [[f32; 4]; HYPOTHESES as usize],
}

impl DoctorUniforms {
    /// Those of surfaces that stand still; zeros elsewhere, and without any.
    fn of_still(still: Option<StillSurfaces>) -> Self {
        let Some(StillSurfaces { ray_scale, ray_offset, disparity, camera, jitter_px }) = still else {
            return Self::zeroed();
        };
        let (a, b, disparity_flags) = (disparity.a, disparity.b, disparity.flags());
        Self { ray_scale, ray_offset, jitter_px, disparity: [a, b], disparity_flags, camera, ..Self::zeroed() }
    }
}

/// Checks whether a renderer's frames match their description: motion vectors, depth, colors, gaze and foveation of one
/// view. [`Afterimage::doctor`](crate::Afterimage::doctor) of either door makes it.
///
/// Give it some consecutive frames in which the camera moves and the eye looks around; shade planned frames at full
/// rate. `record` never submits, maps or waits: the caller reads its buffer back at any later time, and gives the bytes
/// to [`read`](Self::read). `examples/05_doctor.rs` is a whole program.
#[derive(Debug)]
pub struct Doctor {
    chart: Chart,
    roots_pass: ComputeShader,
    pass: ComputeShader,
    /// Roots of the last frame, and of the frame before it.
    roots: [Plane; 2],
    absent: Plane,
    pending: VecDeque<Observation>,
}

impl Doctor {
    /// A doctor that has seen no frame yet, for view `view` of a context with the description `desc`.
    ///
    /// # Errors
    /// [`CreateError`] if the description is out of range, or has no such view, or a limit of the device is too low.
    #[doc(hidden)]
    pub fn new(device: &Device, desc: &ContextDesc, view: usize) -> Result<Self, CreateError> {
        Self::with(device, desc, view, Door::Context, &Sources::default())
    }

    /// A doctor for planned frames with one view, whose findings name the types of that API.
    pub(crate) fn of_planned(device: &Device, desc: &ContextDesc) -> Result<Self, CreateError> {
        Self::with(device, desc, 0, Door::Planned, &Sources::default())
    }

    /// A doctor with other texts of its passes, for tests that plant errors.
    #[doc(hidden)]
    pub fn with_sources(
        device: &Device,
        desc: &ContextDesc,
        view: usize,
        sources: &Sources,
    ) -> Result<Self, CreateError> {
        Self::with(device, desc, view, Door::Context, sources)
    }

    fn with(
        device: &Device,
        desc: &ContextDesc,
        view: usize,
        door: Door,
        sources: &Sources,
    ) -> Result<Self, CreateError> {
        super::validate(device, desc, TextureFormat::Rgba16Float)?;
        let chart = Chart::new(desc, view, door)?;
        let roots = |size| PlaneDesc::new("afterimage doctor roots", TextureFormat::R32Float, size, 1).create(device);
        let half = desc.size_px.map(|s| level_len(s, 1));
        Ok(Self {
            chart,
            roots_pass: sources.shader(device, "doctor_roots_pass"),
            pass: sources.shader(device, "doctor_pass"),
            roots: [half; 2].map(roots),
            absent: roots([1, 1]),
            pending: VecDeque::new(),
        })
    }

    /// Size in bytes of the words that a frame writes.
    pub fn words_bytes(&self) -> u64 {
        4 * u64::from(WORDS) * u64::from(tile_count(self.chart.desc.size_px).max(1))
    }

    /// Records the examination of a frame into `encoder`. Give it the same frames as the post-process. Writes `words`:
    /// a buffer of [`words_bytes`](Self::words_bytes) with the usages `STORAGE`, `COPY_DST` and (to read it back)
    /// `COPY_SRC`.
    ///
    /// # Errors
    /// [`FrameError`] if a texture, buffer or value does not fit the context; then nothing was recorded.
    pub fn record(
        &mut self,
        device: &Device,
        encoder: &mut CommandEncoder,
        frame: &Frame<'_>,
        words: &Buffer,
    ) -> Result<(), FrameError> {
        check_inputs(&self.chart.desc, frame)?;
        check_buffer("words", words, self.words_bytes(), "at least Doctor::words_bytes")?;
        let observation = self.chart.next(frame);
        self.dispatch(device, encoder, frame, &observation.now, words);
        self.roots.swap(0, 1);
        if self.pending.len() == PENDING {
            self.pending.pop_front();
        }
        self.pending.push_back(observation);
        Ok(())
    }

    /// Takes the words of the earliest recorded frame that has not been read, as the device wrote them. `false` without
    /// such a frame, or with too few bytes.
    pub fn read(&mut self, words: &[u8]) -> bool {
        let Some(bytes) = words.get(..self.words_bytes() as usize) else { return false };
        let Some(mut observation) = self.pending.pop_front() else { return false };
        let count = observation.now.tiles.len() * WORDS as usize;
        let word = |b: &[u8]| u32::from_le_bytes([b[0], b[1], b[2], b[3]]);
        observation.words = bytes.chunks_exact(4).take(count).map(word).collect();
        self.chart.add(observation);
        true
    }

    /// One finding for each [`Check`](crate::doctor::Check), from all frames read so far (the last 16).
    pub fn findings(&self) -> Vec<Finding> {
        self.chart.findings()
    }

    fn dispatch(
        &self,
        device: &Device,
        encoder: &mut CommandEncoder,
        frame: &Frame<'_>,
        now: &Description,
        words: &Buffer,
    ) {
        let label = Some("afterimage doctor");
        let mut pass = encoder.begin_compute_pass(&ComputePassDescriptor { label, timestamp_writes: None });
        let Chart { desc, view, .. } = self.chart;
        let bind = |textures: Textures<'_>| {
            let (texture, layer) = textures.parts().nth(if textures.is_regions() { view } else { 0 })?;
            Some(layer_view(texture, layer.or(Some(view as u32))))
        };
        let optional =
            |textures: Option<Textures<'_>>| textures.and_then(bind).unwrap_or_else(|| self.absent.whole.clone());
        let [color, depth, motion] = [Some(frame.color), frame.depth, frame.motion].map(optional);
        let origin = |textures: Option<Textures<'_>>| textures.map_or(0, |t| t.packed_origin(view));
        let [w, h] = desc.size_px;
        let exposure = frame.exposure.of_colors();
        let bytes = [w, h, origin(Some(frame.color)), exposure.to_bits()];
        let uniforms = filled(device, "afterimage doctor view", bytemuck::bytes_of(&bytes), BufferUsages::UNIFORM);
        let resources = [
            uniforms.as_entire_binding(),
            BindingResource::TextureView(&color),
            BindingResource::TextureView(&self.roots[0].whole),
        ];
        let group = self.roots_pass.group(device, resources);
        let half = [w, h].map(|s| level_len(s, 1));
        self.roots_pass.dispatch(device, &mut pass, &[], &group, half, 1);

        let uniforms = DoctorUniforms {
            size: [w, h],
            color_origin: origin(Some(frame.color)),
            depth_origin: origin(frame.depth),
            motion_origin: origin(frame.motion),
            exposure,
            maps: maps(&desc),
            ..DoctorUniforms::of_still(now.still)
        };
        let uniforms = filled(device, "afterimage doctor", bytemuck::bytes_of(&uniforms), BufferUsages::UNIFORM);
        let tiles: Vec<[u32; 4]> =
            now.tiles.iter().map(|t| [t.origin_px[0], t.origin_px[1], t.lattice_level, 0]).collect();
        if tiles.is_empty() {
            return;
        }
        let tiles = filled(device, "afterimage doctor tiles", bytemuck::cast_slice(&tiles), BufferUsages::STORAGE);
        // The first frame is compared with itself, and the result is not used.
        let past = &self.roots[usize::from(now.has_past)].whole;
        let textures = [&color, &depth, &motion, &self.roots[0].whole, past];
        let resources = std::iter::once(uniforms.as_entire_binding())
            .chain(textures.map(BindingResource::TextureView))
            .chain([tiles.as_entire_binding(), words.as_entire_binding()]);
        let group = self.pass.group(device, resources);
        let flag = |is_there: bool| u32::from(is_there);
        let overrides = [
            ("HAS_DEPTH", flag(frame.depth.is_some())),
            ("HAS_MOTION", flag(frame.motion.is_some())),
            ("HAS_CAMERA", flag(now.still.is_some())),
        ];
        pass.set_pipeline(&self.pass.pipeline(device, &overrides));
        pass.set_bind_group(0, &group, &[]);
        pass.dispatch_workgroups(now.tiles.len() as u32, 1, 1);
    }

    /// Words of the frames read so far, oldest first.
    pub fn words(&self) -> Vec<&[u32]> {
        self.chart.words()
    }
}
