//! A session: its swapchain, its space, its frames. A headset begins another one when the runtime loses it.

use crate::error::Error;
use crate::vulkan::{Gpu, srgb_format};
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
    pub images: Vec<Texture>,
    pub swapchain: xr::Swapchain<xr::Vulkan>,
    pub space: xr::Space,
    /// Of the application's pose actions, each made at its first use.
    poses: Vec<(sys::Action, xr::Path, xr::Space)>,
    pub stream: xr::FrameStream<xr::Vulkan>,
    pub waiter: xr::FrameWaiter,
    pub session: xr::Session<xr::Vulkan>,
    pub size: [u32; 2],
    pub is_running: bool,
}

impl Session {
    pub fn new(instance: &xr::Instance, system: xr::SystemId, gpu: &Gpu, size: [u32; 2]) -> Result<Self, Error> {
        let (session, waiter, stream) = gpu.session(instance, system)?;
        let space = session.create_reference_space(xr::ReferenceSpaceType::LOCAL, xr::Posef::IDENTITY)?;
        let (swapchain, images) = swapchain(&session, gpu, size)?;
        Ok(Self { images, swapchain, space, poses: vec![], stream, waiter, session, size, is_running: false })
    }

    /// A swapchain of another size.
    pub fn resize(&mut self, gpu: &Gpu, size: [u32; 2]) -> Result<(), Error> {
        (self.swapchain, self.images) = swapchain(&self.session, gpu, size)?;
        self.size = size;
        Ok(())
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

    /// Draws the next image of the swapchain.
    pub fn show(&mut self, draw: impl FnOnce(&Texture)) -> Result<(), sys::Result> {
        let image = self.swapchain.acquire_image()? as usize;
        self.swapchain.wait_image(xr::Duration::INFINITE)?;
        draw(&self.images[image]);
        self.swapchain.release_image()
    }

    /// Shows the image that was drawn last, as two layers.
    pub fn end(
        &mut self,
        time: xr::Time,
        blend: xr::EnvironmentBlendMode,
        views: &[xr::View],
    ) -> Result<(), sys::Result> {
        let [width, height] = self.size.map(|n| n as i32);
        let rect = xr::Rect2Di { offset: xr::Offset2Di { x: 0, y: 0 }, extent: xr::Extent2Di { width, height } };
        let eye = |i: usize| {
            let image =
                xr::SwapchainSubImage::new().swapchain(&self.swapchain).image_array_index(i as u32).image_rect(rect);
            xr::CompositionLayerProjectionView::new().pose(views[i].pose).fov(views[i].fov).sub_image(image)
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

fn swapchain(
    session: &xr::Session<xr::Vulkan>,
    gpu: &Gpu,
    size: [u32; 2],
) -> Result<(xr::Swapchain<xr::Vulkan>, Vec<Texture>), Error> {
    let formats = session.enumerate_swapchain_formats()?;
    let (raw_format, format) = srgb_format(&formats).ok_or(Error::Runtime("has no swapchain of 8 bits and sRGB"))?;
    let swapchain = session.create_swapchain(&xr::SwapchainCreateInfo {
        create_flags: xr::SwapchainCreateFlags::EMPTY,
        usage_flags: xr::SwapchainUsageFlags::COLOR_ATTACHMENT,
        format: raw_format,
        sample_count: 1,
        width: size[0],
        height: size[1],
        face_count: 1,
        array_size: 2,
        mip_count: 1,
    })?;
    let images = gpu.textures(&swapchain, size, format)?;
    Ok((swapchain, images))
}
