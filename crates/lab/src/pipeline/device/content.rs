//! Frames on a device, by the interface of the pipeline.

use crate::frame::{Content, DeviceContent, DeviceFrame, OnDevice};
use crate::raster;
use afterimage::Image;
use std::any::Any;
use std::sync::Arc;

impl OnDevice {
    /// A frame's content, if it is on a device.
    pub fn of(content: &Content) -> Option<&Self> {
        let Content::OnDevice(content) = content else { return None };
        (content.as_ref() as &dyn Any).downcast_ref()
    }
}

impl From<OnDevice> for Content {
    fn from(content: OnDevice) -> Self {
        Self::OnDevice(Arc::new(content))
    }
}

impl DeviceContent for OnDevice {
    fn lods(&self) -> Option<Image<f32>> {
        match self {
            Self::Composed(frame) => Some(frame.read_lod()),
            Self::Surfaces(_) => None,
        }
    }

    /// Pixels that are not finite are black, as in imported frames.
    fn read_color(&self) -> Option<Image<[f32; 3]>> {
        match self {
            Self::Composed(frame) => Some(frame.read_color()),
            Self::Surfaces(_) => Some(Image::filled([0; 2], [0.0; 3])),
        }
    }

    fn read_geometry(&self) -> Option<(Image<f32>, Image<[f32; 2]>)> {
        match self {
            Self::Surfaces(DeviceFrame { device, depth, motion, near, .. }) => {
                Some((raster::read_distance(device, depth, *near), device.read(motion, 0)))
            }
            Self::Composed(frame) => Some((frame.read_distance(), frame.read_motion())),
        }
    }
}
