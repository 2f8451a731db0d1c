//! Mip levels of textures by box filtering.

use crate::scene::Texture;
use afterimage::Image;
use afterimage::kernel::color::{srgb_decode, srgb_encode};
use std::sync::LazyLock;

/// Mip levels of a texture, largest first down to 1x1, without those larger than `max_side`.
///
/// Colors are averaged in linear space weighted by alpha, so that transparent texels do not tint their neighbours; data
/// is averaged as numbers.
pub(super) fn levels(texture: &Texture, is_color: bool, max_side: u32) -> Vec<Image<[u8; 4]>> {
    let [w, h] = texture.size;
    let first = Image::from_fn([w, h], |[x, y]| texture.texels.get((y * w + x) as usize).copied().unwrap_or([255; 4]));
    chain(first, max_side, |four| mean(four, is_color))
}

/// The image and its halves down to 1x1, without those larger than `max_side`. `mean`: of four texels.
fn chain<T: Copy + Default + Send + Sync>(
    first: Image<T>,
    max_side: u32,
    mean: impl Fn([T; 4]) -> T + Sync,
) -> Vec<Image<T>> {
    let mut levels = vec![first];
    while let Some(last) = levels.last()
        && last.size() != [1, 1]
    {
        let next = Image::from_fn_parallel(last.size().map(|s| (s / 2).max(1)), |[x, y]| {
            // Where a side is a single texel, repeat it.
            let [x, y] = [[x, last.size()[0]], [y, last.size()[1]]].map(|[v, side]| [2 * v, (2 * v + 1).min(side - 1)]);
            let at = |i: usize, j: usize| last.at(x[i] as usize, y[j] as usize);
            mean([at(0, 0), at(1, 0), at(0, 1), at(1, 1)])
        });
        if last.size().iter().any(|&s| s > max_side) {
            levels.pop();
        }
        levels.push(next);
    }
    levels
}

/// Linear values of sRGB bytes.
static DECODED: LazyLock<[f32; 256]> = LazyLock::new(|| std::array::from_fn(|i| srgb_decode(i as f32 / 255.0)));

/// sRGB bytes of linear values. A step of 1/8192 is less than half a byte step, except in the 7 darkest.
static ENCODED: LazyLock<Vec<u8>> =
    LazyLock::new(|| (0..=8192).map(|i| (srgb_encode(i as f32 / 8192.0) * 255.0).round() as u8).collect());

fn mean(four: [[u8; 4]; 4], is_color: bool) -> [u8; 4] {
    let sum = |c: usize| four.iter().map(|t| u32::from(t[c])).sum::<u32>();
    if !is_color {
        return [0, 1, 2, 3].map(|c| ((sum(c) + 2) / 4) as u8);
    }
    let alpha = sum(3);
    let color = |c: usize| {
        let share = |t: &[u8; 4]| if alpha == 0 { 1.0 } else { f32::from(t[3]) };
        let (light, total) = four
            .iter()
            .fold((0.0, 0.0), |(light, total), t| (light + DECODED[usize::from(t[c])] * share(t), total + share(t)));
        ENCODED[((light / total) * 8192.0 + 0.5) as usize]
    };
    [color(0), color(1), color(2), ((alpha + 2) / 4) as u8]
}

/// Mip levels of the sky in linear radiance, largest first down to 1x1, without those larger than `max_side`.
pub(super) fn sky_levels(map: &Image<[f32; 3]>, max_side: u32) -> Vec<Image<[f32; 3]>> {
    chain(map.clone(), max_side, |four| [0, 1, 2].map(|c| four.iter().map(|t| t[c]).sum::<f32>() * 0.25))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Wrap;

    fn texture(size: [u32; 2], texels: Vec<[u8; 4]>) -> Texture {
        Texture { size, texels, wrap: [Wrap::Repeat; 2], nearest: false, coordinates: Default::default() }
    }

    #[test]
    fn colors_are_averaged_as_light_and_data_as_numbers() {
        let t = texture([2, 1], vec![[255, 0, 0, 255], [0, 0, 0, 255]]);
        // Half the linear value of 255 is 188 in sRGB.
        assert_eq!(levels(&t, true, 8192)[1].at(0, 0), [188, 0, 0, 255]);
        assert_eq!(levels(&t, false, 8192)[1].at(0, 0), [128, 0, 0, 255]);
    }

    #[test]
    fn what_is_transparent_gives_no_color() {
        let t = texture([2, 1], vec![[200, 100, 50, 255], [0, 0, 0, 0]]);
        assert_eq!(levels(&t, true, 8192)[1].at(0, 0), [200, 100, 50, 128]);
    }

    #[test]
    fn any_size_ends_at_one_texel_and_large_levels_are_left_out() {
        let t = texture([5, 3], vec![[7; 4]; 15]);
        let sizes: Vec<_> = levels(&t, true, 8192).iter().map(Image::size).collect();
        assert_eq!(sizes, [[5, 3], [2, 1], [1, 1]]);
        assert_eq!(levels(&t, true, 4)[0].size(), [2, 1]);
        assert!(levels(&t, true, 8192).iter().all(|l| l.pixels().iter().all(|p| p[3] == 7)));
    }
}
