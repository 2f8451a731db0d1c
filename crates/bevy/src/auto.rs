//! [`Foveated::auto`](crate::Foveated::auto): how many pixels are shaded, and whether leaving some out pays at all, by
//! measured times.

use crate::components::{Afterimage, Foveated, FoveationKind};
use crate::layers::find_layers;
use afterimage::{SettingsError, ShareControl};
use bevy::anti_alias::taa::TemporalAntiAliasing;
use bevy::diagnostic::{Diagnostic, DiagnosticMeasurement, DiagnosticsStore};
use bevy::platform::time::Instant;
use bevy::prelude::*;
use bevy::render::camera::{MipBias, TemporalJitter};
use bevy::time::Real;

/// Smallest share.
const LEAST: f32 = 0.1;
/// Frames from a change to the first measurement of a frame after it.
const LATENCY: u32 = 4;
/// Frames in a row that miss the target until the smallest share is taken.
const PATIENCE: u32 = 12;
/// Fewest frames between two tries: at first, and at most, because each doubles it, and one that fails by its cost.
const PAUSE: [u32; 2] = [30, 720];
/// Frames after which a load that did not change is tried again.
const RETRY: u32 = 1200;
/// Relative change of the time that means another load.
const CHANGE: f32 = 0.05;
/// Part of the time that tries which fail may take.
const SPENT: f32 = 0.03;
/// Part of the time that a switch must come below, for frames that miss the target both ways.
const GAIN: f32 = 0.97;

/// Chooses the share of the pixels by [`ShareControl`]. Where even the smallest one misses the target, it tries every
/// pixel, without foveation, for a few frames, keeps what is faster, and tries the other way when the load changes.
#[derive(Component, Clone, Debug)]
pub struct Auto {
    target_ms: f32,
    control: ShareControl,
    is_off: bool,
    /// The last measurements since the share changed, the newest last.
    last_ms: [f32; 5],
    /// Frames since the share changed.
    same: u32,
    /// Frames in a row that missed the target.
    missed: u32,
    /// Frames since foveation came or went.
    since: u32,
    /// While a switch is tried: the time before it.
    before_ms: Option<f32>,
    /// The time when the last try ended.
    settled_ms: f32,
    pause: u32,
}

impl Auto {
    /// For frames of `target_ms`.
    ///
    /// # Errors
    /// [`SettingsError`] if the target is not above 0 and finite.
    pub fn new(target_ms: f32) -> Result<Self, SettingsError> {
        let control = ShareControl::new(target_ms, [LEAST, 1.0])?;
        let (last_ms, settled_ms, pause) = ([f32::NAN; 5], 0.0, PAUSE[0]);
        let (is_off, before_ms, [same, missed, since]) = (false, None, [0; 3]);
        Ok(Self { target_ms, control, is_off, last_ms, same, missed, since, before_ms, settled_ms, pause })
    }

    /// The share for the next frame; `None`: every pixel, without foveation. `measured_ms`: time of the last finished
    /// frame; one that is not above 0 and finite counts as missing.
    pub fn share_for(&mut self, measured_ms: f32) -> Option<f32> {
        (self.since, self.same) = (self.since + 1, self.same + 1);
        if !(measured_ms.is_finite() && measured_ms > 0.0) {
            return (!self.is_off).then(|| self.control.share());
        }
        self.missed = if measured_ms > self.target_ms { self.missed + 1 } else { 0 };
        let share = (!self.is_off).then(|| self.follow(measured_ms));
        if self.same > LATENCY {
            self.last_ms.rotate_left(1);
            self.last_ms[4] = measured_ms;
        }
        let mut sorted = self.last_ms;
        sorted.sort_by(f32::total_cmp);
        let [.., median, _, last] = sorted;
        if last.is_nan() {
            return share;
        }
        if let Some(before) = self.before_ms.take() {
            let is_kept = median <= self.target_ms || median < GAIN * before;
            self.settled_ms = if is_kept { median } else { before };
            // A try that costs more is repeated later.
            let rest = (median / before - 1.0) * self.since as f32 / SPENT;
            self.pause = self.pause.max(rest as u32).min(PAUSE[1]);
            return if is_kept { share } else { self.switch() };
        }
        let change = (median / self.settled_ms - 1.0).abs();
        let fails = self.is_off || median > self.target_ms && share.is_some_and(|share| share <= LEAST);
        if fails && (self.since >= RETRY || change > CHANGE && self.since >= self.pause) {
            self.pause = if self.since >= RETRY { PAUSE[0] } else { PAUSE[1].min(2 * self.pause) };
            self.before_ms = Some(median);
            return self.switch();
        }
        share
    }

    /// The controller's share. Where a frame takes long whatever is shaded, it needs many steps.
    fn follow(&mut self, measured_ms: f32) -> f32 {
        let last = self.control.share();
        if self.missed == PATIENCE {
            self.control.set_share(LEAST);
        }
        let share = self.control.share_for(measured_ms);
        if share != last {
            (self.same, self.last_ms) = (0, [f32::NAN; 5]);
        }
        share
    }

    /// To every pixel, or to the smallest share.
    fn switch(&mut self) -> Option<f32> {
        (self.is_off, self.same, self.missed, self.since) = (!self.is_off, 0, 0, 0);
        self.last_ms = [f32::NAN; 5];
        self.control.set_share(LEAST);
        (!self.is_off).then_some(LEAST)
    }
}

pub(crate) fn plugin(app: &mut App) {
    app.add_systems(PostUpdate, (control, stand_in).chain().before(find_layers));
}

/// Time that the device worked on the passes of a frame, from Bevy's `RenderDiagnosticsPlugin`: 0 if none has arrived
/// since `seen`. `None` without the plugin, or without timestamps.
fn device_ms(store: &DiagnosticsStore, seen: &mut Option<Instant>) -> Option<f32> {
    let is_pass = |diagnostic: &&Diagnostic| {
        let path: Vec<_> = diagnostic.path().components().collect();
        matches!(path[..], ["render", _, "elapsed_gpu"])
    };
    let passes: Vec<_> = store.iter().filter(is_pass).collect();
    let newest = passes.iter().filter_map(|pass| pass.measurement()).map(|last| last.time).max()?;
    let is_new = seen.replace(newest).is_none_or(|seen| seen < newest);
    // Of each camera.
    let of_frame = |pass: &&Diagnostic| -> f64 {
        let is_its = |measured: &&DiagnosticMeasurement| measured.time == newest;
        pass.measurements().filter(is_its).map(|measured| measured.value).sum()
    };
    Some(if is_new { passes.iter().map(of_frame).sum::<f64>() as f32 } else { 0.0 })
}

fn control(
    mut commands: Commands,
    mut cameras: Query<(Entity, &mut Foveated, Option<&mut Auto>), With<Afterimage>>,
    (store, time): (Option<Res<DiagnosticsStore>>, Res<Time<Real>>),
    mut seen: Local<Option<Instant>>,
) {
    let measured_ms = store.and_then(|store| device_ms(&store, &mut seen)).unwrap_or(1e3 * time.delta_secs());
    for (camera, mut foveated, auto) in &mut cameras {
        let Some(target_ms) = foveated.target_fps.map(|fps| 1e3 / fps) else { continue };
        let Some(mut auto) = auto.filter(|auto| auto.target_ms == target_ms) else {
            match Auto::new(target_ms) {
                Ok(auto) => drop(commands.entity(camera).insert(auto)),
                Err(problem) => error_once!("Foveated::auto of camera {camera}: {problem}"),
            }
            continue;
        };
        foveated.set_if_neq(match auto.share_for(measured_ms) {
            Some(share) => Foveated { target_fps: foveated.target_fps, ..Foveated::uniform(share) },
            None => Foveated { kind: FoveationKind::Off, ..*foveated },
        });
    }
}

/// Marks cameras that have Bevy's temporal antialiasing from this plugin.
#[derive(Component)]
struct StandsIn;

type Antialiased<'a> = (Entity, Option<&'a Foveated>, Option<&'a Afterimage>, Has<StandsIn>, Has<TemporalAntiAliasing>);

/// Has Bevy antialias as long as [`Foveated::auto`] leaves foveation out.
fn stand_in(mut commands: Commands, cameras: Query<Antialiased, With<Camera>>) {
    for (camera, foveated, afterimage, stands_in, has_taa) in &cameras {
        let is_out = foveated.is_some_and(|f| f.target_fps.is_some() && f.kind == FoveationKind::Off);
        let is_needed = is_out && afterimage.is_some_and(|afterimage| afterimage.antialias);
        if is_needed && !has_taa {
            commands.entity(camera).insert((StandsIn, TemporalAntiAliasing::default()));
        } else if !is_needed && stands_in {
            // With what it requires, but for the prepasses, which are ours, too.
            commands.entity(camera).remove::<(StandsIn, TemporalAntiAliasing, TemporalJitter, MipBias)>();
        }
    }
}

#[cfg(test)]
#[path = "../tests/unit/auto.rs"]
mod tests;
