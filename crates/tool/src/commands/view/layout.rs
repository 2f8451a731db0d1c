//! Position and scale of the picture in the window.

/// Placement of the picture: as large as fits, centered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layout {
    /// Top left corner, pixels of the window.
    pub corner: [f32; 2],
    /// Window pixels per picture pixel.
    pub scale: f32,
    /// Size of the picture, in its own pixels.
    pub size: [u32; 2],
}

/// Distance from the divider at which the mouse can drag it, pixels of the window.
const GRIP_PX: f32 = 6.0;

impl Layout {
    /// Places a picture of `size` in a window.
    pub fn new(size: [u32; 2], window: [u32; 2]) -> Self {
        let scale = (window[0] as f32 / size[0] as f32).min(window[1] as f32 / size[1] as f32);
        let corner = [0, 1].map(|i| (0.5 * (window[i] as f32 - scale * size[i] as f32)).floor().max(0.0));
        Self { corner, scale, size }
    }

    /// Position in the picture, in its pixels, of a position in the window; clamped to the picture.
    pub fn picture_px(&self, at: [f32; 2]) -> [f32; 2] {
        [0, 1].map(|i| ((at[i] - self.corner[i]) / self.scale - 0.5).clamp(0.0, self.size[i] as f32 - 1.0))
    }

    /// The pixel of the picture at a position in the window; `None` beside the picture.
    pub fn pixel(&self, at: [f32; 2]) -> Option<[u32; 2]> {
        let px = [0, 1].map(|i| ((at[i] - self.corner[i]) / self.scale).floor());
        let is_inside = (0..2).all(|i| px[i] >= 0.0 && px[i] < self.size[i] as f32);
        is_inside.then(|| px.map(|v| v as u32))
    }

    /// A position in the window as a fraction of the picture's width, clamped to 0.02..0.98.
    pub fn share(&self, x: f32) -> f32 {
        ((x - self.corner[0]) / (self.scale * self.size[0] as f32)).clamp(0.02, 0.98)
    }

    /// The first column of the window to the right of a divider at this fraction of the width.
    pub fn divider_x(&self, divider: f32) -> u32 {
        (self.corner[0] + self.scale * self.size[0] as f32 * divider).round() as u32
    }

    /// Whether the mouse at `x` can drag a divider at this fraction of the width.
    pub fn grips(&self, x: f32, divider: f32) -> bool {
        let at = self.corner[0] + self.scale * self.size[0] as f32 * divider;
        (x - at).abs() <= GRIP_PX
    }

    /// Size of a window for a picture of `size`: small pictures are enlarged by a whole factor, large ones reduced to
    /// fit the screen.
    pub fn window(size: [u32; 2], screen: [u32; 2]) -> [u32; 2] {
        const COMFORTABLE: [u32; 2] = [1280, 720];
        // Leave room for window borders and taskbars.
        let max = screen.map(|s| 0.9 * s as f32);
        let fit = |to: [f32; 2]| (to[0] / size[0] as f32).min(to[1] / size[1] as f32);
        let enlarged = fit(COMFORTABLE.map(|s| s as f32)).floor().max(1.0);
        let scale = if fit(max) < enlarged { fit(max).min(enlarged) } else { enlarged };
        size.map(|s| ((s as f32 * scale).round() as u32).max(1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_fills_its_window_and_stands_in_the_middle() {
        let same = Layout::new([640, 360], [640, 360]);
        assert_eq!((same.corner, same.scale), ([0.0; 2], 1.0));
        assert_eq!(same.picture_px([320.5, 10.5]), [320.0, 10.0], "centres of pixels are whole numbers");
        let wide = Layout::new([640, 360], [1480, 720]);
        assert_eq!((wide.corner, wide.scale), ([100.0, 0.0], 2.0));
        assert_eq!(wide.picture_px([0.0, 719.9]), [0.0, 359.0], "beside it, the nearest pixel");
        assert_eq!((wide.pixel([101.9, 719.9]), wide.pixel([102.0, 0.0])), (Some([0, 359]), Some([1, 0])));
        assert_eq!((wide.pixel([99.9, 0.0]), wide.pixel([1380.0, 0.0])), (None, None), "beside it, none");
        assert!(wide.grips(738.0, 0.5) && !wide.grips(730.0, 0.5) && wide.share(740.0) == 0.5);
    }

    #[test]
    fn windows_are_comfortable_and_fit_the_screen() {
        assert_eq!(Layout::window([1280, 720], [1920, 1080]), [1280, 720]);
        assert_eq!(Layout::window([320, 180], [1920, 1080]), [1280, 720]);
        assert_eq!(Layout::window([3840, 2160], [1920, 1080]), [1728, 972]);
        assert_eq!(Layout::window([640, 360], [800, 600]), [720, 405]);
    }
}
