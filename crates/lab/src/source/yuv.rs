//! Colors of video: Y'CbCr samples of 8 bits. R'G'B' is that of an sRGB display.

use super::still::srgb_to_linear;
use afterimage::Image;
use image::RgbImage;
use rayon::prelude::*;

/// From R'G'B' to Y'CbCr.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Matrix {
    /// That of standard definition.
    Bt601,
    /// That of high definition.
    Bt709,
}

impl Matrix {
    /// What players take where a video states none: BT.709 from 1280 columns or 577 rows on.
    pub fn of_size([w, h]: [u32; 2]) -> Self {
        if w >= 1280 || h > 576 { Self::Bt709 } else { Self::Bt601 }
    }

    /// Weights of red and blue in luma.
    fn red_and_blue(self) -> [f32; 2] {
        match self {
            Self::Bt601 => [0.299, 0.114],
            Self::Bt709 => [0.2126, 0.0722],
        }
    }
}

/// Where the chroma samples of a frame are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chroma {
    /// Luma samples a chroma sample along each axis; `None`: no chroma.
    step: Option<[u32; 2]>,
    /// Position of the first chroma sample in luma samples.
    at: [f32; 2],
}

impl Chroma {
    /// Chroma by its name in y4m, if it has 8 bits and is read.
    pub(super) fn of(name: &str) -> Option<Self> {
        let (step, at) = match name {
            "420" | "420jpeg" => (Some([2, 2]), [0.5, 0.5]),
            "420mpeg2" => (Some([2, 2]), [0.0, 0.5]),
            "420paldv" => (Some([2, 2]), [0.0, 0.0]),
            "422" => (Some([2, 1]), [0.0, 0.0]),
            "444" => (Some([1, 1]), [0.0, 0.0]),
            "mono" => (None, [0.0, 0.0]),
            _ => return None,
        };
        Some(Self { step, at })
    }

    /// Width and height of a chroma plane.
    fn plane(self, size: [u32; 2]) -> [u32; 2] {
        self.step.map_or([0; 2], |step| [0, 1].map(|axis| size[axis].div_ceil(step[axis])))
    }

    /// Bytes of a frame.
    pub(super) fn frame_bytes(self, size: [u32; 2]) -> usize {
        let pixels = |[w, h]: [u32; 2]| w as usize * h as usize;
        pixels(size) + 2 * pixels(self.plane(size))
    }
}

/// What the samples of a video mean.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coding {
    /// Where chroma is.
    pub chroma: Chroma,
    /// Whether black and white are 0 and 255, and not 16 and 235.
    pub is_full_range: bool,
    /// What the channels mean.
    pub matrix: Matrix,
}

impl Coding {
    /// Linear color of a frame. Chroma between its samples is bilinear.
    pub(super) fn linear(self, size: [u32; 2], planes: &[u8]) -> Image<[f32; 3]> {
        let (width, pixels) = (size[0] as usize, size[0] as usize * size[1] as usize);
        let (luma, chroma) = planes.split_at(pixels);
        let plane = self.chroma.plane(size);
        let (cb, cr) = chroma.split_at(plane[0] as usize * plane[1] as usize);
        let [columns, rows] = [0, 1].map(|axis| self.taps(axis, size[axis], plane[axis]));
        let mut image = Image::filled(size, [0.0; 3]);
        image.pixels_mut().par_chunks_mut(width).enumerate().for_each(|(y, row)| {
            for (x, pixel) in row.iter_mut().enumerate() {
                let of = |samples: &[u8]| match self.chroma.step {
                    Some(_) => bilinear(samples, plane[0] as usize, columns[x], rows[y]),
                    None => 128.0,
                };
                let encoded = self.rgb(f32::from(luma[y * width + x]), of(cb), of(cr));
                *pixel = encoded.map(|v| srgb_to_linear(f64::from(v.clamp(0.0, 1.0))) as f32);
            }
        });
        image
    }

    /// For each luma sample along an axis: the two chroma samples beside it, and the weight of the second.
    fn taps(self, axis: usize, luma: u32, chroma: u32) -> Vec<(usize, usize, f32)> {
        let step = self.chroma.step.map_or(1, |step| step[axis]) as f32;
        let last = chroma.saturating_sub(1) as usize;
        let tap = |i: u32| {
            let at = ((i as f32 - self.chroma.at[axis]) / step).max(0.0);
            let first = (at as usize).min(last);
            (first, (first + 1).min(last), at - at.floor())
        };
        (0..luma).map(tap).collect()
    }

    /// R'G'B' of a pixel.
    fn rgb(self, y: f32, cb: f32, cr: f32) -> [f32; 3] {
        let [black, luma, chroma] = if self.is_full_range { [0.0, 255.0, 255.0] } else { [16.0, 219.0, 224.0] };
        let [kr, kb] = self.matrix.red_and_blue();
        let (y, cb, cr) = ((y - black) / luma, (cb - 128.0) / chroma, (cr - 128.0) / chroma);
        let [r, b] = [y + 2.0 * (1.0 - kr) * cr, y + 2.0 * (1.0 - kb) * cb];
        [r, (y - kr * r - kb * b) / (1.0 - kr - kb), b]
    }
}

fn bilinear(samples: &[u8], width: usize, x: (usize, usize, f32), y: (usize, usize, f32)) -> f32 {
    let row = |y: usize| {
        let [a, b] = [x.0, x.1].map(|x| f32::from(samples[y * width + x]));
        a + x.2 * (b - a)
    };
    let (a, b) = (row(y.0), row(y.1));
    a + y.2 * (b - a)
}

/// The planes of a picture: 4:4:4 of limited range, with the matrix of its size.
pub fn encoded(picture: &RgbImage) -> Vec<u8> {
    let [kr, kb] = Matrix::of_size([picture.width(), picture.height()]).red_and_blue();
    let pixels = picture.as_raw().as_chunks::<3>().0;
    let mut planes = [vec![], vec![], vec![]];
    for pixel in pixels {
        let [r, g, b] = pixel.map(|v| f32::from(v) / 255.0);
        let y = kr * r + (1.0 - kr - kb) * g + kb * b;
        let samples = [16.0 + 219.0 * y, 128.0 + 112.0 * (b - y) / (1.0 - kb), 128.0 + 112.0 * (r - y) / (1.0 - kr)];
        for (plane, sample) in planes.iter_mut().zip(samples) {
            plane.push((sample + 0.5) as u8);
        }
    }
    planes.concat()
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::Rgb;

    fn coding(chroma: &str, is_full_range: bool, matrix: Matrix) -> Coding {
        Coding { chroma: Chroma::of(chroma).unwrap(), is_full_range, matrix }
    }

    /// Samples of red, green, blue, white and black as the standards print them.
    #[test]
    fn primaries_have_the_samples_of_the_standards() {
        let (b601, b709) = (Matrix::Bt601, Matrix::Bt709);
        for (matrix, full, samples, expected) in [
            (b601, false, [81, 90, 240], [1.0, 0.0, 0.0]),
            (b601, false, [145, 54, 34], [0.0, 1.0, 0.0]),
            (b601, false, [41, 240, 110], [0.0, 0.0, 1.0]),
            (b709, false, [63, 102, 240], [1.0, 0.0, 0.0]),
            (b709, false, [173, 42, 26], [0.0, 1.0, 0.0]),
            (b709, false, [32, 240, 118], [0.0, 0.0, 1.0]),
            (b709, false, [235, 128, 128], [1.0; 3]),
            (b709, false, [16, 128, 128], [0.0; 3]),
            (b601, true, [76, 85, 255], [1.0, 0.0, 0.0]),
            (b709, true, [255, 128, 128], [1.0; 3]),
        ] {
            let found = coding("444", full, matrix).rgb(samples[0] as f32, samples[1] as f32, samples[2] as f32);
            for (found, expected) in found.into_iter().zip(expected) {
                assert!((found - expected).abs() < 0.012, "{matrix:?} {full} {samples:?}: {found} is not {expected}");
            }
        }
    }

    /// A ramp of chroma keeps its place at every siting: its value at a luma sample is that of the ramp there.
    #[test]
    fn chroma_lies_where_the_format_says() {
        let size = [16, 16];
        for (name, step, at) in [
            ("420jpeg", [2, 2], [0.5, 0.5]),
            ("420mpeg2", [2, 2], [0.0, 0.5]),
            ("420paldv", [2, 2], [0.0, 0.0]),
            ("422", [2, 1], [0.0, 0.0]),
        ] {
            let coding = coding(name, true, Matrix::Bt709);
            let plane = coding.chroma.plane(size);
            let sample = |x: u32, y: u32| 40.0 + 4.0 * (x * step[0]) as f32 + 2.0 * (y * step[1]) as f32;
            let samples: Vec<u8> = (0..plane[1]).flat_map(|y| (0..plane[0]).map(move |x| sample(x, y) as u8)).collect();
            let taps = [0, 1].map(|axis| coding.taps(axis, size[axis], plane[axis]));
            for (x, y) in [(4, 4), (5, 6), (7, 9), (9, 7)] {
                let found = bilinear(&samples, plane[0] as usize, taps[0][x], taps[1][y]);
                let expected = 40.0 + 4.0 * (x as f32 - at[0]) + 2.0 * (y as f32 - at[1]);
                assert!((found - expected).abs() < 1e-3, "{name} at {x},{y}: {found} is not {expected}");
            }
        }
    }

    #[test]
    fn pictures_survive_within_the_rounding_of_8_bits() {
        for size in [[40, 30], [1280, 4]] {
            let picture = RgbImage::from_fn(size[0], size[1], |x, y| {
                Rgb([(x * 37 % 256) as u8, (y * 91 % 256) as u8, ((x + y) * 53 % 256) as u8])
            });
            let coding = coding("444", false, Matrix::of_size(size));
            let back = coding.linear(size, &encoded(&picture));
            for (pixel, linear) in picture.pixels().zip(back.pixels()) {
                for (a, b) in pixel.0.into_iter().zip(linear) {
                    let expected = srgb_to_linear(f64::from(a) / 255.0) as f32;
                    assert!((b - expected).abs() < 0.03, "{pixel:?}: {b} is not {expected}");
                }
            }
        }
    }
}
