//! Description of a frame, from Bevy's camera.

use crate::camera::{
    Afterimage, AfterimageDebug, AfterimageSupported, Foveated, FoveationKind, depth_convention, drawn_size_px,
};
use crate::counters::AfterimageStats;
use crate::gaze::{CameraGaze, Gaze};
use crate::lattice::{COUNT, LatticeCamera, LatticeCameras, lattice_of};
use afterimage::{ContextDesc, DebugView, Lattice, Method, MotionConvention, ViewFrame, ViewGeometry};
use bevy::core_pipeline::prepass::{DepthPrepass, MotionVectorPrepass, PreviousViewData};
use bevy::ecs::entity::{EntityHashMap, EntityHashSet};
use bevy::prelude::*;
use bevy::render::camera::{SortedCameras, sort_cameras};
use bevy::render::sync_component::{SyncComponent, SyncComponentPlugin};
use bevy::render::sync_world::RenderEntity;
use bevy::render::{Extract, ExtractSchedule, MainWorld, Render, RenderApp, RenderSystems};

/// What the post-process needs to know of a camera, in the render world.
#[derive(Component, Clone, Debug)]
pub(crate) struct ExtractedAfterimage {
    pub kind: FoveationKind,
    pub desc: ContextDesc,
    /// Its jitter is that of the samples. The jitter of temporal antialiasing, which sets it later, is not in it.
    pub view: ViewFrame,
    pub reset: bool,
    pub debug: Option<DebugView>,
    pub counts: bool,
    /// Lattices, in the order in which they are drawn. Empty: the camera renders every pixel.
    pub samples: Vec<Samples>,
    /// Size of the texture that holds the samples, or the camera's pixels.
    pub atlas_px: [u32; 2],
}

impl ExtractedAfterimage {
    /// Lattice cameras draw all meshes.
    pub fn hides_meshes(&self) -> bool {
        !self.samples.is_empty()
    }
}

/// Samples that a lattice camera draws.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Samples {
    /// Render entity of the lattice camera.
    pub camera: Entity,
    pub lattice: Lattice,
}

/// Errors that tests plant ([`crate::testing`]), to see that they are noticed.
#[derive(Resource, Clone, Copy, Debug, Default)]
pub struct Planted {
    /// Another convention of motion vectors than Bevy's.
    pub motion: Option<MotionConvention>,
    /// The post-process gets the opposite jitter.
    pub jitter: bool,
}

// The camera's own component is what makes this one disappear with it.
impl SyncComponent<RenderApp, FramePlugin> for Afterimage {
    type Target = ExtractedAfterimage;
}

pub(crate) struct FramePlugin;

impl Plugin for FramePlugin {
    fn build(&self, app: &mut App) {
        app.add_plugins(SyncComponentPlugin::<Afterimage, FramePlugin>::default());
        if let Some(render_app) = app.get_sub_app_mut(RenderApp) {
            render_app
                .init_resource::<LatticeViews>()
                .add_systems(ExtractSchedule, (extract, forget_despawned))
                .add_systems(Render, draw_lattices_first.after(sort_cameras).in_set(RenderSystems::CreateViews));
        }
    }
}

type MainCamera<'a> = (
    Entity,
    RenderEntity,
    &'a Camera,
    &'a GlobalTransform,
    &'a mut Afterimage,
    &'a Foveated,
    Option<&'a LatticeCameras>,
    Option<&'a PreviousViewData>,
    Option<&'a CameraGaze>,
    (Option<&'a AfterimageDebug>, Has<AfterimageStats>, Has<DepthPrepass>, Has<MotionVectorPrepass>),
);

fn extract(mut commands: Commands, mut world: ResMut<MainWorld>) {
    let gaze = *world.resource::<Gaze>();
    let planted = *world.resource::<Planted>();
    let is_supported = world.contains_resource::<AfterimageSupported>();
    let mut render_entities = world.query::<RenderEntity>();
    let mut cameras = world.query::<MainCamera<'_>>();
    let mut frames = vec![];
    for (main, entity, camera, transform, mut afterimage, foveated, lattices, previous, own, others) in
        cameras.iter_mut(&mut world)
    {
        let (debug, counts, has_depth, has_motion) = others;
        let placed = lattices.and_then(|lattices| Some((lattices.entities, lattices.placed?)));
        let renders = match foveated.kind {
            _ if !is_supported => false,
            FoveationKind::Off => false,
            FoveationKind::Simulated => has_depth && has_motion,
            FoveationKind::Sparse | FoveationKind::QuadViews => placed.is_some(),
        };
        let Some(size) = drawn_size_px(camera).filter(|_| renders) else {
            commands.entity(entity).remove::<ExtractedAfterimage>();
            continue;
        };
        let gaze = match (&placed, own.map_or(gaze.uv, |own| own.uv)) {
            (Some((_, placed)), _) => afterimage::Gaze::At { px: placed.gaze_px },
            (None, Some(uv)) => afterimage::Gaze::Uv { uv: uv.to_array() },
            (None, None) => afterimage::Gaze::Lost,
        };
        let (mut desc, view) = match describe(&afterimage, foveated, camera, size, gaze, (transform, previous)) {
            Ok(described) => described,
            Err(problem) => {
                error_once!("camera {main} renders without Afterimage: {problem}");
                commands.entity(entity).remove::<ExtractedAfterimage>();
                continue;
            }
        };
        desc.motion = planted.motion.unwrap_or(desc.motion);
        let jitter_px = placed.and_then(|(_, placed)| placed.jitter_px);
        let told_px = jitter_px.unwrap_or_default().map(|px| if planted.jitter { -px } else { px });
        if let Method::Smr(smr) = &mut desc.settings.method {
            smr.antialias = jitter_px.is_some();
        }
        let frame = ExtractedAfterimage {
            kind: foveated.kind,
            desc,
            view: ViewFrame { jitter_px: told_px, ..view },
            reset: std::mem::take(&mut afterimage.bypass_change_detection().reset),
            debug: debug.map(|debug| debug.0).filter(|_| foveated.kind != FoveationKind::QuadViews),
            counts,
            samples: vec![],
            atlas_px: size.into(),
        };
        frames.push((entity, frame, placed.map(|placed| (placed, *foveated))));
    }
    for (entity, mut frame, placed) in frames {
        if let Some(((cameras, placed), foveated)) = placed {
            let (lattices, atlas_px) = placed.lattices.in_atlas();
            // Finest first is the order of the stack, and as good as any for drawing.
            frame.samples = (0..COUNT)
                .filter_map(|index| {
                    let lattice = *lattice_of(&lattices, &foveated, index)?;
                    let camera = render_entities.get(&world, cameras[index]).ok()?;
                    Some(Samples { camera, lattice })
                })
                .collect();
            frame.atlas_px = atlas_px;
            frame.view.lattices = Some(lattices);
        }
        commands.entity(entity).insert(frame);
    }
}

fn describe(
    afterimage: &Afterimage,
    foveated: &Foveated,
    camera: &Camera,
    size: UVec2,
    gaze: afterimage::Gaze,
    (transform, previous): (&GlobalTransform, Option<&PreviousViewData>),
) -> Result<(ContextDesc, ViewFrame), String> {
    let depth = depth_convention(camera.clip_from_view())?;
    let mut desc = ContextDesc::new(size.into());
    desc.settings = afterimage.settings(foveated);
    desc.motion = MotionConvention::BEVY;
    desc.depth = depth;
    let clip_from_view = camera.clip_from_view();
    let projection = clip_from_view.to_cols_array_2d();
    let geometry = ViewGeometry::from_projection(size.into(), projection).map_err(|error| error.to_string())?;
    let mut view = ViewFrame { depth: Some(depth), ..ViewFrame::new(geometry, gaze) };
    if let Some(previous) = previous {
        let clip_from_world = clip_from_view * transform.to_matrix().inverse();
        let [now, past] = [clip_from_world, previous.clip_from_world].map(|m| m.to_cols_array_2d());
        // Matrices that cannot be inverted, as of a camera scaled to 0, have no motion.
        view = view.moved(projection, now, past).unwrap_or(view);
    }
    Ok((desc, view))
}

/// Render-world entities of lattice cameras, by their main-world entities.
#[derive(Resource, Default)]
struct LatticeViews(EntityHashMap<Entity>);

/// Despawns the render-world entities of lattice cameras that no longer exist. Bevy does not do so if the main-world
/// entity was `Disabled`, and would go on drawing them.
fn forget_despawned(
    mut commands: Commands,
    mut known: ResMut<LatticeViews>,
    lattices: Extract<Query<(Entity, RenderEntity), With<LatticeCamera>>>,
) {
    for (_, view) in known.0.extract_if(|entity, _| !lattices.contains(*entity)) {
        if let Ok(mut view) = commands.get_entity(view) {
            view.try_despawn();
        }
    }
    known.0.extend(&lattices);
}

/// Puts lattice cameras directly before the camera that shows their samples, whatever the order of other cameras:
/// nothing may draw to the shared shadow maps in between.
fn draw_lattices_first(mut sorted: ResMut<SortedCameras>, frames: Query<&ExtractedAfterimage>) {
    let smalls: EntityHashSet = frames.iter().flat_map(|frame| frame.samples.iter().map(|s| s.camera)).collect();
    if smalls.is_empty() {
        return;
    }
    let (mut small, others): (EntityHashMap<_>, Vec<_>) = std::mem::take(&mut sorted.0).into_iter().fold(
        Default::default(),
        |(mut small, mut others): (EntityHashMap<_>, Vec<_>), camera| {
            if smalls.contains(&camera.entity) {
                small.insert(camera.entity, camera);
            } else {
                others.push(camera);
            }
            (small, others)
        },
    );
    for camera in others {
        if let Ok(frame) = frames.get(camera.entity) {
            sorted.0.extend(frame.samples.iter().filter_map(|samples| small.remove(&samples.camera)));
        }
        sorted.0.push(camera);
    }
}
