//! Layout of the scene buffer within the limits of a device.

use super::scenes::soup;
use afterimage_lab::rays::{Bvh, Geometry};
use afterimage_trace::scene_buffer::{SceneBufferBuilder, SceneBufferError, SceneBufferLimits, Section};
use glam::Vec3;

#[test]
fn a_heap_that_no_device_takes_is_refused() {
    let geometry =
        Geometry { still: Bvh::build(&soup("large", 3000, Vec3::ZERO, 1.0), None, &[]), ..Geometry::default() };
    for limits in [SceneBufferLimits { rows: 16, elements: 1 << 20 }, SceneBufferLimits { rows: 8192, elements: 5000 }]
    {
        let refused = SceneBufferBuilder::default().geometry(&geometry, 0).finish(limits);
        assert!(matches!(refused, Err(SceneBufferError::TooLarge { .. })), "{refused:?}");
    }
    // Rows widen if there would be too many of the default width.
    let limits = SceneBufferLimits { rows: 2048, elements: 1 << 22 };
    let mut builder = SceneBufferBuilder::default();
    let wide = builder.geometry(&geometry, 0).reserve(Section::Texels, &[0_u32; 0], 3 << 20).finish(limits).unwrap();
    assert_eq!((wide.width_log2(), wide.rows() <= 2048), (11, true));
}
