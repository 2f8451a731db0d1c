//! Frames on a device, by the interface of the pipeline.

use crate::frame::{Content, DeviceContent, DeviceFrame, OnDevice, SparseFrame};
use crate::lattices::levels;
use crate::raster;
use afterimage::{Image, Lattices};
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
    fn lattices(&self) -> Option<Lattices> {
        match self {
            Self::Atlas(frame) => Some(frame.lattices),
            Self::Samples(frame) => Some(frame.lattices),
            Self::Composed(_) | Self::Surfaces(_) => None,
        }
    }

    fn is_traced(&self) -> bool {
        matches!(self, Self::Samples(_))
    }

    fn lods(&self, size_px: [u32; 2]) -> Option<Image<f32>> {
        match self {
            Self::Atlas(frame) => Some(levels(&frame.lattices, size_px)),
            Self::Samples(frame) => Some(levels(&frame.lattices, size_px)),
            Self::Composed(frame) => Some(frame.read_lod()),
            Self::Surfaces(_) => None,
        }
    }

    /// Pixels that are not finite are black, as in imported frames.
    fn read_color(&self) -> Option<Image<[f32; 3]>> {
        match self {
            Self::Atlas(SparseFrame { atlas: DeviceFrame { device, color, .. }, .. }) => {
                let is_finite = |c: &[f32; 3]| c.iter().all(|v| v.is_finite());
                Some(raster::read_color(device, color).map(|c| if is_finite(&c) { c } else { [0.0; 3] }))
            }
            Self::Samples(_) => None,
            Self::Composed(frame) => Some(frame.read_color()),
            Self::Surfaces(_) => Some(Image::filled([0; 2], [0.0; 3])),
        }
    }

    fn read_geometry(&self) -> Option<(Image<f32>, Image<[f32; 2]>)> {
        match self {
            Self::Atlas(SparseFrame { atlas: DeviceFrame { device, depth, motion, near, .. }, .. })
            | Self::Surfaces(DeviceFrame { device, depth, motion, near, .. }) => {
                Some((raster::read_distance(device, depth, *near), device.read(motion, 0)))
            }
            Self::Samples(_) => None,
            Self::Composed(frame) => Some((frame.read_distance(), frame.read_motion())),
        }
    }
}
