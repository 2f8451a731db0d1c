//! Errors that tests must see.

use afterimage_openxr::{Headset, HeadsetFrame, openxr as xr, wgpu};
use clap::ValueEnum;

#[derive(Clone, Copy, PartialEq, ValueEnum)]
pub enum Plant {
    /// A buffer of 0 bytes, which Vulkan's validation must see.
    Vulkan,
    /// A reference space of an unknown type, which OpenXR's validation must see.
    Openxr,
    /// Each eye is drawn from the other one's place.
    Eyes,
    /// Motion vectors of a head that does not move.
    Motion,
    /// Each eye shades where the other one's quads were chosen.
    Quads,
    /// A frame is submitted without a choice of its quads.
    Choice,
}

impl Plant {
    pub fn before(self, headset: &Headset) {
        if self == Self::Vulkan {
            zero_bytes(headset.device());
        }
    }

    pub fn spoil(self, frame: &mut HeadsetFrame<'_>) {
        if self == Self::Openxr {
            let unknown = xr::ReferenceSpaceType::from_raw(9999);
            // The runtime refuses it, too.
            frame.session().create_reference_space(unknown, xr::Posef::IDENTITY).ok();
        }
        let [left, right] = &mut frame.eyes;
        match self {
            Self::Eyes => {
                std::mem::swap(&mut left.clip_from_world, &mut right.clip_from_world);
                std::mem::swap(&mut left.jittered_clip_from_world, &mut right.jittered_clip_from_world);
            }
            Self::Motion => {
                for eye in [left, right] {
                    eye.previous_clip_from_world = eye.clip_from_world;
                }
            }
            Self::Vulkan | Self::Openxr | Self::Quads | Self::Choice => {}
        }
    }

    /// The eye in whose depth an eye's colors are drawn.
    pub fn depth_of(self, eye: usize) -> usize {
        if self == Self::Quads { 1 - eye } else { eye }
    }
}

#[expect(unsafe_code, reason = "wgpu would refuse the call before Vulkan sees it")]
fn zero_bytes(device: &wgpu::Device) {
    let info = ash::vk::BufferCreateInfo::default().usage(ash::vk::BufferUsageFlags::UNIFORM_BUFFER);
    // SAFETY: not valid, on purpose: the validation layer reports it. Drivers create an empty buffer or refuse.
    unsafe {
        if let Some(device) = device.as_hal::<wgpu::hal::api::Vulkan>() {
            let _ = device.raw_device().create_buffer(&info, None);
        }
    }
}
