//! Two eyes in one `record` against two contexts with an eye each: time, and whether the left eye's bytes are equal.
//! The right eye draws random numbers of its own (dithering of stored colors), which a context of its own has not;
//! tests compare its bytes with those of two views whose left one shows something else.
//!
//! Planned frames of two analytic clips, one for each eye, with gazes of their own; fovea 10 and middle 30 degrees,
//! steps 2 and 4, antialiased, 90 degrees. CPU time of the process on software Vulkan, otherwise wall time; medians of
//! frames that alternate between both ways.
//!
//! `cargo research two-eyes`
//!
//! Makes figures of `docs/equal-time.md`, "Headset"; minutes.

use crate::device_time::timed_ms;
use crate::error::AnyError;
use afterimage::gpu::{Afterimage, Frame};
use afterimage::internal::{ContextDesc, Foveation, Method, MethodKind, Settings, Smr, ViewFrame};
use afterimage::wgpu::{CommandEncoder, Texture, TextureFormat, TextureUsages};
use afterimage::{FrameError, Gaze};
use afterimage_lab::clock::Quartiles;
use afterimage_lab::device::Headless;
use afterimage_lab::source::FrameSource;
use afterimage_lab::source::analytic::AnalyticSource;

const CLIPS: [&str; 2] = ["lateral", "turn"];
/// Frames before the first that is timed.
const WARM_UP: u64 = 6;
const FRAMES: u64 = 46;

/// Inputs and output of a context, with a layer for each view.
struct Images {
    color: Texture,
    depth: Texture,
    motion: Texture,
    output: Texture,
}

pub fn bench() -> Result<(), AnyError> {
    let gpu = Headless::find(true).ok_or("no adapter was found")?;
    say!("{:6} {:>9} {:>12} {:>16} {:>6}  left eye", "method", "an eye", "together, ms", "one by one, ms", "ratio");
    for method in [Method::Smr(Smr { antialias: true, ..Smr::default() }), MethodKind::Taau.into()] {
        for side in [128, 256, 512, 1024] {
            compare(&gpu, method, [side, side])?;
        }
    }
    Ok(())
}

fn compare(gpu: &Headless, method: Method, size: [u32; 2]) -> Result<(), AnyError> {
    let foveation = Settings::headset().foveation;
    let settings = Settings { method, foveation, ..Settings::default() };
    let context = |view_count| {
        let desc = ContextDesc { settings, view_count, ..ContextDesc::new(size) };
        Afterimage::new(&gpu.device, &desc, TextureFormat::Rgba32Float)
    };
    let (mut both, mut alone) = (context(2)?, [context(1)?, context(1)?]);
    let (of_both, of_one) = (images(gpu, size, 2), [images(gpu, size, 1), images(gpu, size, 1)]);
    let mut clips = Vec::new();
    for clip in CLIPS {
        clips.push(AnalyticSource::new(clip, size, 90.0, 90.0)?);
    }
    let (mut together_ms, mut one_by_one_ms, mut is_left_equal) = (vec![], vec![], true);
    for index in 0..FRAMES {
        let mut views = vec![];
        for (eye, clip) in clips.iter_mut().enumerate() {
            let full = clip.frame(index)?;
            let shift = 8.0 * (eye as f32 - 0.5);
            let gaze_px = [0.5 * size[0] as f32 + shift + index as f32, 0.4 * size[1] as f32];
            for (to, layer) in [(&of_both, eye as u32), (&of_one[eye], 0)] {
                gpu.write_rgb(&to.color, layer, &full.color);
                gpu.write(&to.depth, layer, full.depth.as_ref().ok_or("no depth")?);
                gpu.write(&to.motion, layer, full.motion.as_ref().ok_or("no motion")?);
            }
            views.push(ViewFrame {
                previous_from_current: full.previous_from_current,
                jitter_px: Foveation::jitter_px(index),
                ..ViewFrame::new(*clip.view(), Gaze::At { px: gaze_px })
            });
        }
        // Uploads are done before the first watch starts.
        gpu.queue.submit([]);
        gpu.wait();
        let mut together = |ms: &mut Vec<f64>| {
            ms.push(timed_ms(gpu, |encoder| record(gpu, &mut both, encoder, &of_both, &views, index))?);
            Ok::<_, AnyError>(())
        };
        if index % 2 == 0 {
            together(&mut together_ms)?;
        }
        one_by_one_ms.push(timed_ms(gpu, |encoder| {
            for (eye, post) in alone.iter_mut().enumerate() {
                record(gpu, post, encoder, &of_one[eye], &views[eye..=eye], index)?;
            }
            Ok(())
        })?);
        if index % 2 == 1 {
            together(&mut together_ms)?;
        }
        is_left_equal &= gpu.read_rgb(&of_both.output, 0) == gpu.read_rgb(&of_one[0].output, 0);
    }
    let median = |ms: &[f64]| Quartiles::of(&ms[WARM_UP as usize..]).map_or(f64::NAN, |q| q.median);
    let (together, one_by_one) = (median(&together_ms), median(&one_by_one_ms));
    say!(
        "{:6} {:>9} {together:12.2} {one_by_one:16.2} {:6.2}  {}",
        method.kind().name(),
        format!("{}x{}", size[0], size[1]),
        together / one_by_one,
        if is_left_equal { "equal" } else { "DIFFERENT" }
    );
    Ok(())
}

fn images(gpu: &Headless, size: [u32; 2], views: u32) -> Images {
    let input = |format| gpu.texture(size, views, format, TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST);
    let written = TextureUsages::STORAGE_BINDING | TextureUsages::COPY_SRC;
    Images {
        color: input(TextureFormat::Rgba32Float),
        depth: input(TextureFormat::R32Float),
        motion: input(TextureFormat::Rg32Float),
        output: gpu.texture(size, views, TextureFormat::Rgba32Float, written),
    }
}

fn record(
    gpu: &Headless,
    post: &mut Afterimage,
    encoder: &mut CommandEncoder,
    images: &Images,
    views: &[ViewFrame],
    index: u64,
) -> Result<(), FrameError> {
    let (depth, motion) = (Some((&images.depth).into()), Some((&images.motion).into()));
    let frame = Frame { depth, motion, ..Frame::new(&images.color, views, index) };
    post.plan(&gpu.device, encoder, &frame)?;
    post.record(&gpu.device, encoder, &frame, &images.output).map(|_| ())
}
