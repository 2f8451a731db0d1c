//! Punctual lights and cameras of nodes.

use super::document::Document;
use super::errors::{named, printable};
use super::warnings::Warnings;
use crate::error::InputError;
use crate::scene::animated::{Light, View};
use crate::scene::{PunctualKind, PunctualLight};
use glam::Vec3;
use gltf::json::Index;
use gltf::json::camera::{Camera, Type};
use gltf::json::extensions::scene::khr_lights_punctual as khr;
use gltf::json::validation::Checked;
use std::f32::consts::FRAC_PI_2;

/// Vertical field of view of cameras whose own is out of range.
const FALLBACK_VFOV_DEG: f32 = 45.0;
/// Largest intensity of a light.
const MAX_INTENSITY: f32 = 1e12;

/// Camera of a node; `None` if it is not a perspective camera.
pub(super) fn camera(
    document: &Document,
    node: u32,
    index: Index<Camera>,
    warnings: &mut Warnings,
) -> Result<Option<View>, InputError> {
    let camera = document.look_up(&document.root.cameras, index, "camera")?;
    let name = || named("camera", index.value(), camera.name.as_deref());
    let perspective = match (&camera.type_, &camera.perspective) {
        (Checked::Valid(Type::Perspective), Some(perspective)) => perspective,
        (Checked::Valid(Type::Orthographic), _) => {
            warnings.about("orthographic cameras are left out", name);
            return Ok(None);
        }
        _ => {
            warnings.about("cameras without a projection are left out", name);
            return Ok(None);
        }
    };
    let mut vfov_deg = perspective.yfov.to_degrees();
    if !(vfov_deg > 0.0 && vfov_deg < 180.0) {
        warnings.about("cameras with a field of view out of range have one of 45 degrees", name);
        vfov_deg = FALLBACK_VFOV_DEG;
    }
    // Editors show the node's name.
    let node_name = document.root.nodes[node as usize].name.as_deref().filter(|name| !name.is_empty());
    let name = camera.name.as_deref().filter(|name| !name.is_empty()).or(node_name).unwrap_or_default();
    Ok(Some(View { node, name: name.to_owned(), vfov_deg }))
}

/// Light of a node (KHR_lights_punctual); `None` if its type is unknown.
pub(super) fn light(
    document: &Document,
    node: u32,
    index: Index<khr::Light>,
    warnings: &mut Warnings,
) -> Result<Option<Light>, InputError> {
    let lights = document.root.extensions.as_ref().and_then(|e| e.khr_lights_punctual.as_ref());
    let lights = lights.map_or(&[][..], |l| &l.lights);
    let light = document.look_up(lights, index, "light")?;
    let name = || named("light", index.value(), light.name.as_deref().map(printable).as_deref());
    let kind = match light.type_ {
        Checked::Valid(khr::Type::Directional) => PunctualKind::Directional,
        Checked::Valid(khr::Type::Point) => PunctualKind::Point,
        Checked::Valid(khr::Type::Spot) => {
            let spot =
                light.spot.clone().unwrap_or(khr::Spot { inner_cone_angle: 0.0, outer_cone_angle: FRAC_PI_2 / 2.0 });
            let (inner, outer) = (spot.inner_cone_angle, spot.outer_cone_angle);
            if !(0.0 <= inner && inner < outer && outer <= FRAC_PI_2) {
                warnings.about("cones of spot lights out of range are clamped", name);
            }
            let outer = outer.clamp(1e-3, FRAC_PI_2);
            // Narrow the inner angle enough that the cosines differ.
            let inner = inner.clamp(0.0, outer * 0.999);
            PunctualKind::Spot { cos_inner: inner.cos(), cos_outer: outer.cos() }
        }
        Checked::Invalid => {
            warnings.about("lights of an unknown type are left out", name);
            return Ok(None);
        }
    };
    let scaled = light.color.map(|c| c * light.intensity);
    let intensity = scaled.map(|c| if c.is_nan() { 0.0 } else { c.clamp(0.0, MAX_INTENSITY) });
    if intensity != scaled {
        warnings.about("intensities of lights out of range are clamped", name);
    }
    let range = light.range.filter(|&r| r > 0.0).unwrap_or(f32::INFINITY);
    let light = PunctualLight { kind, position: Vec3::ZERO, direction: Vec3::NEG_Z, intensity, range };
    Ok(Some(Light { node, light }))
}
