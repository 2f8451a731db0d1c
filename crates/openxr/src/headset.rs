//! The headset: from one frame to the next.

use crate::error::Error;
use crate::eye::{Eye, Posed, angles, matrix};
use crate::gaze::{Ray, Tracker, from_head};
use crate::present::Present;
use crate::session::{HiddenMesh, Session, VIEWS};
use crate::targets::{Targets, layers};
use crate::vulkan::Gpu;
use afterimage::gpu::{Afterimage, Frame, Prime};
use afterimage::internal::{ContextDesc, Foveation, FoveationKind, Method, Reset, Settings, Smr, ViewFrame};
use afterimage::{DepthConvention, Desc, Gaze, SettingsError, Shading, ViewGeometry};
use openxr as xr;
use std::time::{Duration, Instant};
use wgpu_30::{Buffer, CommandEncoder, Device, Limits, PollType, Queue, Texture, TextureFormat, TextureUsages};
use xr::sys;

/// Time in which nothing was to be shown after which history is discarded.
const PAUSE: Duration = Duration::from_secs(1);
/// How often a session that is not running is asked for news.
const IDLE: Duration = Duration::from_millis(5);

/// Gaze without an eye tracker: direction in the head's space (x right, y up, -z forward, of any length) at a time in
/// seconds since the first frame; `None`: lost.
pub type GazeFn = Box<dyn FnMut(f64) -> Option<[f32; 3]> + Send>;
/// Action sets of the application, created from the instance.
pub type ActionsFn = Box<dyn FnOnce(&xr::Instance) -> Result<Vec<xr::ActionSet>, sys::Result>>;

/// Description of a headset. Create it with `..HeadsetDesc::default()`.
pub struct HeadsetDesc {
    /// Pixels that are shaded. Default: all within 10 degrees around the gaze, and 8 % of the others.
    pub shading: Shading,
    /// Whether the projection is jittered and the picture is antialiased, in place of other antialiasing. Default true.
    pub antialias: bool,
    /// Distance of the near plane in metres, above 0. Default 0.05.
    pub near_m: f32,
    /// Size of a view in pixels. Default: what the runtime recommends.
    pub size_px: Option<[u32; 2]>,
    /// How far away the eyes look, in metres, until [`Headset::set_gaze_distance_m`] says it better. Default 2.
    pub gaze_distance_m: f32,
    /// Gaze where the runtime has no eye tracker. Default: straight ahead.
    pub gaze: Option<GazeFn>,
    /// The application's own actions (controllers, hands). OpenXR takes all action sets of a session at once, so that
    /// the headset attaches and synchronises them, together with that of the eye tracker. Default: none.
    pub actions: Option<ActionsFn>,
}

impl Default for HeadsetDesc {
    fn default() -> Self {
        Self {
            shading: Shading::Gaze { fovea_deg: 10.0, share: 0.08125 },
            antialias: true,
            near_m: 0.05,
            size_px: None,
            gaze_distance_m: 2.0,
            gaze: None,
            actions: None,
        }
    }
}

/// What the last submitted frame showed.
#[derive(Clone, Copy)]
struct Past {
    poses: [Posed; 2],
    time: xr::Time,
}

/// What the lens of an eye hides and shows.
#[derive(Clone, Default)]
struct Lens {
    hidden: Option<HiddenMesh>,
    outline: Vec<[f32; 2]>,
}

/// A headset: device, session, eye tracker and post-process.
// Fields are dropped in this order: the runtime's objects before the device that they were created on.
pub struct Headset {
    /// `None` only after a lost session could not be replaced.
    session: Option<Session>,
    tracker: Option<Tracker>,
    sets: Vec<xr::ActionSet>,
    blend: xr::EnvironmentBlendMode,
    system: xr::SystemId,
    post: Afterimage,
    present: Present,
    output: Texture,
    targets: Targets,
    lenses: [Lens; 2],
    gaze_fn: Option<GazeFn>,
    gaze_distance_m: f32,
    near_m: f32,
    /// Whether the application chose the size of the views.
    has_own_size: bool,
    past: Option<Past>,
    /// From each of these times on the world's origin is another one.
    recentred_at: Vec<xr::Time>,
    begun_at: Option<xr::Time>,
    /// Since when nothing is to be shown.
    idle_since: Option<Instant>,
    index: u64,
    instance: xr::Instance,
    gpu: Gpu,
}

/// A frame to draw and to submit: prepass, [`choose`](Self::choose), color pass (after cuts at
/// [half the size](Self::halve)), [`submit`](Self::submit). A frame that is dropped is not shown, and leaves history as
/// it was.
pub struct HeadsetFrame<'a> {
    /// Records the frame: the application's passes, then the post-process.
    pub encoder: CommandEncoder,
    /// Left and right eye.
    pub eyes: [Eye; 2],
    /// The gaze, unless it is lost.
    pub gaze: Option<Ray>,
    /// When the frame will be displayed, in seconds since the first frame.
    pub time_s: f64,
    /// The same of the last submitted frame, for motion vectors of what moves; after resets, this frame's.
    pub previous_time_s: f64,
    /// [`Reset::All`] in the first frame, after recentring, in a new session and after pauses.
    pub reset: Reset,
    headset: &'a mut Headset,
    poses: [Posed; 2],
    views: Vec<xr::View>,
    time: xr::Time,
    is_chosen: bool,
    is_half: bool,
}

/// What a submitted frame was made of: for pictures and measurements.
pub struct Shown<'a> {
    /// Linear color of both eyes, `Rgba16Float` with usages `TEXTURE_BINDING` and `COPY_SRC`.
    pub output: &'a Texture,
    /// What was drawn.
    pub targets: &'a Targets,
    /// What was shaded of each eye, in the form of [`Plan::lists`](afterimage::Plan::lists).
    pub lists: Vec<&'a Buffer>,
    /// Descriptions of both views.
    pub views: [ViewFrame; 2],
    /// Counter of submitted frames.
    pub index: u64,
    /// Whether colors were drawn at [half the width and height](HeadsetFrame::halve).
    pub is_half: bool,
}

impl Headset {
    /// Connects to the runtime of the system, creates a device and a session. `name`: the application's.
    ///
    /// # Errors
    /// [`Error`] without a loader, a runtime or a headset, or if the settings are out of range.
    pub fn new(name: &str, desc: HeadsetDesc) -> Result<Self, Error> {
        // Said before a runtime is asked.
        let settings = settings(desc.shading, desc.antialias)?;
        let entry = load()?;
        let available = entry.enumerate_extensions()?;
        if !available.khr_vulkan_enable2 {
            return Err(Error::Runtime("lacks XR_KHR_vulkan_enable2"));
        }
        let mut extensions = xr::ExtensionSet::default();
        extensions.khr_vulkan_enable2 = true;
        extensions.khr_visibility_mask = available.khr_visibility_mask;
        extensions.khr_composition_layer_depth = available.khr_composition_layer_depth;
        extensions.ext_eye_gaze_interaction = available.ext_eye_gaze_interaction;
        let app = xr::ApplicationInfo {
            application_name: name,
            application_version: 0,
            engine_name: "afterimage",
            engine_version: 0,
            api_version: xr::Version::new(1, 0, 0),
        };
        let instance = entry.create_instance(&app, &extensions, &[], &())?;
        let system = instance.system(xr::FormFactor::HEAD_MOUNTED_DISPLAY)?;
        let blend = *instance
            .enumerate_environment_blend_modes(system, VIEWS)?
            .first()
            .ok_or(Error::Runtime("has no stereo views"))?;
        let size = match desc.size_px {
            Some(size) => size,
            None => recommended_size(&instance, system)?,
        };
        let context = ContextDesc {
            view_count: 2,
            depth: DepthConvention::Reversed { near: desc.near_m, far: f32::INFINITY },
            settings,
            ..ContextDesc::new(size)
        };
        let limits = Afterimage::required_limits(&context).or_better_values_from(&Limits::default());
        let gpu = Gpu::new(&instance, system, limits)?;
        let post = Afterimage::new(&gpu.device, &context, TextureFormat::Rgba16Float)?;
        let tracker = Tracker::new(&instance, system)?;
        let sets = match desc.actions {
            Some(create) => create(&instance)?,
            None => vec![],
        };
        let session = Session::new(&instance, system, &gpu, size)?;
        let formats = session.formats();
        let present = Present::new(&gpu.device, formats.color.texture, formats.depth.map(|depth| depth.texture));
        let mut headset = Self {
            output: output(&gpu.device, size),
            targets: Targets::new(&gpu.device, size),
            session: Some(session),
            tracker,
            sets,
            blend,
            system,
            post,
            present,
            lenses: Default::default(),
            gaze_fn: desc.gaze,
            gaze_distance_m: desc.gaze_distance_m,
            near_m: desc.near_m,
            has_own_size: desc.size_px.is_some(),
            past: None,
            recentred_at: vec![],
            begun_at: None,
            idle_since: None,
            index: 0,
            instance,
            gpu,
        };
        headset.attach()?;
        Ok(headset)
    }

    /// The device that the runtime created.
    pub fn device(&self) -> &Device {
        &self.gpu.device
    }

    /// Its queue.
    pub fn queue(&self) -> &Queue {
        &self.gpu.queue
    }

    /// The runtime's instance.
    pub fn instance(&self) -> &xr::Instance {
        &self.instance
    }

    /// Size of a view in pixels.
    pub fn size_px(&self) -> [u32; 2] {
        self.post.desc().size_px
    }

    /// Whether the runtime has an eye tracker.
    pub fn has_eye_tracker(&self) -> bool {
        self.tracker.is_some()
    }

    /// What the lens of an eye (0 left, 1 right) hides; `None` if the runtime does not say. Draw it first.
    pub fn hidden_mesh(&self, eye: usize) -> Option<&HiddenMesh> {
        self.lenses.get(eye)?.hidden.as_ref()
    }

    /// How far away the eyes look, in metres: the distance of what lies under the gaze. Infinite is far away.
    pub fn set_gaze_distance_m(&mut self, distance_m: f32) {
        self.gaze_distance_m = distance_m;
    }

    /// Changes how many pixels are shaded, from the next frame on.
    ///
    /// # Errors
    /// [`Error::Settings`] if a share or an angle is out of range; then nothing changes.
    pub fn set_shading(&mut self, shading: Shading) -> Result<(), Error> {
        let foveation = settings(shading, true)?.foveation;
        self.set_settings(Settings { foveation, ..self.post.desc().settings })
    }

    /// Changes method and foveation, whose kind must be [`FoveationKind::Quads`], from the next frame on: for
    /// comparisons.
    ///
    /// # Errors
    /// [`Error::Settings`] if a setting is out of range, or the kind is another one; then nothing changes.
    #[doc(hidden)]
    pub fn set_settings(&mut self, settings: Settings) -> Result<(), Error> {
        check_kind(&settings)?;
        Ok(self.post.set_settings(&self.gpu.device, settings)?)
    }

    /// Whether the runtime takes the depth of what is shown, by which it corrects for the head's movement since the
    /// frame was drawn (`XR_KHR_composition_layer_depth`).
    pub fn has_depth_layer(&self) -> bool {
        self.session.as_ref().is_some_and(|session| session.formats().depth.is_some())
    }

    /// Changes the size of the views from the next frame on. History is resampled. From then on the size no longer
    /// follows the runtime's recommendation.
    ///
    /// # Errors
    /// [`Error`] if the runtime or the post-process refuses the size.
    pub fn resize(&mut self, size_px: [u32; 2]) -> Result<(), Error> {
        self.set_size(size_px)?;
        self.has_own_size = true;
        Ok(())
    }

    fn set_size(&mut self, size_px: [u32; 2]) -> Result<(), Error> {
        self.wait()?;
        if let Some(session) = &mut self.session {
            session.resize(&self.gpu, size_px)?;
        }
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        self.post.resize_keeping_history(&self.gpu.device, &mut encoder, size_px)?;
        self.gpu.queue.submit([encoder.finish()]);
        self.output = output(&self.gpu.device, size_px);
        self.targets = Targets::new(&self.gpu.device, size_px);
        Ok(())
    }

    /// Asks the runtime to end the session: [`next_frame`](Self::next_frame) returns `None` soon.
    ///
    /// # Errors
    /// [`Error::OpenXr`] if the runtime refuses.
    pub fn exit(&mut self) -> Result<(), Error> {
        match self.session.as_ref().map(|session| session.session.request_exit()) {
            None | Some(Err(sys::Result::ERROR_SESSION_NOT_RUNNING) | Ok(())) => Ok(()),
            Some(Err(error)) => Err(error.into()),
        }
    }

    /// Waits for the next frame to draw; `None` when the session is over. While the headset shows nothing (it is taken
    /// off, a menu covers it) there is no frame to draw, and the call goes on waiting. A session that the runtime loses
    /// is replaced by another one, without history. When a session begins and the runtime recommends another size than
    /// before, the views have it, unless the application chose their size.
    ///
    /// # Errors
    /// [`Error::InstanceLost`] if the runtime ends: create another headset. [`Error`] if it fails.
    pub fn next_frame(&mut self) -> Result<Option<HeadsetFrame<'_>>, Error> {
        let (time, views) = loop {
            match self.follow() {
                Ok(true) => {}
                Ok(false) => return Ok(None),
                Err(Error::OpenXr(error)) if is_lost(error) => self.restart()?,
                Err(error) => return Err(error),
            }
            let Some(session) = self.session.as_mut().filter(|session| session.is_running) else {
                std::thread::sleep(IDLE);
                continue;
            };
            let sets: Vec<_> = self.sets.iter().chain(self.tracker.as_ref().map(|tracker| &tracker.set)).collect();
            match session.next_views(self.blend, &sets) {
                Ok(Some(found)) => break found,
                Ok(None) => {
                    self.idle_since.get_or_insert_with(Instant::now);
                }
                Err(error) if is_lost(error) => self.restart()?,
                Err(error) => return Err(error.into()),
            }
        };
        self.frame(time, views).map(Some)
    }

    /// The frame to draw.
    fn frame(&mut self, time: xr::Time, views: Vec<xr::View>) -> Result<HeadsetFrame<'_>, Error> {
        let begun_at = *self.begun_at.get_or_insert(time);
        let seconds = |time: xr::Time| (time.as_nanos() - begun_at.as_nanos()) as f64 / 1e9;
        if self.recentred_at.extract_if(.., |at| time.as_nanos() >= at.as_nanos()).count() > 0 {
            self.past = None;
        }
        if self.idle_since.take().is_some_and(|since| since.elapsed() > PAUSE) {
            self.past = None;
        }
        let reset = if self.past.is_some() { Reset::None } else { Reset::All };
        let poses = [Posed::new(&views[0], self.near_m), Posed::new(&views[1], self.near_m)];
        let before = self.past.map_or(poses, |past| past.poses);
        let ray = match (&self.tracker, &mut self.gaze_fn) {
            (Some(tracker), _) => match &self.session {
                Some(session) => tracker.at(&session.space, time).or_else(none_if_lost)?,
                None => None,
            },
            (None, Some(gaze)) => gaze(seconds(time)).and_then(|direction| from_head(&views, direction)),
            (None, None) => from_head(&views, [0.0, 0.0, -1.0]),
        };
        let jitter_px = match self.post.desc().settings.method {
            Method::Smr(Smr { antialias: true, .. }) => Foveation::jitter_px(self.index),
            _ => [0.0; 2],
        };
        let geometry = |i: usize| ViewGeometry::from_angles(self.size_px(), angles(views[i].fov));
        let geometries = [geometry(0)?, geometry(1)?];
        let eyes = [0, 1].map(|i| {
            let gaze_px = self.post.gaze_px(i, &geometries[i], self.gaze_of(ray, &poses[i]));
            Eye::new(i as u32, geometries[i], [&poses[i], &before[i]], gaze_px, jitter_px)
        });
        Ok(HeadsetFrame {
            encoder: self.gpu.device.create_command_encoder(&Default::default()),
            eyes,
            gaze: ray,
            time_s: seconds(time),
            previous_time_s: seconds(self.past.map_or(time, |past| past.time)),
            reset,
            poses,
            views,
            time,
            is_chosen: false,
            is_half: false,
            headset: self,
        })
    }

    fn gaze_of(&self, ray: Option<Ray>, pose: &Posed) -> Gaze {
        ray.map_or(Gaze::Lost, |ray| {
            let pose = pose.world_from_view.to_cols_array_2d();
            Gaze::on_ray(ray.origin, ray.direction, self.gaze_distance_m, pose)
        })
    }

    /// Handles the runtime's events. `false`: the session is over.
    fn follow(&mut self) -> Result<bool, Error> {
        let mut buffer = xr::EventDataBuffer::new();
        while let Some(event) = self.instance.poll_event(&mut buffer)? {
            match event {
                xr::Event::SessionStateChanged(event) => {
                    // Events of a session that was replaced may still come.
                    let session = self.session.as_mut().filter(|live| live.session.as_raw() == event.session());
                    match (event.state(), session) {
                        (xr::SessionState::READY, Some(session)) => {
                            session.session.begin(VIEWS)?;
                            session.is_running = true;
                            self.past = None;
                            self.follow_recommended_size()?;
                        }
                        (xr::SessionState::STOPPING, Some(session)) => {
                            session.session.end()?;
                            session.is_running = false;
                        }
                        (xr::SessionState::LOSS_PENDING, Some(_)) => self.restart()?,
                        (xr::SessionState::EXITING, Some(_)) => return Ok(false),
                        _ => {}
                    }
                }
                // The world moves under every pose from then on.
                xr::Event::ReferenceSpaceChangePending(event) => self.recentred_at.push(event.change_time()),
                xr::Event::VisibilityMaskChangedKHR(_) => self.ask_lenses(),
                xr::Event::InstanceLossPending(_) => return Err(Error::InstanceLost),
                _ => {}
            }
        }
        Ok(true)
    }

    /// The size that the runtime recommends now, unless the application chose one.
    fn follow_recommended_size(&mut self) -> Result<(), Error> {
        if self.has_own_size {
            return Ok(());
        }
        let size = recommended_size(&self.instance, self.system)?;
        if size == self.size_px() { Ok(()) } else { self.set_size(size) }
    }

    /// Another session in place of one that was lost.
    fn restart(&mut self) -> Result<(), Error> {
        self.wait()?;
        if let Some(tracker) = &mut self.tracker {
            tracker.follow(None)?;
        }
        // A runtime may allow one session at a time: the old one goes first, with all that was made in it.
        self.session = None;
        self.past = None;
        self.session = Some(Session::new(&self.instance, self.system, &self.gpu, self.size_px())?);
        self.attach()
    }

    /// Attaches the action sets to a new session, and asks what its lenses hide.
    fn attach(&mut self) -> Result<(), Error> {
        let Some(session) = &self.session else { return Ok(()) };
        let sets: Vec<_> = self.sets.iter().chain(self.tracker.as_ref().map(|tracker| &tracker.set)).collect();
        if !sets.is_empty() {
            session.session.attach_action_sets(&sets)?;
        }
        if let Some(tracker) = &mut self.tracker {
            tracker.follow(Some(&session.session))?;
        }
        self.ask_lenses();
        Ok(())
    }

    fn ask_lenses(&mut self) {
        let lens = |eye| self.session.as_ref().and_then(|session| session.lens(&self.instance, eye));
        self.lenses = [0, 1].map(|eye| match lens(eye) {
            Some((hidden, outline)) => Lens { hidden: Some(hidden), outline },
            None => Lens::default(),
        });
    }

    /// Waits until the device has done everything: the runtime's images may then go.
    fn wait(&self) -> Result<(), Error> {
        self.gpu.device.poll(PollType::wait_indefinitely()).map_err(|e| Error::Device(e.to_string()))?;
        Ok(())
    }
}

impl<'a> HeadsetFrame<'a> {
    /// The device's queue.
    pub fn queue(&self) -> &Queue {
        &self.headset.gpu.queue
    }

    /// The encoder, and what to draw into.
    pub fn encoder_and_targets(&mut self) -> (&mut CommandEncoder, &Targets) {
        (&mut self.encoder, &self.headset.targets)
    }

    /// What to shade, after [`choose`](Self::choose): a texture with a layer for each eye, in the form of
    /// [`Plan::mask`](afterimage::Plan::mask).
    pub fn mask(&self) -> Option<&Texture> {
        self.headset.post.quad_mask()
    }

    /// The same of an eye (0 left, 1 right) as a list in the form of [`Plan::lists`](afterimage::Plan::lists): for
    /// renderers that dispatch or draw over it.
    pub fn list(&self, eye: usize) -> Option<&Buffer> {
        self.headset.post.quad_list(eye)
    }

    /// The session of the frame, for the state of the application's actions. Objects that are made in it must not be
    /// kept: a lost session cannot be replaced while they live.
    pub fn session(&self) -> &xr::Session<xr::Vulkan> {
        &self.headset.session.as_ref().expect("a frame has a session").session
    }

    /// Pose of a hand, or of what else an action of the application says, in the world, by columns; `None` where it is
    /// not tracked.
    ///
    /// # Errors
    /// [`Error::OpenXr`] if the action does not belong to the session.
    pub fn pose(&mut self, action: &xr::Action<xr::Posef>, path: xr::Path) -> Result<Option<[[f32; 4]; 4]>, Error> {
        let session = self.headset.session.as_mut().expect("a frame has a session");
        let pose = session.pose(action, path, self.time).or_else(none_if_lost)?;
        Ok(pose.map(|pose| matrix(pose).to_cols_array_2d()))
    }

    /// When the frame will be displayed, on the runtime's clock.
    pub fn time(&self) -> xr::Time {
        self.time
    }

    /// Chooses the quads of both eyes that are to be shaded, from the depth and the motion vectors that the prepass of
    /// this frame drew, and closes [`Targets::primed`] everywhere else: the color pass, on this depth and with the test
    /// `GreaterEqual`, shades nothing there.
    ///
    /// # Errors
    /// [`Error::Frame`] if the post-process refuses the frame. Then nothing was recorded.
    pub fn choose(&mut self) -> Result<(), Error> {
        let views = self.described()?;
        let Headset { gpu, post, targets, index, .. } = &mut *self.headset;
        post.plan(&gpu.device, &mut self.encoder, &described_frame(targets, &views, *index, self.reset))?;
        self.is_chosen = true;
        self.prime()
    }

    /// After [`choose`](Self::choose): if one pixel of each quad was chosen around the fovea, because nothing is known
    /// (in the first frame and after resets), leaves the fovea alone open, and returns the eyes to draw the other
    /// colors with at half the width and height, into [`Targets::half_views`]. Textures need a bias of their level of
    /// detail of -1. `None` in all other frames.
    ///
    /// Without this call the frame is drawn like all others, and shades every pixel: four times as many.
    ///
    /// # Errors
    /// As for `choose`.
    pub fn halve(&mut self) -> Result<Option<[Eye; 2]>, Error> {
        self.is_half = self.headset.post.is_quarter();
        if !self.is_half {
            return Ok(None);
        }
        self.prime()?;
        let place_px = Foveation::quarter_place_px(self.headset.index);
        Ok(Some(self.eyes.map(|eye| eye.half(place_px))))
    }

    /// Closes [`Targets::primed`] where nothing is to be shaded.
    fn prime(&mut self) -> Result<(), Error> {
        let Headset { gpu, post, targets, .. } = &mut *self.headset;
        let (from, to) = (targets.depth.as_image_copy(), targets.primed.as_image_copy());
        self.encoder.copy_texture_to_texture(from, to, targets.depth.size());
        for (view, layers) in targets.views.iter().enumerate() {
            let (target, is_half) = (&layers.primed, self.is_half);
            let prime = Prime { target, origin_px: [0, 0], near_depth: 1.0, stencil: None, is_half };
            post.prime(&gpu.device, &mut self.encoder, view, &prime)?;
        }
        Ok(())
    }

    /// Both views, for the post-process.
    fn described(&self) -> Result<[ViewFrame; 2], SettingsError> {
        let headset = &*self.headset;
        let described = |i: usize| {
            let eye = &self.eyes[i];
            let gaze = headset.gaze_of(self.gaze, &self.poses[i]);
            let visible_px = eye.geometry.visible_px(headset.lenses[i].outline.iter().copied());
            eye.view_frame(gaze, headset.past.as_ref().map(|past| &past.poses[i]), visible_px)
        };
        Ok([described(0)?, described(1)?])
    }

    /// Makes whole frames of what was drawn, and shows them.
    ///
    /// # Errors
    /// [`Error::NotChosen`] without [`choose`](Self::choose), [`Error::Frame`] if the post-process refuses the frame,
    /// [`Error::OpenXr`] if the runtime fails. A session that is lost meanwhile is not an error:
    /// [`Headset::next_frame`] replaces it.
    pub fn submit(self) -> Result<Shown<'a>, Error> {
        if !self.is_chosen {
            return Err(Error::NotChosen);
        }
        let described = self.described()?;
        let Self { mut encoder, reset, headset, poses, views, time, is_half, .. } = self;
        let mut frame = described_frame(&headset.targets, &described, headset.index, reset);
        if is_half {
            frame.half = Some((&headset.targets.half_color).into());
        }
        headset.post.record(&headset.gpu.device, &mut encoder, &frame, &headset.output)?;
        let index = headset.index;
        headset.index += 1;
        headset.past = Some(Past { poses, time });
        let session = headset.session.as_mut().expect("a frame has a session");
        let shown = session.show(|color, depth| {
            let from = [&headset.output, &headset.targets.depth];
            headset.present.record(&headset.gpu.device, &mut encoder, from, color, depth);
            headset.gpu.queue.submit([encoder.finish()]);
        });
        match shown.and_then(|()| session.end(time, headset.blend, &views, headset.near_m)) {
            Ok(()) => {}
            Err(error) if is_lost(error) => {}
            Err(error) => return Err(error.into()),
        }
        let (output, targets) = (&headset.output, &headset.targets);
        let lists = (0..2).filter_map(|eye| headset.post.quad_list(eye)).collect();
        Ok(Shown { output, targets, lists, views: described, index, is_half })
    }
}

/// What `choose` and `submit` give the post-process.
fn described_frame<'a>(targets: &'a Targets, views: &'a [ViewFrame; 2], index: u64, reset: Reset) -> Frame<'a> {
    Frame {
        depth: Some((&targets.depth).into()),
        motion: Some((&targets.motion).into()),
        reset,
        ..Frame::new(&targets.color, views, index)
    }
}

/// Settings of planned frames.
fn settings(shading: Shading, antialias: bool) -> Result<Settings, SettingsError> {
    let desc = Desc { shading, antialias, ..Desc::new([1, 1], TextureFormat::Rgba16Float) };
    Ok(desc.context()?.settings)
}

/// Refuses what a headset's frames are not.
fn check_kind(settings: &Settings) -> Result<(), SettingsError> {
    match settings.foveation.kind {
        FoveationKind::Quads => Ok(()),
        kind => Err(SettingsError {
            setting: "kind",
            found: kind.name().into(),
            expected: "quads: Foveation::quads() or Foveation::uniform(share)".into(),
        }),
    }
}

/// Size of a view in pixels that the runtime recommends.
fn recommended_size(instance: &xr::Instance, system: xr::SystemId) -> Result<[u32; 2], Error> {
    let recommended = instance.enumerate_view_configuration_views(system, VIEWS)?;
    let [left, _] = recommended[..] else { return Err(Error::Runtime("has no stereo views")) };
    Ok([left.recommended_image_rect_width, left.recommended_image_rect_height])
}

/// Linear color of whole frames.
fn output(device: &Device, size: [u32; 2]) -> Texture {
    let usage = Afterimage::OUTPUT_USAGE | Afterimage::INPUT_USAGE | TextureUsages::COPY_SRC;
    layers(device, "headset", size, TextureFormat::Rgba16Float, usage)
}

/// Whether another session may go on.
fn is_lost(error: sys::Result) -> bool {
    error == sys::Result::ERROR_SESSION_LOST
}

/// What a session that was lost meanwhile knows: nothing. The next frame replaces it.
fn none_if_lost<T>(error: sys::Result) -> Result<Option<T>, sys::Result> {
    if is_lost(error) { Ok(None) } else { Err(error) }
}

/// The loader of the system, found when the program runs.
#[expect(unsafe_code, reason = "loads a library")]
fn load() -> Result<xr::Entry, Error> {
    // SAFETY: the library that the system calls its OpenXR loader.
    unsafe { xr::Entry::load(&()) }.map_err(|e| Error::Loader(e.to_string()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kinds_without_quads_are_refused() {
        for kind in FoveationKind::ALL {
            let foveation = Foveation { kind, ..Foveation::quads() };
            let found = check_kind(&Settings { foveation, ..Settings::default() }).err();
            let is_refused = matches!(&found, Some(error) if error.setting == "kind");
            assert_eq!(is_refused, kind != FoveationKind::Quads, "{kind:?}: {found:?}");
        }
    }

    /// Said before a runtime is asked, so without one.
    #[test]
    fn shares_out_of_range_are_refused() {
        let shading = Shading::Everywhere { share: 1.5 };
        let found = Headset::new("test", HeadsetDesc { shading, ..HeadsetDesc::default() }).err();
        assert!(matches!(&found, Some(Error::Settings(error)) if error.setting == "share"), "{found:?}");
    }

    #[test]
    fn the_default_is_the_one_that_was_measured() {
        let HeadsetDesc { shading, antialias, .. } = HeadsetDesc::default();
        let (found, measured) = (settings(shading, antialias).unwrap(), Settings::headset());
        assert!((found.foveation.budget - measured.foveation.budget).abs() < 1e-6, "{found:?}");
        let foveation = Foveation { budget: measured.foveation.budget, ..found.foveation };
        assert_eq!(Settings { foveation, ..found }, measured);
    }
}
