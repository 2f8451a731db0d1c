//! Plans of frames shaded by quads: what they cost beside the passes of smr, on a device.
//!
//! CPU time of the process on software Vulkan, otherwise wall time; medians of frames with settled history. Depth,
//! motion and samples are those of analytic clips, 640x360 at 70 degrees, with quads as by default.
//!
//! `cargo research plan-cost`
//!
//! Makes figures of `docs/quads.md`; a minute.

use crate::device_time::timed_ms;
use crate::error::AnyError;
use afterimage::Gaze;
use afterimage::gpu::{Afterimage, Frame};
use afterimage::internal::{ContextDesc, Foveation, Method, Settings, Smr, ViewFrame};
use afterimage::wgpu::{TextureFormat, TextureUsages};
use afterimage_lab::clock::Quartiles;
use afterimage_lab::device::Headless;
use afterimage_lab::source::FrameSource;
use afterimage_lab::source::analytic::AnalyticSource;

const SIZE: [u32; 2] = [640, 360];
const GAZE_PX: [f32; 2] = [320.0, 180.0];
/// Frames before the first that is timed: history has settled where quads are dense.
const WARM_UP: u64 = 18;
const FRAMES: u64 = 40;

pub fn bench() -> Result<(), AnyError> {
    let gpu = Headless::find(true).ok_or("no adapter was found")?;
    say!("{:9} {:>9} {:>8} {:>8} {:>6}", "scene", "antialias", "plan ms", "smr ms", "ratio");
    for scene in ["still", "lateral", "walk", "occluder"] {
        for antialias in [false, true] {
            let [plan, record] = times(&gpu, scene, antialias)?;
            say!("{scene:9} {antialias:>9} {plan:8.1} {record:8.1} {:6.2}", plan / record);
        }
    }
    Ok(())
}

/// Median times of `plan` and `record` in milliseconds.
fn times(gpu: &Headless, scene: &str, antialias: bool) -> Result<[f64; 2], AnyError> {
    let smr = Smr { antialias, ..Smr::default() };
    let settings = Settings { method: Method::Smr(smr), foveation: Foveation::quads(), ..Settings::default() };
    let desc = ContextDesc { settings, ..ContextDesc::new(SIZE) };
    let mut post = Afterimage::new(&gpu.device, &desc, TextureFormat::Rgba16Float)?;
    let input = |format| gpu.texture(SIZE, 1, format, TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST);
    let (color, depth, motion) =
        (input(TextureFormat::Rgba32Float), input(TextureFormat::R32Float), input(TextureFormat::Rg32Float));
    let output = gpu.texture(SIZE, 1, TextureFormat::Rgba16Float, TextureUsages::STORAGE_BINDING);
    let mut source = AnalyticSource::new(scene, SIZE, 70.0, 60.0)?;
    let geometry = *source.view();
    let mut times = [vec![], vec![]];
    for index in 0..FRAMES {
        let full = source.frame(index)?;
        gpu.write_rgb(&color, 0, &full.color);
        gpu.write(&depth, 0, full.depth.as_ref().ok_or("no depth")?);
        gpu.write(&motion, 0, full.motion.as_ref().ok_or("no motion")?);
        let views = [ViewFrame {
            previous_from_current: full.previous_from_current,
            jitter_px: if antialias { Foveation::jitter_px(index) } else { [0.0; 2] },
            ..ViewFrame::new(geometry, Gaze::At { px: GAZE_PX })
        }];
        let (depth, motion) = (Some((&depth).into()), Some((&motion).into()));
        let frame = Frame { depth, motion, ..Frame::new(&color, &views, index) };
        // Uploads are done before the first watch starts.
        gpu.queue.submit([]);
        gpu.wait();
        let plan = timed_ms(gpu, |encoder| post.plan(&gpu.device, encoder, &frame))?;
        let record = timed_ms(gpu, |encoder| post.record(&gpu.device, encoder, &frame, &output).map(|_| ()))?;
        if index >= WARM_UP {
            times[0].push(plan);
            times[1].push(record);
        }
    }
    Ok(times.map(|times| Quartiles::of(&times).map_or(f64::NAN, |q| q.median)))
}
