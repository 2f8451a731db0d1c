//! Selection of an animation, and its curves.

use super::accessors::Accessors;
use super::document::Document;
use super::errors::{named, printable};
use super::warnings::Warnings;
use crate::error::InputError;
use crate::scene::animated::curve::{Curve, Interpolation};
use crate::scene::animated::{Channel, Property};
use gltf::json::validation::Checked;
use gltf::json::{self, animation};

/// Channels of the animation with the name or index `clip`, by default the first; empty if the file has no animation.
pub(super) fn channels(
    document: &Document,
    accessors: &Accessors,
    clip: Option<&str>,
    warnings: &mut Warnings,
) -> Result<Vec<Channel>, InputError> {
    let animations = &document.root.animations;
    let index = match clip {
        Some(clip) => find(document, clip)?,
        None => 0,
    };
    let Some(animation) = animations.get(index) else { return Ok(Vec::new()) };
    let name = || named("animation", index, animation.name.as_deref());
    let targets = targets(document.root);
    let mut channels = Vec::new();
    for channel in &animation.channels {
        let node = document.look_up(&document.root.nodes, channel.target.node, "node")?;
        let sampler = document.look_up(&animation.samplers, channel.sampler, "sampler")?;
        let property = match channel.target.path {
            Checked::Valid(animation::Property::Translation) => Property::Translation,
            Checked::Valid(animation::Property::Rotation) => Property::Rotation,
            Checked::Valid(animation::Property::Scale) => Property::Scale,
            Checked::Valid(animation::Property::MorphTargetWeights) => Property::Weights,
            Checked::Invalid => {
                warnings.about("channels of animations that set something unknown are left out", name);
                continue;
            }
        };
        let width = match property {
            Property::Translation | Property::Scale => 3,
            Property::Rotation => 4,
            Property::Weights => node.mesh.and_then(|mesh| targets.get(mesh.value()).copied()).unwrap_or(0),
        };
        if width == 0 {
            warnings.about("weights of morph targets that do not exist are left out", name);
            continue;
        }
        let curve = curve(document, accessors, sampler, property, width)?;
        channels.push(Channel { node: channel.target.node.value() as u32, property, curve });
    }
    Ok(channels)
}

/// Number of morph targets of each mesh of the file.
fn targets(root: &json::Root) -> Vec<usize> {
    let of = |mesh: &json::Mesh| mesh.primitives.iter().map(|p| p.targets.as_ref().map_or(0, Vec::len)).max();
    root.meshes.iter().map(|mesh| of(mesh).unwrap_or(0)).collect()
}

fn curve(
    document: &Document,
    accessors: &Accessors,
    sampler: &animation::Sampler,
    property: Property,
    width: usize,
) -> Result<Curve, InputError> {
    let interpolation = match sampler.interpolation {
        Checked::Valid(animation::Interpolation::Step) => Interpolation::Step,
        Checked::Valid(animation::Interpolation::Linear) => Interpolation::Linear,
        Checked::Valid(animation::Interpolation::CubicSpline) => Interpolation::Cubic,
        Checked::Invalid => return Err(document.damaged("an animation has an unknown interpolation")),
    };
    let times = accessors.vectors::<1>(sampler.input, "times of keys", None)?.into_flattened();
    if times.is_empty() || !times.iter().all(|t| t.is_finite()) || !times.is_sorted() {
        let problem = format!("accessor {} for times of keys is empty, not finite or not ascending", sampler.input);
        return Err(document.damaged(problem));
    }
    let stored = times.len().saturating_mul(if interpolation == Interpolation::Cubic { 3 } else { 1 });
    let output = sampler.output;
    let values = match property {
        Property::Weights => {
            let expected = Some(stored.saturating_mul(width));
            accessors.vectors::<1>(output, "weights of keys", expected)?.into_flattened()
        }
        Property::Rotation => accessors.vectors::<4>(output, "rotations of keys", Some(stored))?.into_flattened(),
        Property::Translation | Property::Scale => {
            accessors.vectors::<3>(output, "values of keys", Some(stored))?.into_flattened()
        }
    };
    if !values.iter().all(|v| v.is_finite()) {
        return Err(document.damaged(format!("accessor {output} for values of keys holds what is not finite")));
    }
    Ok(Curve { times, values, width, interpolation })
}

fn find(document: &Document, clip: &str) -> Result<usize, InputError> {
    let animations = &document.root.animations;
    let by_name = animations.iter().position(|a| a.name.as_deref() == Some(clip));
    let by_number = || clip.parse().ok().filter(|&n| n < animations.len());
    by_name.or_else(by_number).ok_or_else(|| {
        let names = animations.iter().enumerate().take(20).map(|(i, a)| named("animation", i, a.name.as_deref()));
        let names = names.collect::<Vec<_>>().join(", ");
        InputError::request(
            document.subject,
            format!("has no animation \"{}\"", printable(clip)),
            if names.is_empty() { "it has no animations".to_owned() } else { format!("expected one of {names}") },
        )
    })
}
