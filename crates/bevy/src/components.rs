//! Components of a camera, and the components that these require.

use afterimage::DebugView;
use afterimage::internal::{self, Foveation, Method, Settings};
use bevy::core_pipeline::prepass::{DepthPrepass, MotionVectorPrepass};
use bevy::prelude::*;

/// Runs the post-process for this camera: a `Camera3d` with a perspective projection, symmetric or off-axis,
/// or an orthographic one.
///
/// Requires `DepthPrepass` and `MotionVectorPrepass`, by which quads are chosen; they stay when this component is
/// removed. While it runs there is no MSAA, whatever [`Msaa`] says: most pixels have no samples to average.
///
/// All of it may change at any time, through reflection, too: an inspector such as `bevy-inspector-egui` shows the
/// fields, as it does those of [`Foveated`].
///
/// ```
/// use bevy::prelude::*;
/// use bevy_afterimage::Foveated;
///
/// let mut foveated = Foveated::default();
/// *foveated.path_mut::<f32>("budget")? = 0.1;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Component, Clone, Debug, PartialEq, Reflect)]
#[reflect(Component, Default)]
#[require(Foveated, DepthPrepass, MotionVectorPrepass)]
pub struct Afterimage {
    /// Method and tunables, for tests and comparisons. Their `foveation` and `Smr::antialias` are ignored:
    /// [`Foveated`] and [`antialias`](Self::antialias) say them. Default `None`.
    #[doc(hidden)]
    pub settings: Option<Settings>,
    /// Antialiases with the method smr, in place of temporal antialiasing and MSAA: the camera's projection moves by a
    /// part of a pixel each frame, and history stores means of samples. Not for cameras with a `TemporalJitter` of
    /// their own, which temporal antialiasing and upscaling add. Default true.
    pub antialias: bool,
    /// Discards history in the next frame, for camera cuts and teleports. Becomes false when that frame is drawn.
    pub reset: bool,
}

impl Default for Afterimage {
    fn default() -> Self {
        Self { settings: None, antialias: true, reset: false }
    }
}

impl Afterimage {
    pub(crate) fn settings(&self, foveated: &Foveated) -> Settings {
        let mut settings = Settings { foveation: foveated.foveation(), ..self.settings.unwrap_or_default() };
        if let Method::Smr(smr) = &mut settings.method {
            smr.antialias = self.antialias;
        }
        settings
    }
}

/// Which quads of 2x2 pixels a camera with [`Afterimage`] shades in a frame; without that it does nothing. Angles are
/// visual angles of the camera: its field of view is taken for the one that the screen fills, 40
/// degrees wide if it is orthographic. Default [`screen`](Self::screen).
#[derive(Component, Clone, Copy, Debug, PartialEq, Reflect)]
#[reflect(Component, Default)]
pub struct Foveated {
    /// Whether pixels are left out. Default [`FoveationKind::Quads`].
    pub kind: FoveationKind,
    /// Diameter of the full-rate region in degrees: 0 to 180, at most `mid_deg`. Default 5.
    pub fovea_deg: f32,
    /// Diameter of the middle region in degrees: 0 to 180. Default 15.
    pub mid_deg: f32,
    /// Edge in pixels of the blocks of which one quad is shaded in a frame, in the middle region: 2, 4 or 8. Default 8.
    pub rate_mid: u32,
    /// The same in the periphery: 2, 4 or 8, at least `rate_mid`. Every second block has a quad in a frame. Default 8.
    pub rate_far: u32,
    /// Share of the pixels that are shaded because history lacks something there: 0 to 1. Default 0.05.
    pub budget: f32,
    /// Frames a second that the plugin keeps by changing the other fields: [`auto`](Self::auto). Default `None`.
    pub target_fps: Option<f32>,
}

impl Default for Foveated {
    fn default() -> Self {
        Self::screen()
    }
}

impl Foveated {
    /// Around a gaze, for screens about 40 degrees wide: a tenth of the pixels.
    pub fn screen() -> Self {
        Self::of(Settings::screen().foveation)
    }

    /// Around a gaze, for headsets, about 100 degrees wide: a wider fovea.
    pub fn headset() -> Self {
        Self::of(Settings::headset().foveation)
    }

    /// No fovea, and no gaze needed: `share` of the pixels, 0 to 1, everywhere alike. A temporal upscaler with depth
    /// and motion at full rate.
    ///
    /// ```
    /// use bevy_afterimage::Foveated;
    ///
    /// assert_eq!(Foveated::uniform(0.25).fovea_deg, 0.0);
    /// ```
    pub fn uniform(share: f32) -> Self {
        Self::of(Foveation::uniform(share))
    }

    /// As many pixels, everywhere alike, as make `target_fps` frames a second: from a tenth to all that history lacks,
    /// by the time of the device, if the application has Bevy's `RenderDiagnosticsPlugin` and the device has
    /// timestamps, and by that of the whole frame else. With vertical synchronization the latter does not show spare
    /// time, and the share does not grow again.
    ///
    /// Where the target is missed and foveation does not pay, it is [`FoveationKind::Off`] until the load changes. With
    /// [`antialias`](Afterimage::antialias) such frames have Bevy's `TemporalAntiAliasing`, which begins without
    /// history: edges are rough for some frames.
    ///
    /// ```
    /// use bevy_afterimage::Foveated;
    ///
    /// assert_eq!(Foveated::auto(60.0).target_fps, Some(60.0));
    /// ```
    pub fn auto(target_fps: f32) -> Self {
        Self { target_fps: Some(target_fps), ..Self::uniform(1.0) }
    }

    fn of(foveation: Foveation) -> Self {
        let Foveation { fovea_deg, mid_deg, rate_mid, rate_far, budget, .. } = foveation;
        let kind = FoveationKind::Quads;
        Self { kind, fovea_deg, mid_deg, rate_mid, rate_far, budget, target_fps: None }
    }

    fn foveation(&self) -> Foveation {
        let Self { fovea_deg, mid_deg, rate_mid, rate_far, budget, .. } = *self;
        Foveation {
            kind: internal::FoveationKind::Quads,
            fovea_deg,
            mid_deg,
            rate_mid,
            rate_far,
            budget,
            ..Default::default()
        }
    }
}

/// Whether a camera with [`Foveated`] leaves pixels out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Default)]
pub enum FoveationKind {
    /// The post-process chooses quads of 2x2 pixels before they are shaded, and fills the rest from history.
    #[default]
    Quads,
    /// Every pixel, without post-process: for comparison.
    Off,
}

/// Shows a view of the post-process's decisions instead of the frame.
#[derive(Component, Clone, Copy, Debug, PartialEq, Reflect)]
#[reflect(Component)]
pub struct AfterimageDebug(pub DebugView);

#[cfg(test)]
#[path = "../tests/unit/components.rs"]
mod tests;
