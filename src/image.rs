//! Images in memory.

use crate::error::FrameError;
use crate::parallel::for_rows;

/// An image in memory: pixels row after row, the first row at the top. Pixel centres have integer coordinates.
///
/// ```
/// use afterimage::Image;
///
/// let ramp = Image::from_fn([4, 2], |[x, y]| x + 10 * y);
/// assert_eq!(ramp.at(3, 1), 13);
/// assert_eq!(ramp.row(1), [10, 11, 12, 13]);
/// let doubled: Image<f32> = ramp.map(|v| 2.0 * v as f32);
/// assert_eq!(doubled.pixels()[5], 22.0);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Image<T> {
    size: [u32; 2],
    pixels: Vec<T>,
}

impl<T: Copy> Image<T> {
    /// An image of `size` (width and height in pixels) with every pixel set to `fill`.
    pub fn filled(size: [u32; 2], fill: T) -> Self {
        Self { size, pixels: vec![fill; size[0] as usize * size[1] as usize] }
    }

    /// An image of `pixels`, row after row: exactly width x height elements.
    ///
    /// # Errors
    /// [`FrameError::PixelCount`] if the length does not match the size.
    pub fn from_pixels(size: [u32; 2], pixels: Vec<T>) -> Result<Self, FrameError> {
        let expected = size[0] as usize * size[1] as usize;
        if pixels.len() == expected {
            Ok(Self { size, pixels })
        } else {
            Err(FrameError::PixelCount { size, expected, found: pixels.len() })
        }
    }

    /// An image whose pixel (x, y) is `f([x, y])`.
    pub fn from_fn(size: [u32; 2], mut f: impl FnMut([u32; 2]) -> T) -> Self {
        // Loops, since tests call this in hundreds of places: iterators for each took a tenth of their build.
        let mut pixels = Vec::with_capacity(size[0] as usize * size[1] as usize);
        for y in 0..size[1] {
            for x in 0..size[0] {
                pixels.push(f([x, y]));
            }
        }
        Self { size, pixels }
    }

    /// An image whose pixel (x, y) is `f([x, y])`, with rows computed in parallel.
    pub fn from_fn_parallel(size: [u32; 2], f: impl Fn([u32; 2]) -> T + Sync) -> Self
    where
        T: Default + Send,
    {
        let mut image = Self::filled(size, T::default());
        for_rows(&mut image.pixels, size[0].max(1) as usize, |y, row| {
            for (x, pixel) in row.iter_mut().enumerate() {
                *pixel = f([x as u32, y as u32]);
            }
        });
        image
    }

    /// Width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Width in pixels.
    pub fn width(&self) -> usize {
        self.size[0] as usize
    }

    /// Height in pixels.
    pub fn height(&self) -> usize {
        self.size[1] as usize
    }

    /// All pixels, row after row.
    pub fn pixels(&self) -> &[T] {
        &self.pixels
    }

    /// All pixels, row after row, for writing.
    pub fn pixels_mut(&mut self) -> &mut [T] {
        &mut self.pixels
    }

    /// Pixels of row `y`.
    ///
    /// # Panics
    /// If `y` is not below the height.
    pub fn row(&self, y: usize) -> &[T] {
        let w = self.width();
        &self.pixels[y * w..(y + 1) * w]
    }

    /// The pixel at column `x`, row `y`.
    ///
    /// # Panics
    /// If the coordinates lie outside the image.
    #[inline]
    pub fn at(&self, x: usize, y: usize) -> T {
        debug_assert!(x < self.width());
        self.pixels[y * self.size[0] as usize + x]
    }

    /// An image of the same size with `f` applied to every pixel.
    pub fn map<U: Copy>(&self, mut f: impl FnMut(T) -> U) -> Image<U> {
        let mut pixels = Vec::with_capacity(self.pixels.len());
        for &pixel in &self.pixels {
            pixels.push(f(pixel));
        }
        Image { size: self.size, pixels }
    }
}
