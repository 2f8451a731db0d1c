//! Worst crop: a planted loss is found at its place, and an invisible error does not count as a loss.

use super::noise;
use afterimage::Image;
use afterimage_lab::metric::{CROP_FROM_FRAME, Crops, WorstCrop};
use approx::assert_abs_diff_eq;

const SIZE: [u32; 2] = [200, 130];

/// `image` with `offset` added to the pixels of one crop.
fn offset_crop(image: &Image<[f32; 3]>, [x_px, y_px]: [u32; 2], offset: f32) -> Image<[f32; 3]> {
    let of = |at: u32, from: u32| (from..from + 64).contains(&at);
    Image::from_fn(image.size(), |[x, y]| {
        let changed = if of(x, x_px) && of(y, y_px) { offset } else { 0.0 };
        image.at(x as usize, y as usize).map(|v| v + changed)
    })
}

fn offset_all(image: &Image<[f32; 3]>, offset: f32) -> Image<[f32; 3]> {
    image.map(|c| c.map(|v| v + offset))
}

/// Worst crop of a clip whose frame `frame` shows `worse`, and whose other frames show the foveated frame.
fn worst(foveated_offset: f32, frame: u64, worse: impl Fn(&Image<[f32; 3]>) -> Image<[f32; 3]>) -> Option<WorstCrop> {
    let full = noise(SIZE, "crop");
    let foveated = offset_all(&full, foveated_offset);
    let mut crops = Crops::default();
    for index in 0..5 {
        let shown = if index == frame { worse(&full) } else { foveated.clone() };
        crops.push(&full, &shown, &foveated);
    }
    crops.worst()
}

#[test]
fn a_planted_loss_is_found_in_its_frame_and_crop() {
    // An error of 0.2 in place of 0.1 is 6.02 dB. Crops at the right and lower border are moved inwards.
    for at in [[0, 0], [64, 64], [136, 64], [136, 66]] {
        let worst = worst(0.1, 3, |full| offset_crop(&offset_all(full, 0.1), at, 0.1)).unwrap();
        assert_eq!((worst.frame, worst.x_px, worst.y_px), (3, at[0], at[1]));
        assert_abs_diff_eq!(worst.delta_db, -6.0206, epsilon = 1e-3);
    }
}

#[test]
fn losses_that_nobody_sees_count_as_none() {
    // 54 dB in place of a perfect frame; 46 dB in place of a perfect frame.
    let invisible = worst(0.0, 3, |full| offset_crop(full, [0, 0], 0.002)).unwrap();
    assert_eq!(invisible.delta_db, 0.0);
    let visible = worst(0.0, 3, |full| offset_crop(full, [0, 0], 0.005)).unwrap();
    assert_abs_diff_eq!(visible.delta_db, -20.0 * 0.005_f64.log10() - 50.0, epsilon = 1e-2);
}

#[test]
fn the_first_frames_have_no_crops() {
    let full = noise([20, 10], "small");
    let mut crops = Crops::default();
    for _ in 0..CROP_FROM_FRAME {
        crops.push(&full, &offset_all(&full, 0.5), &full);
        assert_eq!(crops.worst(), None);
    }
    // A frame smaller than a crop is one crop.
    crops.push(&full, &offset_all(&full, 0.1), &full);
    let worst = crops.worst().unwrap();
    assert_eq!((worst.frame, worst.x_px, worst.y_px), (CROP_FROM_FRAME, 0, 0));
    assert_abs_diff_eq!(worst.delta_db, 20.0 - 50.0, epsilon = 1e-3);
}
