//! Constants of a view for the passes of both executors.

use crate::context::ContextDesc;
use crate::convention::DepthConvention;
use crate::frame::{Exposure, FrameInputs, Reset};
#[cfg(feature = "cpu")]
use crate::kernel::lens;
#[cfg(feature = "cpu")]
use crate::kernel::reproject::ViewMotion;
use crate::kernel::rng::{self, Purpose};
use crate::settings::Sampler;
use crate::view::ViewFrame;
use glam::DVec2;
#[cfg(feature = "cpu")]
use glam::Vec3;

/// Largest number of views of a context ([`ContextDesc::view_count`]) on a GPU.
#[cfg(feature = "gpu")]
pub const MAX_VIEWS: usize = 4;

/// Numbers of the bindings of a frame's inputs and outputs are below this one.
pub const ORIGINS: usize = 16;

/// Twin of `ViewUniforms` in `shaders/shared/view_uniforms.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
pub struct ViewUniforms {
    /// Change of a ray's x and y per pixel.
    pub ray_scale: [f32; 2],
    /// x and y of the ray through pixel (0, 0); its z is 1.
    pub ray_offset: [f32; 2],
    /// Ray through the gaze; the last element is unused.
    pub gaze_ray: [f32; 4],
    /// Third row of the current-to-previous view transform.
    pub depth_row: [f32; 4],
    /// Key of the view's random stream.
    pub key: u32,
    /// `a` and `b` of the `DisparityMap`.
    pub disparity_a: f32,
    pub disparity_b: f32,
    /// Bit 0: `DisparityMap::invert`; bit 1: `DisparityMap::clamp`.
    pub disparity_flags: u32,
    /// Vector in pixels to add to a converted motion vector, so that it contains no jitter.
    pub motion_offset: [f32; 2],
    /// Jitter of this frame.
    pub jitter_px: [f32; 2],
    /// First pixel of the view in each input and output, by the number of its binding: x in the low half, y in the high
    /// half.
    pub origins: [u32; ORIGINS],
    /// Lowest x, y, x + y and x - y of the visible pixels.
    pub lowest_px: [f32; 4],
    /// Highest x, y, x + y and x - y of the visible pixels.
    pub highest_px: [f32; 4],
}

/// Camera motion of a view, for pixels whose vectors lack it. Twin of `CameraUniforms` in
/// `shaders/shared/inputs.wgsl`. Fields without a comment are those of `ViewMotion`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
pub struct CameraUniforms {
    pub x: [f32; 4],
    pub y: [f32; 4],
    pub z: [f32; 4],
    pub per_tangent: [f32; 2],
    pub zoom: [f32; 2],
    pub shift_px: [f32; 2],
    pub ahead: f32,
    pub sky: f32,
    /// Vector, as given, of pixels that have none.
    pub no_vector: [f32; 2],
    /// Whether these constants are of this frame's camera motion: 0 if that is not known.
    pub is_known: u32,
    /// Padding to a multiple of 16 bytes.
    pub unused: u32,
}

impl CameraUniforms {
    /// Constants of a view. `state`: the view's state [after](ViewState::with) this frame.
    pub(crate) fn new(desc: &ContextDesc, view: &ViewFrame, state: &ViewState) -> Self {
        let rays = view.geometry.scale_offset();
        let (scale, offset) = rays;
        let (old_scale, old_offset) = state.previous_rays.unwrap_or(rays);
        // Doubles: differences of nearly equal numbers.
        let double = |values: [f32; 2]| DVec2::from(values.map(f64::from));
        let [scale, offset, old_scale, old_offset] = [scale, offset, old_scale, old_offset].map(double);
        let convention = view.depth_convention(desc);
        let has_rays = !matches!(convention, DepthConvention::Orthographic { .. });
        let is_known = has_rays && view.previous_from_current.is_some();
        let mut rows = view.previous_from_current.unwrap_or(IDENTITY);
        let ahead = rows[2][2];
        (0..3).for_each(|i| rows[i][i] -= 1.0);
        Self {
            x: rows[0],
            y: rows[1],
            z: rows[2],
            per_tangent: old_scale.recip().as_vec2().into(),
            zoom: (old_scale.recip() - scale.recip()).as_vec2().into(),
            shift_px: (offset / scale - old_offset / old_scale).as_vec2().into(),
            ahead,
            sky: convention.sky_disparity(),
            no_vector: desc.motion.finite_no_vector(),
            is_known: u32::from(is_known),
            unused: 0,
        }
    }

    /// These constants as the kernel takes them.
    #[cfg(feature = "cpu")]
    pub(crate) fn motion(&self) -> ViewMotion {
        ViewMotion {
            x: self.x.into(),
            y: self.y.into(),
            z: self.z.into(),
            per_tangent: self.per_tangent.into(),
            zoom: self.zoom.into(),
            shift_px: self.shift_px.into(),
            ahead: self.ahead,
            sky: self.sky,
        }
    }
}

/// Camera motion of a camera that stands still.
const IDENTITY: [[f32; 4]; 4] =
    [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]];

/// Scale and offset of the rays of a view.
type Rays = ([f32; 2], [f32; 2]);

/// State of a view that a context holds from frame to frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct ViewState {
    /// Last known gaze position, if any.
    pub gaze_px: Option<[f32; 2]>,
    /// Jitter of this frame.
    pub jitter_px: [f32; 2],
    /// Jitter of the previous frame.
    pub previous_jitter_px: [f32; 2],
    /// Rays of this frame, without jitter.
    pub rays: Option<Rays>,
    /// Rays of the previous frame, if it had the same size.
    pub previous_rays: Option<Rays>,
    /// Factor on the colors of this frame.
    pub exposure: Option<f32>,
    /// Factor on the colors of the previous frame.
    pub previous_exposure: Option<f32>,
}

impl ViewState {
    /// This state after a frame with this description of the view.
    pub fn with(self, view: &ViewFrame, exposure: Exposure) -> Self {
        Self {
            gaze_px: Some(view.gaze.resolve(self.gaze_px, &view.geometry)),
            jitter_px: view.jitter_px,
            previous_jitter_px: self.jitter_px,
            rays: Some(view.geometry.scale_offset()),
            previous_rays: self.rays,
            exposure: Some(exposure.of_colors()),
            previous_exposure: self.exposure,
        }
    }

    /// Factor of the frame on stored colors. This is the state [after](Self::with) it.
    pub fn stored_exposure<C, S, V>(&self, frame: &FrameInputs<'_, C, S, V>) -> f32 {
        frame.exposure.of_stored(self.previous_exposure.filter(|_| frame.reset == Reset::None))
    }
}

impl ViewUniforms {
    /// Constants of view `index` of frame `frame`. `state`: the view's state [after](ViewState::with) this frame.
    pub(crate) fn new(desc: &ContextDesc, view: &ViewFrame, state: &ViewState, index: usize, frame: u64) -> Self {
        let (ray_scale, offset) = view.geometry.scale_offset();
        let settings = &desc.settings;
        let purpose = match settings.method.wrs().sampler {
            Sampler::AChao | Sampler::AChaoMean => Purpose::Select,
            Sampler::AEs => Purpose::Key,
        };
        let [x, y, z] = view.geometry.ray(view.gaze.resolve(state.gaze_px, &view.geometry));
        let disparity = view.depth_convention(desc).disparity_map();
        let jitter = view.jitter_px;
        let [lowest_px, highest_px] = view.visible_px.unwrap_or([[f32::MIN; 4], [f32::MAX; 4]]);
        Self {
            ray_scale,
            // A pixel shows the point at its position minus the jitter.
            ray_offset: [offset[0] - jitter[0] * ray_scale[0], offset[1] - jitter[1] * ray_scale[1]],
            gaze_ray: [x, y, z, 0.0],
            depth_row: view.depth_row(),
            key: rng::stream_key(settings.seed, index as u32, purpose, frame),
            disparity_a: disparity.a,
            disparity_b: disparity.b,
            disparity_flags: disparity.flags(),
            motion_offset: desc.motion.jitter_offset(jitter, state.previous_jitter_px),
            jitter_px: jitter,
            lowest_px,
            highest_px,
            ..Self::default()
        }
    }

    /// `Foveation::region_angle_deg` of a ray. Twin: `shaders/shared/view_uniforms.wgsl`.
    #[cfg(feature = "cpu")]
    #[inline(always)]
    pub(crate) fn region_angle_deg(&self, ray: Vec3) -> f32 {
        let [x, y, z, _] = self.gaze_ray;
        lens::eccentricity_deg(ray, Vec3::new(x, y, z))
    }
}
