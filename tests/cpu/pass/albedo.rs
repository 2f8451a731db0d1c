//! Albedo of planned frames: a texture that changes under light that does not.

use super::*;
use afterimage::internal::{Foveation, Smr};

const SIZE: [u32; 2] = [96, 64];
const FRAMES: u64 = 24;

/// Light of a wall: a slope, and a soft shadow.
fn light([x, y]: [u32; 2]) -> f32 {
    let shadow = 0.5 + 0.5 * (0.1 * (x as f32 - 48.0)).tanh();
    (0.3 + 0.004 * y as f32) * (0.4 + 0.6 * shadow)
}

/// Above, a texture that scrolls by 3 pixels a frame; below, a video with another picture in every frame.
fn texture([x, y]: [u32; 2], index: u64, patch_px: u32) -> [f32; 3] {
    let (column, picture) = if y < 32 { (u64::from(x) + 3 * index, 0) } else { (u64::from(x), index) };
    let hash = |channel: u64| {
        let mixed = (column / u64::from(patch_px) * 7919
            + u64::from(y / patch_px) * 104_729
            + picture * 1_299_709
            + channel * 15_485_863)
            .wrapping_mul(0x9e37_79b9_7f4a_7c15);
        0.1 + 0.8 * (mixed >> 40) as f32 / (1 << 24) as f32
    };
    [hash(0), hash(1), hash(2)]
}

/// Squared errors of frames of which a tenth is shaded: of the first, which has no history, and of the upper and the
/// lower half from the eighth on. Surfaces stand still, and so say the vectors.
fn errors(has_albedo: bool, patch_px: u32) -> [f64; 3] {
    let method = Method::Smr(Smr { antialias: true, ..Smr::default() });
    let settings = Settings { method, foveation: Foveation::uniform(0.1), ..Settings::default() };
    let desc = ContextDesc { settings, has_albedo, keep_alpha: false, ..ContextDesc::new(SIZE) };
    let mut post = CpuAfterimage::new(&desc).unwrap();
    let mut errors = [0.0; 3];
    for index in 0..FRAMES {
        let albedo = Image::from_fn(SIZE, |px| texture(px, index, patch_px));
        let color = Image::from_fn(SIZE, |px| pixel(&albedo, px).map(|a| a * light(px)));
        let mut view = View::still(color.clone(), [48.0, 32.0]);
        view.facts.jitter_px = Foveation::jitter_px(index);
        view.motion = Some(Image::filled(SIZE, [0.0; 2]));
        view.albedo = has_albedo.then_some(albedo);
        let (shown, ..) = one(&mut post, index, &view);
        for px in pixels(SIZE).filter(|_| index == 0 || index >= 8) {
            let part = if index == 0 { 0 } else { 1 + usize::from(px[1] >= SIZE[1] / 2) };
            let [a, b] = [&shown, &color].map(|image| pixel(image, px));
            errors[part] += (0..3).map(|c| f64::from(a[c] - b[c]).powi(2)).sum::<f64>();
        }
    }
    errors
}

/// Vectors do not say that such a texture moves. Samples alone show it as it is; history shows light that stays with
/// the texture of this frame (docs/albedo.md).
#[test]
fn a_texture_that_changes_without_vectors_is_better_with_albedo() {
    for patch_px in [2, 4, 8] {
        let (without, with) = (errors(false, patch_px), errors(true, patch_px));
        let [first, scrolled, video] = [0, 1, 2].map(|part| 10.0 * (without[part] / with[part]).log10());
        println!("patches of {patch_px} px: first frame +{first:.1} dB, scrolling +{scrolled:.1}, video +{video:.1}");
        assert!(first > 7.0 && scrolled > 5.0 && video > 7.5, "{patch_px} px");
    }
}
