//! Lattice cameras: the small views that draw the samples of a sparse frame.

use crate::camera::{Afterimage, AfterimageSupported, Foveated, FoveationKind, depth_convention, drawn_size_px};
use crate::counters::AfterimageStats;
use crate::gaze::{CameraGaze, Gaze};
use afterimage::{Foveation, Lattice, Lattices, Method, ViewGeometry};
use bevy::app::MainScheduleOrder;
use bevy::asset::AssetEventSystems;
use bevy::camera::visibility::{VisibilitySystems, VisibleEntities};
use bevy::camera::{
    CameraProjection, CameraUpdateSystems, ClearColorConfig, CompositingSpace, Hdr, RenderTarget, RenderTargetInfo,
    SubCameraView, Viewport,
};
use bevy::core_pipeline::prepass::{DeferredPrepass, DepthPrepass, MotionVectorPrepass};
use bevy::core_pipeline::tonemapping::{DebandDither, Tonemapping};
use bevy::ecs::entity_disabling::Disabled;
use bevy::ecs::query::{Allow, QueryData};
use bevy::ecs::schedule::ScheduleLabel;
use bevy::light::{SimulationLightSystems, Skybox};
use bevy::math::Vec3A;
use bevy::prelude::*;
use bevy::render::camera::{MipBias, TemporalJitter};
use bevy::render::render_resource::TextureFormat;
use std::any::TypeId;

/// Camera that draws one lattice of samples for another camera, whose child it is. The plugin spawns, moves and
/// despawns it.
///
/// Its entity has `Camera` and `Camera3d`, and is `Disabled` until Bevy needs it: queries of systems in `First` to
/// `Update`, and in `PostUpdate` before `TransformSystems::Propagate`, do not find it. Later ones that should not find
/// it, as those in `Last` and in extraction, need `Without<LatticeCamera>`.
#[derive(Component, Clone, Copy, Debug, Reflect)]
#[reflect(Component)]
pub struct LatticeCamera {
    /// The camera that shows the samples.
    pub camera: Entity,
    /// Which lattice: 0 is the full-rate one, 2 the coarsest.
    pub index: usize,
}

/// Largest number of lattices of a camera: fovea, middle region, periphery.
pub(crate) const COUNT: usize = 3;

/// Sides of the lattices' target are multiples of this, so that it is not made anew whenever the gaze moves.
const TARGET_MULTIPLE_PX: u32 = 64;

/// Lattice cameras of a camera, and what is placed in them.
#[derive(Component, Debug)]
pub(crate) struct LatticeCameras {
    /// By [`LatticeCamera::index`].
    pub entities: [Entity; COUNT],
    /// Where their samples lie in this frame; `None`: the camera renders every pixel itself.
    pub placed: Option<Placed>,
    /// What all of them draw to, one after the other.
    target: Handle<Image>,
    target_size_px: UVec2,
    /// Frame counter, which moves the samples.
    index: u64,
    held_uv: Option<Vec2>,
    /// Why nothing is placed, if the log says so.
    problem: Option<String>,
}

/// Samples of a frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Placed {
    pub lattices: Lattices,
    pub gaze_px: [f32; 2],
    /// Jitter of the projection, with which history antialiases.
    pub jitter_px: Option<[f32; 2]>,
}

/// Systems of lattice cameras, in order, in `PostUpdate`.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum LatticeSystems {
    /// Spawns and despawns lattice cameras, and shows them to queries.
    Spawn,
    /// Copies components that change how meshes are shaded.
    Mirror,
    /// Moves lattice cameras to this frame's samples.
    Place,
}

/// Schedule before `First`.
#[derive(ScheduleLabel, Clone, Debug, PartialEq, Eq, Hash)]
struct HideLattices;

pub(crate) struct LatticePlugin;

impl Plugin for LatticePlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<LatticeCamera>()
            .init_schedule(HideLattices)
            .configure_sets(
                PostUpdate,
                (LatticeSystems::Spawn, LatticeSystems::Mirror, LatticeSystems::Place)
                    .chain()
                    // After the systems that update the camera's own projection and transform.
                    .after(CameraUpdateSystems)
                    .after(TransformSystems::Propagate)
                    .before(AssetEventSystems)
                    .before(VisibilitySystems::UpdateFrusta)
                    .before(VisibilitySystems::VisibilityPropagate)
                    .before(SimulationLightSystems::UpdateDirectionalLightCascades)
                    .before(SimulationLightSystems::AssignLightsToClusters),
            )
            .add_systems(HideLattices, hide)
            .add_systems(
                PostUpdate,
                (
                    (spawn.run_if(resource_exists::<AfterimageSupported>), show).in_set(LatticeSystems::Spawn),
                    place.in_set(LatticeSystems::Place),
                    count_drawn.after(VisibilitySystems::CheckVisibility),
                ),
            );
        app.world_mut().resource_mut::<MainScheduleOrder>().insert_before(First, HideLattices);
    }
}

/// Hides lattice cameras from the application's queries: `Single<&Transform, With<Camera3d>>` finds the one camera that
/// the application has spawned. Bevy's own systems, in `PostUpdate` and in extraction, must find them.
fn hide(mut commands: Commands, shown: Query<Entity, With<LatticeCamera>>) {
    shown.iter().for_each(|entity| {
        commands.entity(entity).insert(Disabled);
    });
}

fn show(mut commands: Commands, hidden: Query<Entity, (With<LatticeCamera>, With<Disabled>)>) {
    hidden.iter().for_each(|entity| {
        commands.entity(entity).remove::<Disabled>();
    });
}

/// Whether the main textures of lattice cameras need another format.
#[derive(Component)]
struct IsHdr(bool);

type Needs<'a> =
    (Entity, Option<&'a Afterimage>, Option<&'a Foveated>, Has<Hdr>, Option<(&'a LatticeCameras, &'a IsHdr)>);

/// Spawns lattice cameras for cameras that need them, and despawns those of others.
fn spawn(
    mut commands: Commands,
    mut images: ResMut<Assets<Image>>,
    cameras: Query<Needs<'_>, With<Camera3d>>,
    lattices: Query<(), (With<LatticeCamera>, Allow<Disabled>)>,
) {
    for (camera, afterimage, foveated, is_hdr, made) in &cameras {
        let is_needed = afterimage.is_some() && foveated.is_some_and(|foveated| foveated.kind.has_lattices());
        if let Some((made, made_hdr)) = made {
            // Children may be despawned by the application.
            let are_there = made.entities.iter().all(|&entity| lattices.contains(entity));
            if is_needed && made_hdr.0 == is_hdr && are_there {
                continue;
            }
            made.entities.iter().for_each(|&entity| commands.entity(entity).try_despawn());
            commands.entity(camera).remove::<(LatticeCameras, IsHdr)>();
        }
        if !is_needed {
            continue;
        }
        let target = images.add(target_image(UVec2::splat(TARGET_MULTIPLE_PX)));
        let entities = std::array::from_fn(|index| {
            let mut lattice = commands.spawn((
                ChildOf(camera),
                LatticeCamera { camera, index },
                Camera3d::default(),
                // The orders differ so that Bevy sees no ambiguity; the plugin sorts the cameras (`frame.rs`).
                Camera { is_active: false, order: index as isize, ..default() },
                RenderTarget::from(target.clone()),
                (Msaa::Off, DebandDither::Disabled),
            ));
            if is_hdr {
                lattice.insert((Hdr, Tonemapping::None));
            }
            lattice.id()
        });
        let lattices = LatticeCameras {
            entities,
            placed: None,
            target,
            target_size_px: UVec2::splat(TARGET_MULTIPLE_PX),
            index: 0,
            held_uv: None,
            problem: None,
        };
        commands.entity(camera).insert((lattices, IsHdr(is_hdr)));
    }
}

fn target_image(size_px: UVec2) -> Image {
    Image::new_target_texture(size_px.x, size_px.y, TextureFormat::Rgba8UnormSrgb, None)
}

type MainCamera<'a> = (
    Entity,
    &'a Camera,
    &'a GlobalTransform,
    &'a Afterimage,
    &'a Foveated,
    &'a mut LatticeCameras,
    Option<&'a CameraGaze>,
    Option<&'a MipBias>,
    Beside<'a>,
);

/// Other components of a camera that limit its foveation.
#[derive(QueryData)]
struct Beside<'a> {
    space: Option<&'a CompositingSpace>,
    sky: Option<&'a Skybox>,
    jitters: Has<TemporalJitter>,
    is_deferred: Has<DeferredPrepass>,
    depth: Has<DepthPrepass>,
    motion: Has<MotionVectorPrepass>,
}

type SmallCamera<'a> = (&'a mut Camera, &'a mut GlobalTransform, &'a mut Projection, &'a mut RenderTarget);

/// Moves the lattice cameras to where this frame's samples are.
fn place(
    mut commands: Commands,
    gaze: Res<Gaze>,
    mut images: ResMut<Assets<Image>>,
    mut cameras: Query<MainCamera<'_>, Without<LatticeCamera>>,
    mut smalls: Query<SmallCamera<'_>, With<LatticeCamera>>,
) {
    for (entity, camera, transform, afterimage, foveated, mut state, own_gaze, mip_bias, beside) in &mut cameras {
        let size = drawn_size_px(camera);
        let uv = own_gaze.map_or(gaze.uv, |own| own.uv).filter(|uv| uv.is_finite());
        state.held_uv = uv.or(state.held_uv);
        state.placed = None;
        if let Some(size) = size {
            match lattices(camera, afterimage, foveated, &state, size, &beside) {
                Ok(placed) if beside.jitters && placed.jitter_px.is_some() => {
                    warn_once!(
                        "Afterimage does not antialias camera {entity}: it has TemporalJitter, which temporal \
                         antialiasing adds. Remove that, or set Afterimage::antialias to false"
                    );
                    state.placed = Some(Placed { jitter_px: None, ..placed });
                }
                Ok(placed) => state.placed = Some(placed),
                Err(problem) if state.problem.as_ref() == Some(&problem) => {}
                Err(problem) => {
                    error!("camera {entity} renders every pixel, without Afterimage: {problem}");
                    state.problem = Some(problem);
                }
            }
        }
        if state.placed.is_some() {
            state.problem = None;
        }
        state.index += 1;
        let placed = state.placed;
        if let Some(placed) = &placed {
            reserve(&mut state, &mut images, placed, foveated);
        }
        for (index, &small) in state.entities.iter().enumerate() {
            let Ok((mut small_camera, mut small_transform, mut projection, mut target)) = smalls.get_mut(small) else {
                continue;
            };
            let lattice = placed.as_ref().and_then(|placed| lattice_of(&placed.lattices, foveated, index));
            if small_camera.is_active != lattice.is_some() {
                small_camera.is_active = lattice.is_some();
            }
            let Some((lattice, size)) = lattice.zip(size) else { continue };
            if target.as_image() != Some(&state.target) {
                *target = state.target.clone().into();
            }
            small_camera.viewport = Some(Viewport { physical_size: lattice.points.into(), ..default() });
            *small_transform = *transform;
            small_camera.clear_color = match camera.clear_color {
                // The sky covers it.
                ClearColorConfig::None => ClearColorConfig::Default,
                color => color,
            };
            small_camera.invert_culling = camera.invert_culling;
            let jitter_px = placed.and_then(|placed| placed.jitter_px).unwrap_or_default();
            let clip_from_view = crop(lattice, size, jitter_px) * camera.clip_from_view();
            *projection = Projection::custom(Cropped(clip_from_view));
            // What Bevy's `camera_system` computes, which has run.
            let size_px = Some(lattice.points.into());
            small_camera.computed.old_viewport_size = size_px;
            small_camera.computed.clip_from_view = clip_from_view;
            small_camera.computed.target_info =
                Some(RenderTargetInfo { physical_size: state.target_size_px, scale_factor: 1.0 });
            let detail = match foveated.kind {
                // A sample is worth one pixel of the full-rate frame.
                FoveationKind::Sparse => -(lattice.step as f32).log2(),
                _ => 0.0,
            };
            commands.entity(small).insert(MipBias(detail + mip_bias.map_or(0.0, |bias| bias.0)));
        }
    }
}

/// Lattices of a frame, or why the camera has none.
fn lattices(
    camera: &Camera,
    afterimage: &Afterimage,
    foveated: &Foveated,
    state: &LatticeCameras,
    size: UVec2,
    beside: &BesideItem<'_, '_, '_>,
) -> Result<Placed, String> {
    if beside.space.is_some_and(|space| *space != CompositingSpace::Linear) {
        return Err("its CompositingSpace is not linear".into());
    }
    if beside.is_deferred {
        return Err("it has DeferredPrepass, and samples are shaded by forward rendering alone".into());
    }
    let has_sky = beside.sky.is_some_and(|sky| sky.image.is_some());
    if matches!(camera.clear_color, ClearColorConfig::None) && !has_sky {
        return Err(
            "its ClearColorConfig::None keeps what the target shows, and sparse samples cannot. Choose a clear color, or \
             add a Skybox"
                .into(),
        );
    }
    if foveated.kind.has_history() && !(beside.depth && beside.motion) {
        return Err("it lacks DepthPrepass or MotionVectorPrepass, which history needs. Insert both".into());
    }
    let settings = afterimage.settings(foveated);
    settings.validate().map_err(|error| error.to_string())?;
    if settings.noisy {
        return Err("its settings expect a noise input, which Bevy does not have".into());
    }
    depth_convention(camera.clip_from_view())?;
    let geometry = ViewGeometry::from_projection(size.into(), camera.clip_from_view().to_cols_array_2d())
        .map_err(|error| error.to_string())?;
    let uv = state.held_uv.unwrap_or(Vec2::splat(0.5));
    let gaze_px = (uv * size.as_vec2() - 0.5).to_array();
    let mut lattices = settings.foveation.lattices(&geometry, gaze_px, state.index);
    if foveated.kind == FoveationKind::QuadViews {
        let still: Vec<_> = lattices.as_slice().iter().map(|lattice| in_the_middle(lattice, size)).collect();
        lattices = Lattices::new(&still).map_err(|error| error.to_string())?;
    }
    let antialiases =
        afterimage.antialias && foveated.kind == FoveationKind::Sparse && matches!(settings.method, Method::Smr(_));
    let jitter_px = antialiases.then(|| Foveation::jitter_px(state.index));
    Ok(Placed { lattices, gaze_px, jitter_px })
}

/// Counts shaded pixels and mesh draws of each camera.
fn count_drawn(
    mut cameras: Query<
        (&Camera, &VisibleEntities, Option<&LatticeCameras>, &mut AfterimageStats),
        Without<LatticeCamera>,
    >,
    smalls: Query<(&Camera, &VisibleEntities), With<LatticeCamera>>,
) {
    let meshes = |visible: &VisibleEntities| visible.len(TypeId::of::<Mesh3d>()) as u64;
    for (camera, visible, lattices, mut stats) in &mut cameras {
        let placed = lattices.and_then(|lattices| Some((&lattices.entities, lattices.placed.as_ref()?)));
        let size = drawn_size_px(camera).unwrap_or_default();
        let (shaded, drawn) = match placed {
            Some((entities, placed)) => {
                let points = |lattice: &Lattice| u64::from(lattice.points[0]) * u64::from(lattice.points[1]);
                let active = entities.iter().filter_map(|&entity| smalls.get(entity).ok()).filter(|(c, _)| c.is_active);
                let drawn: u64 = active.map(|(_, visible)| meshes(visible)).sum();
                (placed.lattices.as_slice().iter().map(points).sum(), drawn)
            }
            None => (u64::from(size.x) * u64::from(size.y), 0),
        };
        let meshes = meshes(visible);
        let now = AfterimageStats { shaded, meshes, drawn_meshes: meshes + drawn, ..*stats };
        stats.set_if_neq(now);
    }
}

/// The lattice with its samples in the middle of their blocks.
fn in_the_middle(lattice: &Lattice, size: UVec2) -> Lattice {
    let size: [u32; 2] = size.into();
    let low = lattice.covered_px()[0];
    let first_px = [0, 1].map(|i| (low[i] + lattice.step / 2).min(size[i] - 1));
    Lattice { first_px, ..*lattice }
}

/// The lattice that camera `index` draws, if it is in the stack: regions may lie outside the view.
pub(crate) fn lattice_of<'a>(lattices: &'a Lattices, foveated: &Foveated, index: usize) -> Option<&'a Lattice> {
    let steps = [1, foveated.rate_mid, foveated.rate_far];
    // Equal rates are one lattice, that of the last camera with this rate.
    let is_repeated = steps[index + 1..].contains(&steps[index]);
    lattices.as_slice().iter().find(|lattice| lattice.step == steps[index] && !is_repeated)
}

/// Makes the target large enough. It becomes smaller only where the view has become much smaller.
fn reserve(state: &mut LatticeCameras, images: &mut Assets<Image>, placed: &Placed, foveated: &Foveated) {
    let needed = (0..COUNT)
        .filter_map(|index| lattice_of(&placed.lattices, foveated, index))
        .fold(UVec2::ONE, |size, lattice| size.max(lattice.points.into()));
    let rounded = needed.map(|side| side.next_multiple_of(TARGET_MULTIPLE_PX));
    let has = state.target_size_px;
    if rounded.cmpgt(has).any() || rounded.element_product() * 4 < has.element_product() {
        let size = if rounded.cmpgt(has).any() { rounded.max(has.min(rounded * 2)) } else { rounded };
        state.target = images.add(target_image(size));
        state.target_size_px = size;
    }
}

/// Crop of clip space to the rectangle of a lattice, shifted so that the middles of its texels are those of the
/// samples' pixels, and then by the jitter, in pixels of the view.
fn crop(lattice: &Lattice, size: UVec2, jitter_px: [f32; 2]) -> Mat4 {
    let [size, first, points] = [size, lattice.first_px.into(), lattice.points.into()].map(|v: UVec2| v.as_dvec2());
    let step = f64::from(lattice.step);
    let covered = points * step;
    let scale = size / covered;
    let offset = (size - 1.0 - 2.0 * first + step + 2.0 * Vec2::from(jitter_px).as_dvec2()) / covered - 1.0;
    // Rounded once. Clip space has y up.
    let [scale, offset] = [scale, offset].map(|v| v.as_vec2());
    Mat4::from_cols(Vec4::X * scale.x, Vec4::Y * scale.y, Vec4::Z, Vec4::new(offset.x, -offset.y, 0.0, 1.0))
}

/// Cropped projection of a lattice camera: clip from view, reversed depth.
#[derive(Clone, Copy, Debug)]
struct Cropped(Mat4);

impl CameraProjection for Cropped {
    fn get_clip_from_view(&self) -> Mat4 {
        self.0
    }

    fn get_clip_from_view_for_sub(&self, _: &SubCameraView) -> Mat4 {
        self.0
    }

    fn update(&mut self, _width: f32, _height: f32) {}

    fn far(&self) -> f32 {
        // Depth 0 is at `w.z / z.z`, which is infinite for Bevy's usual projection.
        let (z, w) = (self.0.z_axis.z, self.0.w_axis.z);
        if z > 0.0 { w / z } else { f32::MAX }
    }

    fn get_frustum_corners(&self, z_near: f32, z_far: f32) -> [Vec3A; 8] {
        let Mat4 { x_axis: x, y_axis: y, z_axis: z, .. } = self.0;
        // In Bevy's order: bottom right, top right, top left, bottom left; near, then far.
        let corner =
            |depth: f32, [u, v]: [f32; 2]| Vec3A::new(-depth * (u + z.x) / x.x, -depth * (v + z.y) / y.y, depth);
        let corners = [[1.0, -1.0], [1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0]];
        let mut all = [Vec3A::ZERO; 8];
        for (i, ndc) in corners.into_iter().enumerate() {
            (all[i], all[i + 4]) = (corner(z_near, ndc), corner(z_far, ndc));
        }
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const JITTERS_PX: [[f32; 2]; 2] = [[0.0, 0.0], [0.375, -0.25]];

    #[test]
    fn a_texel_of_a_crop_shows_its_sample() {
        let size = UVec2::new(1280, 720);
        let projection = PerspectiveProjection::default().get_clip_from_view();
        for (step, first_px, points) in [(1, [403, 77], [155, 154]), (4, [3, 1], [320, 180]), (2, [301, 40], [90, 111])]
        {
            let lattice = Lattice { step, first_px, points, atlas_texel: None };
            let texels = [[0, 0], [points[0] - 1, points[1] / 2]];
            for (texel, jitter) in texels.into_iter().flat_map(|texel| JITTERS_PX.map(|jitter| (texel, jitter))) {
                let point = Vec3::new(0.3, -0.2, -3.0);
                let seen = |clip: Mat4, size: Vec2| {
                    let ndc = clip.project_point3(point);
                    (Vec2::new(ndc.x, -ndc.y) * 0.5 + 0.5) * size
                };
                let full = seen(projection, size.as_vec2());
                let small = seen(crop(&lattice, size, jitter) * projection, UVec2::from(points).as_vec2());
                // In pixels from the middle of the sample's pixel, and in texels from that of its texel.
                let pixel = UVec2::from(first_px) + UVec2::from(texel) * step;
                let from_pixel = full + Vec2::from(jitter) - pixel.as_vec2() - 0.5;
                let from_texel = small - UVec2::from(texel).as_vec2() - 0.5;
                assert!(
                    (from_pixel - from_texel * step as f32).abs().max_element() < 0.01,
                    "{from_pixel} {from_texel}"
                );
            }
        }
    }

    #[test]
    fn corners_are_those_of_the_perspective_projection() {
        let projection = PerspectiveProjection::default();
        let expected = projection.get_frustum_corners(-0.1, -7.0);
        let found = Cropped(projection.get_clip_from_view()).get_frustum_corners(-0.1, -7.0);
        for (a, b) in expected.into_iter().zip(found) {
            assert!((a - b).abs().max_element() < 1e-4, "{a} {b}");
        }
    }
}
