//! Completes the JSON of a file before the crate `gltf` parses it: properties that glTF 2.0 makes optional and the
//! crate takes for required, and channels and textures that only extensions give a target.

use super::errors::named;
use super::warnings::Warnings;
use serde_json::{Number, Value, json};

/// Warned of: channels that this reader cannot follow.
const NO_NODE: &str = "channels of animations without a node (KHR_animation_pointer has such) are left out";
/// Warned of: textures whose image only an extension names.
const NO_IMAGE: &str = "textures without an image that can be read are left out";
/// Warned of: what is absent is written so.
const NULL: &str = "properties that are null are taken as absent";

/// Completes a file's JSON. Every reference is still looked up with a check afterwards.
pub(super) fn complete(root: &mut Value, warnings: &mut Warnings) {
    for scene in items(root, "scenes") {
        if let Some(scene) = scene.as_object_mut() {
            scene.entry("nodes").or_insert_with(|| json!([]));
        }
    }
    for (i, animation) in items(root, "animations").iter_mut().enumerate() {
        let name = animation["name"].as_str().map(str::to_owned);
        let Some(channels) = animation.get_mut("channels").and_then(Value::as_array_mut) else { continue };
        let before = channels.len();
        channels.retain(|channel| channel["target"].is_null() || channel["target"].get("node").is_some());
        if channels.len() < before {
            warnings.about(NO_NODE, || named("animation", i, name.as_deref()));
        }
    }
    for (i, texture) in items(root, "textures").iter_mut().enumerate() {
        // The crate's value of a source that is not there: here it is one that no file has.
        if texture["source"] == u32::MAX {
            texture["source"] = json!(u32::MAX - 1);
        }
        if texture.get("source").is_none() {
            let extensions = texture["extensions"].as_object().map(|names| names.keys().cloned().collect::<Vec<_>>());
            let extensions = extensions.filter(|names| !names.is_empty()).map(|names| names.join(", "));
            warnings.about(NO_IMAGE, || named("texture", i, extensions.as_deref().or(texture["name"].as_str())));
        }
    }
}

/// Writes a description that the crate refuses as it expects: no members that are null, and whole numbers as integers,
/// which the schema also allows as `3.0`. Whether anything changed. The parser bounds the depth.
pub(super) fn make_plain(value: &mut Value, warnings: &mut Warnings) -> bool {
    match value {
        Value::Object(members) => {
            let before = members.len();
            members.retain(|_, member| !member.is_null());
            let has_nulls = members.len() < before;
            if has_nulls {
                warnings.add(NULL);
            }
            members.values_mut().fold(has_nulls, |changed, member| changed | make_plain(member, warnings))
        }
        Value::Array(elements) => {
            elements.iter_mut().fold(false, |changed, element| changed | make_plain(element, warnings))
        }
        Value::Number(number) if number.is_f64() => match number.as_f64().and_then(whole) {
            Some(whole) => {
                *number = whole;
                true
            }
            None => false,
        },
        _ => false,
    }
}

/// The integer that a float is, if all its digits count.
fn whole(number: f64) -> Option<Number> {
    const EXACT: f64 = (1u64 << 53) as f64;
    (number.fract() == 0.0 && number.abs() <= EXACT).then(|| Number::from(number as i64))
}

/// Elements of a list of the file; none if it has no such list.
fn items<'a>(root: &'a mut Value, list: &str) -> &'a mut [Value] {
    root.get_mut(list).and_then(Value::as_array_mut).map_or(&mut [], |items| items)
}
