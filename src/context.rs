//! Description of a context.

use crate::convention::{DepthConvention, MotionConvention};
use crate::error::{FrameError, SettingsError, expected_size};
use crate::method::HistoryLayout;
use crate::settings::Settings;

/// Description of a context: size and number of views, conventions of its inputs, and settings. Size and settings can
/// be changed later (`resize` and `set_settings` of either executor).
///
/// Create it with [`new`](Self::new) and change fields, so that later versions can add fields:
///
/// ```
/// use afterimage::internal::ContextDesc;
/// use afterimage::{DepthConvention, MotionConvention};
///
/// let mut desc = ContextDesc::new([1920, 1080]);
/// desc.motion = MotionConvention::BLENDER;
/// desc.depth = DepthConvention::Reversed { near: 0.1, far: f32::INFINITY };
/// desc.settings.foveation.rate_far = 8;
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContextDesc {
    /// Width and height of each view in pixels, 1 to [`MAX_SIDE`](Self::MAX_SIDE) each.
    pub size_px: [u32; 2],
    /// Number of views: 1 for a screen, 2 for stereo; at most 4 on a GPU. Default 1.
    pub view_count: u32,
    /// Convention of motion vectors. Default: previous minus current position in pixels, y down.
    pub motion: MotionConvention,
    /// Convention of depth values, for views that do not state their own
    /// ([`ViewFrame::depth`](crate::internal::ViewFrame::depth)). Default: linear distance.
    pub depth: DepthConvention,
    /// Whether the output has the color input's alpha (1 where that is not finite) instead of 1. GPU only. Default
    /// true.
    ///
    /// On planned frames ([`FoveationKind::Quads`](crate::internal::FoveationKind::Quads)) history then has the alpha
    /// of its samples: 8 bytes a pixel and view, and 8 bytes a pixel of memory traffic. Set it to false if the output's
    /// alpha is not used. Alpha has the history that color has, so that both converge alike. Where alpha changes and
    /// color does not, as when something fades with color that is not premultiplied, history is not rejected, and alpha
    /// lags: give a trust or reactive mask there. The other methods have this frame's alpha, between the samples of
    /// planned frames a mean of those around.
    pub keep_alpha: bool,
    /// Whether frames have the albedo of every pixel ([`FrameInputs::albedo`](crate::levels::FrameInputs::albedo)):
    /// then samples show light, and texture is the pixel's own. Only on planned frames
    /// ([`FoveationKind::Quads`](crate::internal::FoveationKind::Quads)) that
    /// [antialias](crate::internal::Smr::antialias) without noise, and on a GPU without
    /// [`keep_alpha`](Self::keep_alpha), whose place it takes: 8 bytes a pixel and view. Default false.
    pub has_albedo: bool,
    /// Method, foveation and tunables. Default: [`Settings::steady`].
    pub settings: Settings,
}

impl ContextDesc {
    /// Largest accepted side of a view, in pixels.
    pub const MAX_SIDE: u32 = 16384;

    /// One view of `size_px` with default conventions and settings.
    pub fn new(size_px: [u32; 2]) -> Self {
        Self {
            size_px,
            view_count: 1,
            motion: MotionConvention::default(),
            depth: DepthConvention::default(),
            keep_alpha: true,
            has_albedo: false,
            settings: Settings::default(),
        }
    }

    /// Whether history has the alpha of its samples.
    #[cfg(feature = "gpu")]
    pub(crate) fn has_alpha_history(&self) -> bool {
        self.keep_alpha && matches!(self.settings.history_layout(), HistoryLayout::Sparse { .. })
    }

    /// Whether history has the alpha or the albedo of its samples.
    #[cfg(feature = "gpu")]
    pub(crate) fn has_extra_history(&self) -> bool {
        self.has_alpha_history() || self.has_albedo
    }

    /// Rejects settings that have no use for the albedo that frames have.
    pub(crate) fn check_albedo(&self, settings: &Settings) -> Result<(), SettingsError> {
        if !self.has_albedo || matches!(settings.history_layout(), HistoryLayout::Sparse { noisy: false, means: true })
        {
            return Ok(());
        }
        let expected = "false; or FoveationKind::Quads, Method::Smr with antialias, and no noise".into();
        Err(SettingsError { setting: "has_albedo", found: "true".into(), expected })
    }

    /// Checks settings, size, number of views and planes.
    pub(crate) fn validate(&self) -> Result<(), SettingsError> {
        self.settings.validate()?;
        self.check_albedo(&self.settings)?;
        self.depth.validate()?;
        check_size(self.size_px).map_err(|_| SettingsError {
            setting: "size_px",
            found: format!("{}x{}", self.size_px[0], self.size_px[1]),
            expected: expected_size(self.size_px, Self::MAX_SIDE),
        })?;
        if self.view_count == 0 {
            return Err(SettingsError { setting: "view_count", found: "0".into(), expected: "at least 1 view".into() });
        }
        Ok(())
    }
}

/// Rejects sizes with a side of 0 or beyond [`ContextDesc::MAX_SIDE`].
pub(crate) fn check_size(size: [u32; 2]) -> Result<(), FrameError> {
    let max = ContextDesc::MAX_SIDE;
    if size.iter().all(|s| (1..=max).contains(s)) { Ok(()) } else { Err(FrameError::Extent { size, max }) }
}
