//! A session: its swapchains, its space, its frames. A headset begins another one when the runtime loses it.

use crate::chain::Chain;
use crate::error::Error;
use crate::vulkan::{DEPTH, Format, Gpu, srgb_format};
use openxr as xr;
use wgpu_30::Texture;
use xr::sys;

pub(crate) const VIEWS: xr::ViewConfigurationType = xr::ViewConfigurationType::PRIMARY_STEREO;

/// What the lens of an eye hides: triangles in the plane one unit ahead of the eye, y up. Draw them at the near plane
/// before the scene, and nothing is shaded there.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HiddenMesh {
    /// x and y of the vertices.
    pub vertices: Vec<[f32; 2]>,
    /// Three for each triangle.
    pub indices: Vec<u32>,
}

/// Dropped in this order.
pub(crate) struct Session {
    color: Chain,
    /// Depth of what is shown, if the runtime takes it.
    depth: Option<Chain>,
    pub space: xr::Space,
    /// Of the application's pose actions, each made at its first use.
    poses: Vec<(sys::Action, xr::Path, xr::Space)>,
    pub stream: xr::FrameStream<xr::Vulkan>,
    pub waiter: xr::FrameWaiter,
    pub session: xr::Session<xr::Vulkan>,
    formats: Formats,
    pub is_running: bool,
}

/// Formats of a session's swapchains.
#[derive(Clone, Copy)]
pub(crate) struct Formats {
    pub color: Format,
    /// `None` if the runtime takes no depth.
    pub depth: Option<Format>,
}

impl Formats {
    fn new(instance: &xr::Instance, session: &xr::Session<xr::Vulkan>) -> Result<Self, Error> {
        let available = session.enumerate_swapchain_formats()?;
        let color = srgb_format(&available).ok_or(Error::Runtime("has no swapchain of 8 bits and sRGB"))?;
        let takes_depth = instance.exts().khr_composition_layer_depth.is_some() && available.contains(&DEPTH.raw);
        Ok(Self { color, depth: takes_depth.then_some(DEPTH) })
    }

    fn chains(
        self,
        session: &xr::Session<xr::Vulkan>,
        gpu: &Gpu,
        size: [u32; 2],
    ) -> Result<(Chain, Option<Chain>), Error> {
        let chain = |format| Chain::new(session, gpu, size, format);
        Ok((chain(self.color)?, self.depth.map(chain).transpose()?))
    }
}

impl Session {
    pub fn new(instance: &xr::Instance, system: xr::SystemId, gpu: &Gpu, size: [u32; 2]) -> Result<Self, Error> {
        let (session, waiter, stream) = gpu.session(instance, system)?;
        let space = session.create_reference_space(xr::ReferenceSpaceType::LOCAL, xr::Posef::IDENTITY)?;
        let formats = Formats::new(instance, &session)?;
        let (color, depth) = formats.chains(&session, gpu, size)?;
        Ok(Self { color, depth, space, poses: vec![], stream, waiter, session, formats, is_running: false })
    }

    /// Swapchains of another size.
    pub fn resize(&mut self, gpu: &Gpu, size: [u32; 2]) -> Result<(), Error> {
        (self.color, self.depth) = self.formats.chains(&self.session, gpu, size)?;
        Ok(())
    }

    /// Formats of the images that [`show`](Self::show) draws.
    pub fn formats(&self) -> Formats {
        self.formats
    }

    /// Pose of an action in the world; `None` where it is not tracked.
    pub fn pose(
        &mut self,
        action: &xr::Action<xr::Posef>,
        path: xr::Path,
        time: xr::Time,
    ) -> Result<Option<xr::Posef>, sys::Result> {
        let known = self.poses.iter().position(|(of, at, _)| *of == action.as_raw() && *at == path);
        let i = match known {
            Some(i) => i,
            None => {
                let space = action.create_space(&self.session, path, xr::Posef::IDENTITY)?;
                self.poses.push((action.as_raw(), path, space));
                self.poses.len() - 1
            }
        };
        let found = self.poses[i].2.locate(&self.space, time)?;
        let needed = xr::SpaceLocationFlags::ORIENTATION_VALID
            | xr::SpaceLocationFlags::ORIENTATION_TRACKED
            | xr::SpaceLocationFlags::POSITION_VALID;
        Ok(found.location_flags.contains(needed).then_some(found.pose))
    }

    /// Waits for a frame, synchronises `sets`, and locates the views; `None` if nothing is to be shown.
    pub fn next_views(
        &mut self,
        blend: xr::EnvironmentBlendMode,
        sets: &[&xr::ActionSet],
    ) -> Result<Option<(xr::Time, Vec<xr::View>)>, sys::Result> {
        let state = self.waiter.wait()?;
        self.stream.begin()?;
        let time = state.predicted_display_time;
        if state.should_render {
            let (flags, views) = self.session.locate_views(VIEWS, time, &self.space)?;
            // Poses that were never known cannot be drawn for; those that were lost are the runtime's best guess.
            let known = xr::ViewStateFlags::ORIENTATION_VALID | xr::ViewStateFlags::POSITION_VALID;
            if flags.contains(known) && views.len() == 2 {
                let active: Vec<_> = sets.iter().map(|set| xr::ActiveActionSet::new(set)).collect();
                if !active.is_empty() {
                    self.session.sync_actions(&active)?;
                }
                return Ok(Some((time, views)));
            }
        }
        self.stream.end(time, blend, &[])?;
        Ok(None)
    }

    /// Draws the next images of the swapchains: color, and depth if the runtime takes it.
    pub fn show(&mut self, draw: impl FnOnce(&Texture, Option<&Texture>)) -> Result<(), sys::Result> {
        let color = self.color.acquire()?;
        draw(color, self.depth.as_mut().map(Chain::acquire).transpose()?);
        self.color.release()?;
        self.depth.as_mut().map_or(Ok(()), Chain::release)
    }

    /// Shows the images that were drawn last, as two layers. `near_m`: distance of the near plane.
    #[expect(unsafe_code, reason = "the crate of OpenXR has no builder for the depth of a layer")]
    pub fn end(
        &mut self,
        time: xr::Time,
        blend: xr::EnvironmentBlendMode,
        views: &[xr::View],
        near_m: f32,
    ) -> Result<(), sys::Result> {
        let depths = self.depth.as_ref().map(|depth| {
            [0, 1].map(|eye| sys::CompositionLayerDepthInfoKHR {
                ty: sys::CompositionLayerDepthInfoKHR::TYPE,
                next: std::ptr::null(),
                sub_image: depth.layer(eye).into_raw(),
                min_depth: 0.0,
                max_depth: 1.0,
                // Depth is reversed: 0 is infinitely far away.
                near_z: f32::INFINITY,
                far_z: near_m,
            })
        });
        let eye = |i: usize| {
            let view = xr::CompositionLayerProjectionView::new();
            let mut raw = view.pose(views[i].pose).fov(views[i].fov).sub_image(self.color.layer(i)).into_raw();
            raw.next = depths.as_ref().map_or(std::ptr::null(), |depths| std::ptr::from_ref(&depths[i]).cast());
            // SAFETY: `depths` and both swapchains outlive the call that the view is given to.
            unsafe { xr::CompositionLayerProjectionView::from_raw(raw) }
        };
        let eyes = [eye(0), eye(1)];
        let layer = xr::CompositionLayerProjection::new().space(&self.space).views(&eyes);
        self.stream.end(time, blend, &[&layer])
    }

    /// What the lens hides, and the outline of what it shows; `None` where the runtime does not say.
    pub fn lens(&self, instance: &xr::Instance, eye: u32) -> Option<(HiddenMesh, Vec<[f32; 2]>)> {
        instance.exts().khr_visibility_mask?;
        let mask = |kind| self.session.get_visibility_mask_khr(VIEWS, eye, kind).ok();
        let hidden = mask(xr::VisibilityMaskTypeKHR::HIDDEN_TRIANGLE_MESH)?;
        let shown = mask(xr::VisibilityMaskTypeKHR::VISIBLE_TRIANGLE_MESH)?;
        let points = |vertices: &[xr::Vector2f]| vertices.iter().map(|v| [v.x, v.y]).collect::<Vec<_>>();
        let mesh = HiddenMesh { vertices: points(&hidden.vertices), indices: hidden.indices };
        (!mesh.indices.is_empty() && !shown.vertices.is_empty()).then(|| (mesh, points(&shown.vertices)))
    }
}
