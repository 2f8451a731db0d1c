//! Description of a frame, from Bevy's camera.

use crate::camera::{AfterimageSupported, depth_convention, drawn_size_px};
use crate::components::{Afterimage, AfterimageDebug, Foveated, FoveationKind};
use crate::counters::AfterimageStats;
use crate::gaze::{CameraGaze, Gaze};
use crate::layers::Layers;
use crate::oblique::{is_oblique, plain};
use crate::orthographic::{self, is_orthographic};
use afterimage::internal::{ContextDesc, Foveation, Method, ViewFrame};
use afterimage::{DebugView, MotionConvention, ViewGeometry};
use bevy::camera::{ClearColorConfig, CompositingSpace, MainPassResolutionOverride};
use bevy::core_pipeline::prepass::{DeferredPrepass, DepthPrepass, MotionVectorPrepass, PreviousViewData};
use bevy::diagnostic::FrameCount;
use bevy::ecs::entity::EntityHashMap;
use bevy::ecs::query::{QueryData, QueryState};
use bevy::light::Skybox;
use bevy::pbr::ScreenSpaceReflections;
use bevy::prelude::*;
use bevy::render::camera::{TemporalJitter, extract_cameras};
use bevy::render::sync_component::{SyncComponent, SyncComponentPlugin};
use bevy::render::sync_world::RenderEntity;
use bevy::render::{ExtractSchedule, MainWorld, RenderApp};

/// What the post-process needs to know of a camera, in the render world.
#[derive(Component, Clone, Debug)]
pub(crate) struct ExtractedAfterimage {
    pub desc: ContextDesc,
    /// Without jitter, which temporal antialiasing sets later.
    pub view: ViewFrame,
    /// The camera's projection, if its depth is not that of a distance.
    pub oblique: Option<Mat4>,
    /// Jitter of an orthographic camera, which Bevy's does not fit.
    pub jitter_px: Option<[f32; 2]>,
    pub reset: bool,
    pub debug: Option<DebugView>,
    pub counts: bool,
    /// Whether the camera's jitter is told with the opposite sign.
    pub has_planted_jitter: bool,
}

/// Errors that tests plant ([`crate::testing`]) in a camera, to see that they are noticed.
#[derive(Component, Clone, Copy, Debug, Default)]
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
            // Bevy takes the jitter of cameras that have none.
            render_app.add_systems(ExtractSchedule, extract.after(extract_cameras));
        }
    }
}

#[derive(QueryData)]
#[query_data(mutable)]
struct MainCamera {
    main: Entity,
    entity: RenderEntity,
    camera: &'static Camera,
    transform: &'static GlobalTransform,
    afterimage: &'static mut Afterimage,
    foveated: &'static Foveated,
    previous: Option<&'static PreviousViewData>,
    gaze: Option<&'static CameraGaze>,
    debug: Option<&'static AfterimageDebug>,
    planted: Option<&'static Planted>,
    counts: Has<AfterimageStats>,
    // What limits its foveation.
    space: Option<&'static CompositingSpace>,
    sky: Option<&'static Skybox>,
    jitters: Has<TemporalJitter>,
    reflects: Has<ScreenSpaceReflections>,
    is_scaled: Has<MainPassResolutionOverride>,
    depth: Has<DepthPrepass>,
    motion: Has<MotionVectorPrepass>,
    is_deferred: Has<DeferredPrepass>,
}

fn extract(
    mut commands: Commands,
    mut world: ResMut<MainWorld>,
    mut query: Local<Option<QueryState<MainCamera>>>,
    mut said: Local<EntityHashMap<String>>,
) {
    let gaze = *world.resource::<Gaze>();
    let index = u64::from(world.resource::<FrameCount>().0);
    let is_supported = world.contains_resource::<AfterimageSupported>();
    let layers = world.resource::<Layers>().clone();
    let clear_color = world.get_resource::<ClearColor>().cloned().unwrap_or_default();
    // Kept, because a new query looks at every archetype.
    let cameras = query.get_or_insert_with(|| world.query());
    for mut camera in cameras.iter_mut(&mut world) {
        let mut entity = commands.entity(camera.entity);
        let is_foveated = is_supported && camera.foveated.kind != FoveationKind::Off;
        let Some(size) = drawn_size_px(camera.camera).filter(|_| is_foveated) else {
            entity.remove::<ExtractedAfterimage>();
            continue;
        };
        let described = match layers.below(camera.main) {
            Some(below) => Err(format!(
                "it draws on the picture of camera {below}, and quads cannot. Give Afterimage to camera \
                 {below} alone"
            )),
            None => describe(&camera, size, gaze),
        };
        let (mut desc, view, oblique) = match described {
            Ok(described) => described,
            Err(problem) => {
                if said.insert(camera.main, problem.clone()).as_ref() != Some(&problem) {
                    error!("camera {} renders every pixel, without Afterimage: {problem}", camera.main);
                }
                entity.remove::<ExtractedAfterimage>();
                continue;
            }
        };
        said.remove(&camera.main);
        let mut jitter_px = None;
        let planted = camera.planted.copied().unwrap_or_default();
        desc.motion = planted.motion.unwrap_or(desc.motion);
        if let Method::Smr(smr) = &mut desc.settings.method {
            smr.antialias = camera.afterimage.antialias && !camera.jitters;
            let is_flat = oblique.is_some_and(is_orthographic);
            if smr.antialias && is_flat {
                jitter_px = Some(Foveation::jitter_px(index));
            } else if smr.antialias {
                // Bevy's offset moves the camera; content moves the other way.
                let offset = -Vec2::from(Foveation::jitter_px(index));
                entity.insert(TemporalJitter { offset });
            } else if camera.afterimage.antialias {
                warn_once!(
                    "Afterimage does not antialias camera {}: it has TemporalJitter, which temporal antialiasing adds. \
                     Remove that, or set Afterimage::antialias to false",
                    camera.main
                );
            }
            desc.has_albedo = camera.is_deferred && smr.antialias && is_opaque(camera.camera, &clear_color);
            // Of either there is one.
            desc.keep_alpha = !desc.has_albedo;
            if camera.is_deferred && !desc.has_albedo {
                info_once!(
                    "Afterimage remembers textures of deferred camera {} with their light: albedo needs \
                     Afterimage::antialias, and a clear color that is opaque",
                    camera.main
                );
            }
        }
        entity.insert(ExtractedAfterimage {
            desc,
            view,
            oblique,
            jitter_px,
            reset: std::mem::take(&mut camera.afterimage.bypass_change_detection().reset),
            debug: camera.debug.map(|debug| debug.0),
            counts: camera.counts,
            has_planted_jitter: planted.jitter,
        });
    }
}

/// Whether nothing shows through what a camera draws.
fn is_opaque(camera: &Camera, default: &ClearColor) -> bool {
    match camera.clear_color {
        ClearColorConfig::Default => default.0.is_fully_opaque(),
        ClearColorConfig::Custom(color) => color.is_fully_opaque(),
        // A sky is drawn there.
        ClearColorConfig::None => true,
    }
}

/// Context, view, and projection whose depth is not that of a distance.
type Described = (ContextDesc, ViewFrame, Option<Mat4>);

/// Description of a camera's frame, or why it renders every pixel.
fn describe(camera: &MainCameraItem<'_, '_>, size: UVec2, gaze: Gaze) -> Result<Described, String> {
    check(camera)?;
    let uv = camera.gaze.map_or(gaze.uv, |own| own.uv).filter(|uv| uv.is_finite());
    let gaze = uv.map_or(afterimage::Gaze::Lost, |uv| afterimage::Gaze::Uv { uv: uv.to_array() });
    let clip_from_view = camera.camera.clip_from_view();
    let depth = depth_convention(clip_from_view)?;
    let mut desc = ContextDesc::new(size.into());
    desc.settings = camera.afterimage.settings(camera.foveated);
    desc.settings.validate().map_err(|error| error.to_string())?;
    if desc.settings.noisy {
        return Err("its settings expect a noise input, which Bevy does not have".into());
    }
    desc.motion = MotionConvention::BEVY;
    desc.depth = depth;
    let now = clip_from_view * camera.transform.to_matrix().inverse();
    let past = camera.previous.map(|previous| previous.unjittered_clip_from_world);
    let is_flat = is_orthographic(clip_from_view);
    let view = match is_flat {
        true => orthographic::view(size, gaze, now, past),
        false => perspective(size, gaze, clip_from_view, now, past),
    };
    let is_mapped = is_flat || is_oblique(clip_from_view);
    Ok((desc, ViewFrame { depth: Some(depth), ..view? }, is_mapped.then_some(clip_from_view)))
}

/// The view of a perspective camera with its motion.
fn perspective(
    size: UVec2,
    gaze: afterimage::Gaze,
    clip_from_view: Mat4,
    now: Mat4,
    past: Option<Mat4>,
) -> Result<ViewFrame, String> {
    let has_plain = |m: Mat4| if is_oblique(clip_from_view) { plain(m) } else { m }.to_cols_array_2d();
    let projection = has_plain(clip_from_view);
    let geometry = ViewGeometry::from_projection(size.into(), projection).map_err(|error| error.to_string())?;
    let view = ViewFrame::new(geometry, gaze);
    // Matrices that cannot be inverted, as of a camera scaled to 0, have no motion.
    Ok(past.and_then(|past| view.moved(projection, has_plain(now), has_plain(past)).ok()).unwrap_or(view))
}

/// Refuses cameras whose quads cannot be chosen, or cannot be shaded alone.
fn check(camera: &MainCameraItem<'_, '_>) -> Result<(), String> {
    let problem = match () {
        () if camera.space.is_some_and(|space| *space != CompositingSpace::Linear) => {
            "its CompositingSpace is not linear"
        }
        () if camera.reflects => {
            "it has ScreenSpaceReflections, which read the lit frame before history fills it. Remove them"
        }
        () if camera.is_scaled => "it has MainPassResolutionOverride. Change its viewport instead",
        () if matches!(camera.camera.clear_color, ClearColorConfig::None)
            && camera.sky.is_none_or(|sky| sky.image.is_none()) =>
        {
            "its ClearColorConfig::None keeps what the target shows, and a frame of quads cannot. Choose a clear \
             color, or add a Skybox"
        }
        () if !(camera.depth && camera.motion) => {
            "it lacks DepthPrepass or MotionVectorPrepass, by which quads are chosen. Insert both"
        }
        () => return Ok(()),
    };
    Err(problem.into())
}
