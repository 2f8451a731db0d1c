//! Which pixels the camera shades, and what it draws on top of them.

use crate::common::headless::Headless;
use crate::{SIZE, aliased, change, kind, read, wander};
use bevy::prelude::*;
use bevy::reflect::TypePath;
use bevy::render::RenderApp;
use bevy::render::render_resource::AsBindGroup;
use bevy::shader::{Shader, ShaderRef};
use bevy_afterimage::testing::recorded;
use bevy_afterimage::{Afterimage, Foveated, FoveationKind, Gaze};

/// A material of an application: a grid by `fwidth`, stripes by the position in the target, holes by `discard`.
#[derive(Asset, TypePath, AsBindGroup, Clone)]
struct Grid {}

const SHADER: Handle<Shader> = bevy::asset::uuid_handle!("2c1a8d2e-5a2f-4a8e-9a4f-0b6a3a1f2c55");

const TEXT: &str = "import bevy_pbr::render::forward_io::VertexOutput;
@fragment
fn fragment(in: VertexOutput) -> @location(0) vec4f {
    let at = in.uv * 12.0;
    let line = abs(fract(at - 0.5) - 0.5) / fwidth(at);
    let grid = 1.0 - min(min(line.x, line.y), 1.0);
    let stripe = f32((u32(in.position.x) / 3u + u32(in.position.y) / 5u) % 2u);
    return vec4f(grid, 0.2 + 0.5 * stripe, in.uv.x, 1.0);
}";

impl Material for Grid {
    fn fragment_shader() -> ShaderRef {
        SHADER.into()
    }
}

fn build(
    mut commands: Commands,
    mut shaders: ResMut<Assets<Shader>>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut grids: ResMut<Assets<Grid>>,
    mut standard: ResMut<Assets<StandardMaterial>>,
) {
    shaders.insert(SHADER.id(), Shader::from_wesl(TEXT, "grid.wesl")).expect("inserted");
    let floor = Mesh3d(meshes.add(Plane3d::default().mesh().size(14.0, 14.0)));
    commands.spawn((floor, MeshMaterial3d(grids.add(Grid {})), Transform::from_xyz(0.0, -1.0, -4.0)));
    let cube = meshes.add(Cuboid::from_length(1.4));
    for (i, alpha_mode) in [AlphaMode::Opaque, AlphaMode::Mask(0.5)].into_iter().enumerate() {
        let material = StandardMaterial { base_color: Color::srgb(0.8, 0.5, 0.3), alpha_mode, ..default() };
        let place = Transform::from_xyz(2.6 * i as f32 - 1.3, 0.2, -4.0).with_rotation(Quat::from_rotation_y(0.6));
        commands.spawn((Mesh3d(cube.clone()), MeshMaterial3d(standard.add(material)), place));
    }
    commands.spawn((DirectionalLight::default(), Transform::from_xyz(1.0, 3.0, 2.0).looking_at(Vec3::ZERO, Vec3::Y)));
}

/// Panes of glass before the sky.
fn add_panes(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let pane = meshes.add(Rectangle::new(1.6, 1.2));
    for i in 0..3 {
        let base_color = Color::srgba(0.9, 0.2 + 0.3 * i as f32, 0.3, 0.5);
        let material = StandardMaterial { base_color, alpha_mode: AlphaMode::Blend, unlit: true, ..default() };
        let place = Transform::from_xyz(1.2 * i as f32 - 1.4, 1.6, -3.5).with_rotation(Quat::from_rotation_z(0.3));
        commands.spawn((Mesh3d(pane.clone()), MeshMaterial3d(materials.add(material)), place));
    }
}

fn scene(components: impl Bundle, has_panes: bool) -> Headless {
    let mut headless = Headless::new(
        SIZE,
        (MaterialPlugin::<Grid>::default(), move |app: &mut App| {
            app.add_systems(Startup, build);
            if has_panes {
                app.add_systems(Startup, add_panes);
            }
        }),
    );
    let target = headless.render_target();
    let tonemapping = bevy::core_pipeline::tonemapping::Tonemapping::None;
    headless
        .app
        .world_mut()
        .spawn((Camera3d::default(), target, Msaa::Off, tonemapping, Transform::from_xyz(0.0, 0.5, 0.0)))
        .insert(components);
    headless
}

/// Largest difference of a channel of two pixels.
fn difference(a: &[u8], b: &[u8], i: usize) -> u8 {
    (4 * i..4 * i + 3).map(|at| a[at].abs_diff(b[at])).max().unwrap_or(0)
}

/// Pixels that the foveated camera of an application shades.
pub struct Shaded {
    pub chosen: usize,
    /// Largest difference of a chosen pixel to that of full rate.
    pub worst: u8,
    /// Pixels that are not chosen, and shaded nevertheless.
    pub beside: usize,
}

/// Compares what was shaded in the last frame with full rate.
pub fn shaded(headless: &mut Headless, expected: &[u8]) -> Shaded {
    let given = recorded(headless.app.sub_app_mut(RenderApp).world_mut()).pop().expect("a camera");
    let [color, mask] = [&given.color, &given.mask].map(|texture| read(headless, texture));
    let mut found = Shaded { chosen: 0, worst: 0, beside: 0 };
    let clear = ClearColor::default().0.to_srgba().to_u8_array();
    for i in 0..SIZE.element_product() as usize {
        let at = UVec2::new(i as u32 % SIZE.x, i as u32 / SIZE.x);
        let place = at.x % 2 + 2 * (at.y % 2);
        let is_chosen = mask[4 * (at.y / 2 * given.mask.width() + at.x / 2) as usize] >> place & 1 == 1;
        if is_chosen {
            found.chosen += 1;
            found.worst = found.worst.max(difference(&color, expected, i));
        } else if color[4 * i..4 * i + 3].iter().zip(clear).any(|(found, clear)| found.abs_diff(clear) > 1) {
            found.beside += 1;
        }
    }
    found
}

#[test]
fn chosen_pixels_are_those_of_full_rate_and_no_others_are_shaded() {
    let mut full = scene(kind(FoveationKind::Off), false);
    let mut quads = scene(kind(FoveationKind::Quads), false);
    // Shaders of materials are loaded after the first frames.
    [&mut full, &mut quads].into_iter().for_each(|headless| headless.frames(12));
    for frame in 0..4 {
        wander(&mut full, frame);
        wander(&mut quads, frame);
        let expected = full.shot();
        quads.frames(1);
        let Shaded { chosen, worst, beside } = shaded(&mut quads, &expected);
        println!("frame {frame}: {chosen} pixels chosen, worst difference {worst}/255, {beside} beside");
        assert!(chosen > 1000 && chosen < SIZE.element_product() as usize / 2, "{chosen}");
        assert!(worst <= 1, "{worst}/255");
        assert_eq!(beside, 0);
    }
    assert_eq!(quads.problems(), &[] as &[String]);
}

#[test]
fn transparent_meshes_before_the_sky_are_those_of_full_rate() {
    let shot = |foveation, has_panes| {
        let foveated = Foveated { kind: foveation, ..default() };
        let mut headless = scene((Afterimage { antialias: true, ..default() }, foveated), has_panes);
        headless.app.world_mut().resource_mut::<Gaze>().set(Vec2::new(0.5, 0.9));
        headless.frames(6);
        assert_eq!(headless.problems(), &[] as &[String]);
        headless.read()
    };
    let [bare, full, quads] =
        [shot(FoveationKind::Off, false), shot(FoveationKind::Off, true), shot(FoveationKind::Quads, true)];
    let sky = ClearColor::default().0.to_srgba().to_u8_array();
    let is_sky = |at: IVec2| {
        let at = at.clamp(IVec2::ZERO, SIZE.as_ivec2() - 1).as_uvec2();
        let i = (at.y * SIZE.x + at.x) as usize;
        bare[4 * i..4 * i + 3] == sky[..3]
    };
    // Silhouettes before the sky are antialiased, and full rate is not.
    let is_clear = |i: usize| {
        let at = UVec2::new(i as u32 % SIZE.x, i as u32 / SIZE.x).as_ivec2();
        // Two pixels: samples lie up to half a pixel off, and history's filter swings beside edges.
        (-2..=2).all(|y| (-2..=2).all(|x| is_sky(at + IVec2::new(x, y))))
    };
    let pixels = 0..SIZE.element_product() as usize;
    let panes: Vec<usize> = pixels.filter(|&i| is_clear(i) && difference(&bare, &full, i) > 8).collect();
    let worst = panes.iter().map(|&i| difference(&quads, &full, i)).max().unwrap_or(0);
    println!("{} pixels of panes before the sky, worst difference {worst}/255", panes.len());
    assert!(panes.len() > 1000, "{}", panes.len());
    assert!(worst <= 1, "{worst}/255");
}

#[test]
fn a_shader_with_derivatives_and_positions_is_drawn_as_at_full_rate() {
    let mut headless = scene(kind(FoveationKind::Off), false);
    headless.frames(12);
    let full = headless.read();
    let [gazed, uniform] = [Foveated::default(), Foveated::uniform(0.25)].map(|foveated| {
        change(&mut headless, (aliased(), foveated));
        headless.frames(40);
        crate::psnr_db(&headless.read(), &full)
    });
    assert_eq!(headless.problems(), &[] as &[String]);
    println!("a still view with a grid by fwidth and stripes by position: {gazed:.2} dB, uniform {uniform:.2} dB");
    assert!(gazed > 38.0 && uniform > 38.0, "{gazed:.2} dB, uniform {uniform:.2} dB");
}
