//! Fly camera: W, A, S, D move, E and Q move up and down, dragging with the right button turns.

use glam::{DMat4, DQuat, DVec3};
use winit::keyboard::KeyCode;

/// Rotation per pixel of a drag, degrees.
const TURN_DEG_PER_PX: f64 = 0.2;
/// Longest time step in seconds, so that the camera does not jump after a pause.
const MAX_STEP_S: f64 = 0.1;
/// Factor on the speed while Shift is pressed.
const FAST_FACTOR: f64 = 4.0;

/// Keys held down, and the mouse drag since the last step.
#[derive(Clone, Debug, Default)]
pub struct FlyCamera {
    pressed: Vec<KeyCode>,
    /// Whether Shift is pressed.
    pub is_fast: bool,
    dragged_px: [f64; 2],
}

impl FlyCamera {
    /// Handles a key; returns whether it is one that moves the camera.
    pub fn key(&mut self, key: KeyCode, is_down: bool) -> bool {
        if direction(key).is_none() {
            return false;
        }
        self.pressed.retain(|k| *k != key);
        if is_down {
            self.pressed.push(key);
        }
        true
    }

    /// Releases all keys.
    pub fn release(&mut self) {
        *self = Self::default();
    }

    /// Adds a mouse drag.
    pub fn drag(&mut self, by_px: [f64; 2]) {
        self.dragged_px = [self.dragged_px[0] + by_px[0], self.dragged_px[1] + by_px[1]];
    }

    /// The camera pose (x right, y up, looking along -z) after `seconds` at `speed_m_s`.
    pub fn step(&mut self, world_from_camera: DMat4, seconds: f64, speed_m_s: f64) -> DMat4 {
        let [yaw, pitch] = std::mem::take(&mut self.dragged_px).map(|px| (-px * TURN_DEG_PER_PX).to_radians());
        let (eye, mut basis) = (world_from_camera.w_axis.truncate(), DQuat::from_mat4(&world_from_camera));
        // Yaw around the world's vertical axis, so that the horizon stays level.
        basis = (DQuat::from_rotation_y(yaw) * basis * DQuat::from_rotation_x(pitch)).normalize();
        let along: DVec3 = self.pressed.iter().filter_map(|&key| direction(key)).sum();
        let factor = if self.is_fast { FAST_FACTOR } else { 1.0 };
        let stride = speed_m_s * factor * seconds.clamp(0.0, MAX_STEP_S);
        DMat4::from_rotation_translation(basis, eye + basis * (along.normalize_or_zero() * stride))
    }
}

fn direction(key: KeyCode) -> Option<DVec3> {
    Some(match key {
        KeyCode::KeyW => DVec3::NEG_Z,
        KeyCode::KeyS => DVec3::Z,
        KeyCode::KeyA => DVec3::NEG_X,
        KeyCode::KeyD => DVec3::X,
        KeyCode::KeyE => DVec3::Y,
        KeyCode::KeyQ => DVec3::NEG_Y,
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_walk_and_letting_go_stops() {
        let mut camera = FlyCamera::default();
        assert!(camera.key(KeyCode::KeyW, true) && camera.key(KeyCode::KeyW, true) && !camera.key(KeyCode::KeyV, true));
        let there = camera.step(DMat4::IDENTITY, 0.05, 2.0);
        assert!(
            (there.w_axis.truncate() - DVec3::new(0.0, 0.0, -0.1)).length() < 1e-12,
            "a repeated key press counts once"
        );
        assert!(camera.step(DMat4::IDENTITY, 60.0, 2.0).w_axis.z > -0.201, "a pause is no jump");
        camera.key(KeyCode::KeyW, false);
        assert_eq!(camera.step(there, 0.05, 2.0).w_axis, there.w_axis);
    }

    #[test]
    fn a_drag_to_the_right_looks_right_once() {
        let mut camera = FlyCamera::default();
        camera.drag([450.0, 0.0]);
        let turned = camera.step(DMat4::IDENTITY, 0.0, 1.0);
        assert!((turned.transform_vector3(DVec3::NEG_Z) - DVec3::X).length() < 1e-12);
        assert!(camera.step(turned, 0.0, 1.0).abs_diff_eq(turned, 1e-12));
        camera.drag([0.0, -100.0]);
        assert!(camera.step(turned, 0.0, 1.0).transform_vector3(DVec3::NEG_Z).y > 0.3, "and up is up");
    }
}
