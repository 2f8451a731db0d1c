//! Jittered frames, and references that are sums of them.

use crate::roomy::roomy_device;
use afterimage::Image;
use afterimage::kernel::color::luma;
use afterimage_lab::device::Headless;
use afterimage_lab::frame::{Content, RenderedFrame};
use afterimage_lab::source::{
    AnalyticSource, FrameRequest, FrameSource, RasterSource, ReadLimits, SceneOptions, reference_offsets_px,
};
use std::sync::Arc;

const SIZE: [u32; 2] = [96, 54];

/// Rasterised cubes, which move; `None` without an adapter.
fn cubes() -> Option<(RasterSource, Arc<Headless>)> {
    let device = roomy_device()?;
    let options = SceneOptions { size: Some(SIZE), hfov_deg: None, fps: None };
    let source = RasterSource::open("builtin:cubes", &ReadLimits::default(), &options, None, device.clone());
    Some((source.unwrap(), device))
}

fn jittered(source: &mut dyn FrameSource, index: u64, jitter_px: [f32; 2]) -> RenderedFrame {
    source.render(&FrameRequest { jitter_px: Some(jitter_px), ..FrameRequest::full_rate(index) }).unwrap()
}

/// Largest difference of luma, and the number of pixels with more than a hundredth.
fn difference(a: &Image<[f32; 3]>, b: &Image<[f32; 3]>) -> (f32, usize) {
    let all = a.pixels().iter().zip(b.pixels()).map(|(&a, &b)| (luma(a.into()) - luma(b.into())).abs());
    let all: Vec<f32> = all.collect();
    (all.iter().copied().fold(0.0, f32::max), all.iter().filter(|&&d| d > 0.01).count())
}

/// The frame moved by a whole pixel shows pixel (x - 1, y) at (x, y), with its depth and motion.
fn moves_by_whole_pixels(source: &mut dyn FrameSource) {
    let [at, moved] = [[0.0, 0.0], [1.0, 0.0]].map(|px| jittered(source, 3, px));
    assert_eq!((at.jitter_px, moved.jitter_px), ([0.0; 2], [1.0, 0.0]));
    let [at, moved] = [at.given(), moved.given()];
    let near = |a: f32, b: f32, scale: f32| a == b || (a - b).abs() <= 1e-3 * scale;
    let is_same = |(x, y): (usize, usize)| {
        let [(d0, m0, c0), (d1, m1, c1)] = [(at, x - 1), (moved, x)].map(|(frame, x)| {
            (frame.depth.as_ref().unwrap().at(x, y), frame.motion.as_ref().unwrap().at(x, y), frame.color.at(x, y))
        });
        near(d0, d1, d0.min(1e6)) && (0..2).all(|i| near(m0[i], m1[i], 1.0)) && (0..3).all(|i| near(c0[i], c1[i], 10.0))
    };
    let [w, h] = SIZE.map(|side| side as usize);
    let pixels: Vec<_> = (0..h).flat_map(|y| (1..w).map(move |x| (x, y))).collect();
    let (wrong, all) = (pixels.iter().filter(|px| !is_same(**px)).count(), pixels.len());
    println!("{wrong} of {all} pixels differ");
    // Edges that pass through a pixel's centre fall to either side.
    assert!(wrong * 200 <= all, "{wrong} of {all}");
}

#[test]
fn frames_move_with_the_jitter_and_motion_does_not_contain_it() {
    moves_by_whole_pixels(&mut AnalyticSource::new("lateral", SIZE, 70.0, 60.0).unwrap());
    if let Some((mut source, _)) = cubes() {
        moves_by_whole_pixels(&mut source);
    }
}

/// A reference of `n` samples a pixel is the mean of `n` jittered frames, whatever else is asked for.
fn is_the_mean_of_jittered_frames(source: &mut dyn FrameSource, index: u64) {
    const N: u32 = 8;
    let mut mean = Image::filled(SIZE, [0.0; 3]);
    for offset in reference_offsets_px(N) {
        let frame = jittered(source, index, offset.map(|v| -v));
        for (sum, color) in mean.pixels_mut().iter_mut().zip(frame.given().color.pixels()) {
            (0..3).for_each(|c| sum[c] += color[c] / N as f32);
        }
    }
    let request = FrameRequest { reference_samples: Some(N), ..FrameRequest::full_rate(index) };
    let plain = source.render(&request).unwrap();
    let jittered = source.render(&FrameRequest { jitter_px: Some([0.3, -0.2]), ..request }).unwrap();
    assert!(matches!((&plain.content, &jittered.content), (Content::FullRate, Content::Jittered(_))));
    assert_eq!(plain.reference.color.pixels(), jittered.reference.color.pixels());
    assert_eq!(plain.reference.depth.unwrap().pixels(), jittered.reference.depth.as_ref().unwrap().pixels());
    let (most, many) = difference(&mean, &plain.reference.color);
    println!("largest difference {most}, {many} pixels above 0.01");
    assert!(most < 0.2 && many < 5, "{most}, {many}");
    let (most, many) = difference(&mean, &jittered.given().color);
    assert!(many > 50, "one sample a pixel is another picture: {most}, {many}");
}

#[test]
fn references_are_means_of_jittered_frames() {
    for (scene, index) in [("still", 2), ("turn", 5), ("light-step", 40), ("scroll", 3)] {
        is_the_mean_of_jittered_frames(&mut AnalyticSource::new(scene, SIZE, 70.0, 60.0).unwrap(), index);
    }
    if let Some((mut source, _)) = cubes() {
        is_the_mean_of_jittered_frames(&mut source, 4);
    }
}
