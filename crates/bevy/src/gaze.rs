//! Where the user looks.

use bevy::prelude::*;
use bevy::window::PrimaryWindow;

/// Gaze of all cameras without a [`CameraGaze`]. Default: lost.
///
/// ```
/// # use bevy::prelude::*;
/// use bevy_afterimage::Gaze;
///
/// fn read_tracker(mut gaze: ResMut<Gaze>) {
///     gaze.set(Vec2::new(0.4, 0.6)); // or None in a blink
/// }
/// # bevy::ecs::system::assert_is_system(read_tracker);
/// ```
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Reflect)]
#[reflect(Resource, Default)]
pub struct Gaze {
    /// Position in the camera's viewport: (0, 0) is its top-left corner, (1, 1) its bottom-right one. May lie outside.
    /// `None`, or a position that is not finite: lost (a blink); the last known position is used, before the first one
    /// the middle of the viewport.
    pub uv: Option<Vec2>,
}

impl Gaze {
    /// Sets the position, or `None` where the gaze is lost.
    pub fn set(&mut self, uv: impl Into<Option<Vec2>>) {
        self.uv = uv.into();
    }
}

/// Gaze of one camera, as of one eye of a headset. Without it, a camera uses the resource [`Gaze`].
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Reflect)]
#[reflect(Component, Default)]
pub struct CameraGaze {
    /// As [`Gaze::uv`].
    pub uv: Option<Vec2>,
}

impl CameraGaze {
    /// Sets the position, or `None` where the gaze is lost.
    pub fn set(&mut self, uv: impl Into<Option<Vec2>>) {
        self.uv = uv.into();
    }
}

/// Takes the mouse cursor as gaze: in each frame sets the resource [`Gaze`] to the cursor's position in the primary
/// window, or to `None` where it is outside. For cameras whose viewport is the whole window.
#[derive(Clone, Copy, Debug, Default)]
pub struct CursorGazePlugin;

impl Plugin for CursorGazePlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<Gaze>().add_systems(PreUpdate, look_at_cursor);
    }
}

fn look_at_cursor(mut gaze: ResMut<Gaze>, windows: Query<&Window, With<PrimaryWindow>>) {
    let uv = windows.single().ok().and_then(|window| {
        let size = window.size();
        window.cursor_position().filter(|_| size.min_element() > 0.0).map(|position| position / size)
    });
    gaze.set_if_neq(Gaze { uv });
}
