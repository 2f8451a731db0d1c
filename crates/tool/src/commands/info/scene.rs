//! `afterimage info` of a scene: contents.

use afterimage_lab::error::InputError;
use afterimage_lab::scene::effects::Effects;
use afterimage_lab::scene::{Environment, Material, PunctualKind, Scene, SceneLimits};

/// Limit on printed names per kind; a file may have thousands.
const MAX_NAMES: usize = 20;

pub fn scene_info(input: &str, animation: Option<&str>) -> Result<(), InputError> {
    let scene = Scene::open_clip(input, animation, &SceneLimits::default())?;
    let pose = scene.pose(0.0);
    say!("{}", scene.name);
    say!("triangles: {} ({} animated)", scene.still().len() + pose.moving.len(), pose.moving.len());
    match scene.bounds() {
        Some(b) => {
            let (o, ends) = (scene.origin.to_array(), [b.min.to_array(), b.max.to_array()]);
            // In the file's coordinates.
            let range = |i: usize| match o[i] {
                0.0 => format!("{} to {}", ends[0][i], ends[1][i]),
                o => format!("{:.3} to {:.3}", o + f64::from(ends[0][i]), o + f64::from(ends[1][i])),
            };
            say!("bounds, m: x {}, y {}, z {}", range(0), range(1), range(2));
        }
        None => say!("bounds: none"),
    }
    let used = used_materials(&scene);
    say!("materials: {}", named(used.iter().map(|m| m.name.as_str())));
    let bytes: usize = scene.textures.iter().map(|t| t.texels.len() * 4).sum();
    say!("textures: {}, {bytes} bytes", scene.textures.len());
    let kinds = [
        ("directional", pose.lights.iter().filter(|l| l.kind == PunctualKind::Directional).count()),
        ("point", pose.lights.iter().filter(|l| l.kind == PunctualKind::Point).count()),
        ("spot", pose.lights.iter().filter(|l| matches!(l.kind, PunctualKind::Spot { .. })).count()),
    ];
    let there: Vec<_> = kinds.iter().filter(|k| k.1 > 0).map(|(kind, count)| format!("{count} {kind}")).collect();
    say!("lights: {}", if there.is_empty() { "none".to_owned() } else { there.join(", ") });
    say!(
        "materials that emit light: {}",
        named(used.iter().filter(|m| m.emissive != [0.0; 3]).map(|m| m.name.as_str()))
    );
    match &scene.environment {
        Environment::Constant([0.0, 0.0, 0.0]) => say!("environment: none"),
        Environment::Constant([r, g, b]) => say!("environment: radiance {r},{g},{b}"),
        Environment::Map(map) => say!("environment: a map of {}x{} px", map.width(), map.height()),
    }
    say!("cameras: {}", named(pose.cameras.iter().map(|c| c.name.as_str())));
    say!("animations: {}", named(scene.animations.iter().map(String::as_str)));
    if scene.animations.len() > 1 {
        say!("choose an animation with --animation NAME, or by its number from 0");
    }
    if scene.duration_s() > 0.0 {
        let which = animation.map_or("the first animation".to_owned(), |name| format!("animation {name}"));
        say!("duration of {which}, s: {:.3}", scene.duration_s());
    }
    let effects: Vec<_> = Effects::needed(&scene).iter().map(|e| e.name()).collect();
    say!("effects used: {}", if effects.is_empty() { "none".to_owned() } else { effects.join(", ") });
    for warning in &scene.warnings {
        say!("warning: {warning}");
    }
    Ok(())
}

/// Materials that at least one triangle uses.
fn used_materials(scene: &Scene) -> Vec<&Material> {
    let mut used = vec![false; scene.materials.len()];
    for &material in scene.still().materials.iter().chain(&scene.pose(0.0).moving.materials) {
        used[material as usize] = true;
    }
    scene.materials.iter().zip(used).filter(|(_, used)| *used).map(|(material, _)| material).collect()
}

/// Number of items, and their names where they have one; escaped, so that names from files stay on one line.
fn named<'a>(names: impl Iterator<Item = &'a str>) -> String {
    let names: Vec<_> = names.collect();
    let quoted: Vec<_> = names.iter().filter(|n| !n.is_empty()).map(|n| format!("'{}'", n.escape_debug())).collect();
    let more = if quoted.len() > MAX_NAMES { ", ..." } else { "" };
    match quoted.len() {
        0 => names.len().to_string(),
        _ => format!("{} ({}{more})", names.len(), quoted[..quoted.len().min(MAX_NAMES)].join(", ")),
    }
}
