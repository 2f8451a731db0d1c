//! Deferred cameras give the post-process the albedo of their G-buffer.

use crate::antialiasing::{SAMPLES, averaged};
use crate::common::headless::Headless;
use crate::common::scene::{ScenePlugin, TONEMAPPING};
use crate::deferred::{deferred, yard};
use crate::{add_stroller, aliased, clip_psnr_db, clips, linear, read};
use bevy::asset::AssetMut;
use bevy::camera::{ClearColorConfig, RenderTarget, Viewport};
use bevy::core_pipeline::prepass::DeferredPrepass;
use bevy::material::OpaqueRendererMethod;
use bevy::pbr::DefaultOpaqueRendererMethod;
use bevy::prelude::*;
use bevy::render::RenderApp;
use bevy::shader::{Shader, Source};
use bevy_afterimage::testing::recorded;
use bevy_afterimage::{Afterimage, Foveated, FoveationKind};

/// That of the reference in [`averaged`].
const SIZE: UVec2 = crate::antialiasing::SIZE;

/// The courtyard, of which every material is deferred.
fn courtyard() -> Headless {
    let deferred = |app: &mut App| {
        app.insert_resource(DefaultOpaqueRendererMethod::deferred());
    };
    Headless::new(SIZE, (ScenePlugin { lamps: 4, moves: true }, deferred))
}

/// A camera whose clear color lets something through, so that alpha is kept, and albedo has no place.
fn without_albedo() -> Camera {
    let color = ClearColor::default().0.with_alpha(0.0);
    Camera { clear_color: ClearColorConfig::Custom(color), ..default() }
}

/// The shader that writes albedos.
fn albedos_shader(headless: &mut Headless) -> AssetMut<'_, Shader> {
    let shaders = headless.app.world_mut().resource_mut::<Assets<Shader>>().into_inner();
    let is_albedos = |shader: &Shader| shader.path.ends_with("bevy_afterimage/albedo.wesl");
    let id = shaders.iter().find(|(_, shader)| is_albedos(shader)).expect("the shader").0;
    shaders.get_mut(id).expect("the shader")
}

/// Changes the shader that writes albedos, as an error in it would; its text before.
fn plant(headless: &mut Headless, (right, wrong): (&str, &str)) -> String {
    let mut shader = albedos_shader(headless);
    let text = shader.source.as_str().to_owned();
    assert!(text.contains(right), "{right}");
    shader.source = Source::Wesl(text.replace(right, wrong).into());
    text
}

/// What a camera shows: 16 samples of every pixel, or a share of the pixels, with albedo or without.
#[derive(Clone, Copy, PartialEq)]
enum Shown {
    Reference,
    WithAlbedo,
    WithoutAlbedo,
}

/// Frames of cameras that stroll.
fn strolls<const N: usize, B: Bundle>(
    mut headless: Headless,
    shown: [Shown; N],
    components: fn() -> B,
) -> [Vec<Vec<u8>>; N] {
    let targets = shown.map(|shown| {
        let image = headless.add_target(if shown == Shown::Reference { SIZE * SAMPLES } else { SIZE });
        let (antialias, foveated) = match shown {
            Shown::Reference => (false, Foveated { kind: FoveationKind::Off, ..default() }),
            _ => (true, Foveated::uniform(SHARE)),
        };
        let camera = if shown == Shown::WithoutAlbedo { without_albedo() } else { Camera::default() };
        let camera = (camera, deferred(), Afterimage { antialias, ..default() }, foveated, components());
        add_stroller(&mut headless, RenderTarget::from(image.clone()), camera);
        image
    });
    let mut clips = clips((headless, targets), 20, 8);
    let references = clips.iter_mut().zip(shown).filter(|(_, shown)| *shown == Shown::Reference);
    references.for_each(|(clip, _)| clip.iter_mut().for_each(|shot| *shot = averaged(shot)));
    clips
}

const ALL: [Shown; 3] = [Shown::Reference, Shown::WithAlbedo, Shown::WithoutAlbedo];

/// PSNR with albedo, and without.
fn gain(shots: &[Vec<Vec<u8>>; 3], what: &str) -> [f64; 2] {
    let [with, without] = [1, 2].map(|i| clip_psnr_db(&shots[i], &shots[0]));
    println!("{what}: {with:.2} dB with albedo, {without:.2} dB without");
    [with, without]
}

const SHARE: f32 = 0.1;

#[test]
fn textures_are_better_with_albedo_than_without_and_with_a_wrong_one() {
    let right = strolls(courtyard(), ALL, || ());
    let [with, without] = gain(&right, "tone mapped");
    assert!(with > without + 0.2, "{with:.2} dB, without {without:.2} dB");
    // That of a pixel beside.
    let mut headless = courtyard();
    plant(&mut headless, ("+ vec2u(view.viewport.xy)", "+ vec2u(view.viewport.xy) + 2u"));
    let [wrong] = strolls(headless, [Shown::WithAlbedo], || ());
    let wrong = clip_psnr_db(&wrong, &right[0]);
    println!("albedo of another pixel: {wrong:.2} dB");
    assert!(with > wrong + 0.2, "{with:.2} dB, with that of another pixel {wrong:.2} dB");
}

#[test]
fn so_are_those_of_linear_frames() {
    let [with, without] = gain(&strolls(courtyard(), ALL, linear), "linear");
    assert!(with > without + 0.1, "{with:.2} dB, without {without:.2} dB");
}

#[test]
fn beside_forward_unlit_and_shining_materials_frames_are_not_worse() {
    let mut headless = yard(true);
    let mut materials = headless.app.world_mut().resource_mut::<Assets<StandardMaterial>>();
    let deferred = |(_, material): &(_, &StandardMaterial)| material.opaque_render_method == OpaqueRendererMethod::Auto;
    let deferred: Vec<_> = materials.iter().filter(deferred).map(|(id, _)| id).collect();
    for (i, id) in deferred.into_iter().enumerate() {
        let mut material = materials.get_mut(id).expect("a material");
        match i % 3 {
            0 => material.unlit = true,
            1 => {
                (material.emissive, material.emissive_texture) =
                    (LinearRgba::rgb(2.0, 1.0, 0.5), material.base_color_texture.clone())
            }
            _ => {}
        }
    }
    let [with, without] = gain(&strolls(headless, ALL, || ()), "mixed");
    assert!(with > without - 0.05, "{with:.2} dB, without {without:.2} dB");
}

/// What materials become: an albedo, or `None` where it is not known.
fn materials() -> [(StandardMaterial, Option<Vec3>); 9] {
    let base = Vec3::new(0.8, 0.4, 0.2);
    let plain = StandardMaterial { base_color: Color::from(LinearRgba::from_vec3(base)), ..default() };
    let of = |change: fn(&mut StandardMaterial), albedo: Option<Vec3>| {
        let mut material = plain.clone();
        change(&mut material);
        (material, albedo)
    };
    [
        of(|_| {}, Some(base + 0.04)),
        of(|material| material.metallic = 1.0, Some(base)),
        of(|material| (material.metallic, material.reflectance) = (0.5, 1.0), Some(base + 0.08)),
        of(|material| material.base_color = Color::BLACK, Some(Vec3::splat(0.04))),
        of(|material| material.base_color = Color::WHITE, Some(Vec3::ONE)),
        of(|material| material.unlit = true, Some(Vec3::ZERO)),
        of(|material| material.emissive = LinearRgba::rgb(2.0, 1.0, 0.0), Some(Vec3::ZERO)),
        of(|material| material.emissive = LinearRgba::rgb(0.1, 0.2, 0.1), Some(base + 0.04)),
        of(|material| material.opaque_render_method = OpaqueRendererMethod::Forward, None),
    ]
}

/// Place of a material's square, whose sides are 1, from a camera 5 away.
fn place(i: usize) -> Vec2 {
    1.3 * Vec2::new((i % 3) as f32 - 1.0, (i / 3) as f32 - 1.0)
}

/// Squares of `materials`, seen through a viewport.
fn squares() -> Headless {
    let add = |mut commands: Commands, mut meshes: ResMut<Assets<Mesh>>, mut all: ResMut<Assets<StandardMaterial>>| {
        let square = Mesh3d(meshes.add(Rectangle::from_length(1.0)));
        for (i, (material, _)) in materials().into_iter().enumerate() {
            let place = Transform::from_translation(place(i).extend(0.0));
            commands.spawn((square.clone(), MeshMaterial3d(all.add(material)), place));
        }
    };
    let mut headless = Headless::new(SIZE, move |app: &mut App| {
        app.insert_resource(DefaultOpaqueRendererMethod::deferred()).add_systems(Startup, add);
    });
    let viewport = Viewport { physical_position: UVec2::new(21, 13), physical_size: UVec2::new(201, 115), ..default() };
    let camera = Camera { viewport: Some(viewport), ..default() };
    let target = headless.render_target();
    let view = (Camera3d::default(), camera, target, Msaa::Off, TONEMAPPING, Transform::from_xyz(0.0, 0.0, 5.0));
    headless.app.world_mut().spawn((view, deferred(), Afterimage::default()));
    headless
}

/// A float of 16 bits.
fn half(bits: u16) -> f32 {
    let (exponent, mantissa) = (i32::from(bits >> 10 & 31), f32::from(bits & 1023));
    match exponent {
        0 => mantissa * 2f32.powi(-24),
        31 => f32::INFINITY,
        _ => (1.0 + mantissa / 1024.0) * 2f32.powi(exponent - 15),
    }
}

/// Pixels of a frame of the squares whose albedo is not that of the material there, and those in squares.
fn wrong_pixels(headless: &mut Headless) -> [usize; 2] {
    headless.frames(1);
    assert_eq!(headless.problems(), &[] as &[String]);
    let given = recorded(headless.app.sub_app_mut(RenderApp).world_mut()).pop().expect("a camera");
    let albedo = given.albedo.expect("an albedo");
    let size = Vec2::from(given.desc.size_px.map(|side| side as f32));
    let texels: Vec<_> = read(headless, &albedo).chunks(2).map(|h| half(u16::from_le_bytes([h[0], h[1]]))).collect();
    let px_of_unit = size.y / (2.0 * 5.0 * (std::f32::consts::PI / 8.0).tan());
    let [mut wrong, mut inside] = [0, 0];
    for (i, texel) in texels.chunks(4).enumerate() {
        let px = Vec2::new((i as u32 % albedo.width()) as f32, (i as u32 / albedo.width()) as f32) + 0.5;
        let at = (px - Vec2::from(given.view.jitter_px) - 0.5 * size) * Vec2::new(1.0, -1.0) / px_of_unit;
        let distance = |k: usize| (at - place(k)).abs().max_element() - 0.5;
        let nearest = (0..9).min_by(|&a, &b| distance(a).total_cmp(&distance(b))).expect("nine");
        if distance(nearest).abs() < 0.05 / px_of_unit {
            continue;
        }
        let is_inside = distance(nearest) < 0.0;
        let expected = if is_inside { materials()[nearest].1 } else { Some(Vec3::ZERO) };
        let found = Vec3::from_slice(texel);
        inside += usize::from(is_inside);
        wrong += usize::from(expected.map_or(found.is_finite(), |expected| !found.abs_diff_eq(expected, 0.01)));
    }
    [wrong, inside]
}

#[test]
fn the_albedo_is_that_of_the_material_at_every_pixel() {
    let mut headless = squares();
    headless.frames(2);
    for _ in 0..4 {
        let [wrong, inside] = wrong_pixels(&mut headless);
        println!("{inside} pixels of materials, {wrong} wrong");
        assert!(inside > 5000, "{inside}");
        assert_eq!(wrong, 0);
    }
}

#[test]
fn a_wrong_albedo_is_caught() {
    let mut headless = squares();
    for planted in [
        ("id.xy + vec2u(view.viewport.xy)", "id.xy + vec2u(view.viewport.xy) + 1u"),
        ("id.xy + vec2u(view.viewport.xy)", "id.xy"),
        ("+ calculate_F0(base, material.metallic, material.reflectance)", ""),
        ("calculate_diffuse_color(base, material.metallic, 0.0, 0.0)", "base"),
        ("is_unlit || ", ""),
        ("dot(material.emissive.rgb, LUMA) > dot(reflected, LUMA)", "false"),
        ("dot(material.emissive.rgb, LUMA) > dot(reflected, LUMA)", "dot(material.emissive.rgb, LUMA) > 0.0"),
        ("saturate(reflected)", "reflected"),
        ("unknown, 0.0, far == 0.0", "unknown, 0.0, true"),
        ("unknown, 0.0, far == 0.0", "unknown, 0.0, false"),
        ("textureLoad(lighting, at, 0).r == BEVYS_PASS", "true"),
    ] {
        let right = plant(&mut headless, planted);
        headless.frames(2);
        let [wrong, _] = wrong_pixels(&mut headless);
        println!("{wrong} pixels: {} -> {}", planted.0, planted.1);
        assert!(wrong > 0, "{} -> {}", planted.0, planted.1);
        albedos_shader(&mut headless).source = Source::Wesl(right.into());
        headless.frames(2);
        assert_eq!(wrong_pixels(&mut headless)[0], 0, "without {}", planted.1);
    }
}

/// With deferred rendering, antialiasing, and an opaque clear color.
#[test]
fn albedo_comes_and_goes() {
    // Of materials that are drawn forward where a camera does not say otherwise: Bevy cannot do without a prepass of
    // those that are deferred.
    let mut headless = Headless::new(SIZE, ScenePlugin { lamps: 4, moves: true });
    let target = headless.render_target();
    add_stroller(&mut headless, target, Afterimage::default());
    let world = headless.app.world_mut();
    let camera = world.query_filtered::<Entity, With<Afterimage>>().single(world).expect("a camera");
    let opaque = Camera::default().clear_color;
    let clear = without_albedo().clear_color;
    for (has_albedo, is_deferred, afterimage, clear_color, size) in [
        (true, true, Afterimage::default(), opaque, SIZE),
        (false, true, aliased(), opaque, SIZE),
        (false, true, Afterimage::default(), clear, SIZE),
        (true, true, Afterimage::default(), opaque, SIZE + 30),
        (false, false, Afterimage::default(), opaque, SIZE + 30),
        (true, true, Afterimage::default(), opaque, SIZE),
    ] {
        let mut camera = headless.app.world_mut().entity_mut(camera);
        if is_deferred {
            camera.insert(deferred());
        } else {
            camera.remove::<DeferredPrepass>();
        }
        camera.insert(afterimage);
        let mut camera = camera.get_mut::<Camera>().expect("a camera");
        camera.clear_color = clear_color;
        let target = headless.target.clone();
        headless.resize(&target, size);
        headless.frames(4);
        assert_eq!(headless.problems(), &[] as &[String]);
        let given = recorded(headless.app.sub_app_mut(RenderApp).world_mut()).pop().expect("a camera");
        let sides = given.albedo.map(|albedo| [albedo.width(), albedo.height()]);
        assert_eq!(sides, has_albedo.then_some(size.to_array()));
        assert_eq!([given.desc.has_albedo, !given.desc.keep_alpha], [has_albedo; 2]);
    }
}
