//! A swapchain whose images have a layer for each eye.

use crate::error::Error;
use crate::vulkan::{Format, Gpu};
use openxr as xr;
use wgpu_30::Texture;
use xr::sys;

/// Dropped in this order.
pub(crate) struct Chain {
    images: Vec<Texture>,
    swapchain: xr::Swapchain<xr::Vulkan>,
    size: [u32; 2],
}

impl Chain {
    pub fn new(session: &xr::Session<xr::Vulkan>, gpu: &Gpu, size: [u32; 2], format: Format) -> Result<Self, Error> {
        let usage_flags = match format.is_depth() {
            true => xr::SwapchainUsageFlags::DEPTH_STENCIL_ATTACHMENT,
            false => xr::SwapchainUsageFlags::COLOR_ATTACHMENT,
        };
        let swapchain = session.create_swapchain(&xr::SwapchainCreateInfo {
            create_flags: xr::SwapchainCreateFlags::EMPTY,
            usage_flags,
            format: format.raw,
            sample_count: 1,
            width: size[0],
            height: size[1],
            face_count: 1,
            array_size: 2,
            mip_count: 1,
        })?;
        let images = gpu.textures(&swapchain, size, format)?;
        Ok(Self { images, swapchain, size })
    }

    /// The next image, when it may be drawn into.
    pub fn acquire(&mut self) -> Result<&Texture, sys::Result> {
        let image = self.swapchain.acquire_image()? as usize;
        self.swapchain.wait_image(xr::Duration::INFINITE)?;
        Ok(&self.images[image])
    }

    /// Hands the acquired image to the runtime.
    pub fn release(&mut self) -> Result<(), sys::Result> {
        self.swapchain.release_image()
    }

    /// The whole layer of an eye in the image that was released last.
    pub fn layer(&self, eye: usize) -> xr::SwapchainSubImage<'_, xr::Vulkan> {
        let [width, height] = self.size.map(|n| n as i32);
        let rect = xr::Rect2Di { offset: xr::Offset2Di { x: 0, y: 0 }, extent: xr::Extent2Di { width, height } };
        xr::SwapchainSubImage::new().swapchain(&self.swapchain).image_array_index(eye as u32).image_rect(rect)
    }
}
