//! Description of a frame, from Bevy's camera.

use crate::camera::{AfterimageSupported, WithoutMsaa, depth_convention, drawn_size_px};
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
use bevy::render::camera::{ExtractedCamera, MipBias, TemporalJitter, extract_cameras};
use bevy::render::sync_component::{SyncComponent, SyncComponentPlugin};
use bevy::render::sync_world::RenderEntity;
use bevy::render::{ExtractSchedule, MainWorld, RenderApp};

/// Mip levels by which textures are sharper where history averages their samples.
const MIP_BIAS: f32 = -0.5;

/// What the post-process needs to know of a camera, in the render world.
#[derive(Component, Clone, Debug)]
pub(crate) struct ExtractedAfterimage {
    pub desc: ContextDesc,
    pub view: ViewFrame,
    pub index: u64,
    /// Factor of the camera on colors.
    pub exposure: f32,
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

impl ExtractedAfterimage {
    /// Adds what is known of a camera after extraction: temporal antialiasing sets its jitter then.
    pub fn complete(&mut self, camera: &ExtractedCamera, jitter: Option<&TemporalJitter>) {
        // Bevy's offset moves the camera; content moves the other way.
        let bevys = jitter.map_or(Vec2::ZERO, |jitter| -jitter.offset);
        let sign = if self.has_planted_jitter { -1.0 } else { 1.0 };
        self.view.jitter_px = (sign * self.jitter_px.map_or(bevys, Vec2::from)).to_array();
        self.exposure = camera.exposure;
    }
}

/// Errors that tests plant ([`crate::testing`]) in a camera, to see that they are noticed.
#[derive(Component, Clone, Copy, Debug, Default)]
pub struct Planted {
    /// Another convention of motion vectors than Bevy's.
    pub motion: Option<MotionConvention>,
    /// The post-process gets the opposite jitter.
    pub jitter: bool,
}

/// Tells this crate's extraction of a component from that of others.
struct Extraction;

// The camera's own component is what makes these disappear with it.
impl SyncComponent<RenderApp, Extraction> for Afterimage {
    type Target = (ExtractedAfterimage, WithoutMsaa);
}

pub(crate) fn plugin(app: &mut App) {
    app.add_plugins(SyncComponentPlugin::<Afterimage, Extraction>::default());
    if let Some(render_app) = app.get_sub_app_mut(RenderApp) {
        // Bevy takes the jitter of cameras that have none.
        render_app.add_systems(ExtractSchedule, extract.after(extract_cameras));
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
    has_bias: Has<MipBias>,
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
        let without_msaa = WithoutMsaa { antialias: camera.afterimage.antialias };
        let below = layers.below(camera.main);
        let Some(size) = drawn_size_px(camera.camera).filter(|_| is_foveated) else {
            entity.remove::<ExtractedAfterimage>();
            // Where foveation comes and goes by itself, MSAA stays off: other pipelines would have to be compiled.
            match is_supported && camera.foveated.target_fps.is_some() && below.is_none() {
                true => entity.insert(without_msaa),
                false => entity.remove::<WithoutMsaa>(),
            };
            continue;
        };
        let described = match below {
            Some(below) => Err(format!(
                "it draws on the picture of camera {below}, and quads cannot. Give Afterimage to camera \
                 {below} alone"
            )),
            None => describe(&camera, size, gaze),
        };
        let mut frame = match described {
            Ok(frame) => frame,
            Err(problem) => {
                if said.insert(camera.main, problem.clone()).as_ref() != Some(&problem) {
                    error!("camera {} renders every pixel, without Afterimage: {problem}", camera.main);
                }
                entity.remove::<(ExtractedAfterimage, WithoutMsaa)>();
                continue;
            }
        };
        said.remove(&camera.main);
        frame.index = index;
        frame.reset = std::mem::take(&mut camera.afterimage.bypass_change_detection().reset);
        if let Method::Smr(smr) = &mut frame.desc.settings.method {
            smr.antialias = camera.afterimage.antialias && !camera.jitters;
            let (px, is_flat) = (Foveation::jitter_px(index), frame.oblique.is_some_and(is_orthographic));
            frame.jitter_px = (smr.antialias && is_flat).then_some(px);
            if smr.antialias && !is_flat {
                // Bevy's offset moves the camera; content moves the other way.
                entity.insert(TemporalJitter { offset: -Vec2::from(px) });
            }
            let is_seen_through = !is_opaque(camera.camera, &clear_color);
            frame.desc.has_albedo = camera.is_deferred && smr.antialias && !is_seen_through;
            // Of either there is one.
            frame.desc.keep_alpha = !frame.desc.has_albedo;
            if smr.antialias && !camera.has_bias {
                entity.insert(MipBias(MIP_BIAS));
            }
            say_what_is_left_out(&camera, frame.desc.has_albedo);
        }
        entity.insert((frame, without_msaa));
    }
}

/// What an application may expect of a camera's frames, and they lack.
fn say_what_is_left_out(camera: &MainCameraItem<'_, '_>, has_albedo: bool) {
    let name = camera.main;
    if camera.jitters && camera.afterimage.antialias {
        warn_once!(
            "Afterimage does not antialias camera {name}: it has TemporalJitter, which temporal antialiasing adds. \
             Remove that, or set Afterimage::antialias to false"
        );
    } else if camera.jitters {
        warn_once!(
            "camera {name}: TemporalJitter, which temporal antialiasing adds, blurs beside Afterimage. Remove temporal \
             antialiasing, and set Afterimage::antialias"
        );
    }
    if camera.is_deferred && !has_albedo {
        info_once!(
            "Afterimage remembers textures of deferred camera {name} with their light: albedo needs \
             Afterimage::antialias, and a clear color that is opaque"
        );
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

/// Description of a camera's frame without antialiasing, or why it renders every pixel.
fn describe(camera: &MainCameraItem<'_, '_>, size: UVec2, gaze: Gaze) -> Result<ExtractedAfterimage, String> {
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
    let planted = camera.planted.copied().unwrap_or_default();
    desc.motion = planted.motion.unwrap_or(MotionConvention::BEVY);
    desc.depth = depth;
    let now = clip_from_view * camera.transform.to_matrix().inverse();
    let past = camera.previous.map(|previous| previous.unjittered_clip_from_world);
    let is_flat = is_orthographic(clip_from_view);
    let view = match is_flat {
        true => orthographic::view(size, gaze, now, past),
        false => perspective(size, gaze, clip_from_view, now, past),
    }?;
    Ok(ExtractedAfterimage {
        desc,
        view: ViewFrame { depth: Some(depth), ..view },
        index: 0,
        exposure: 1.0,
        oblique: (is_flat || is_oblique(clip_from_view)).then_some(clip_from_view),
        jitter_px: None,
        reset: false,
        debug: camera.debug.map(|debug| debug.0),
        counts: camera.counts,
        has_planted_jitter: planted.jitter,
    })
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
