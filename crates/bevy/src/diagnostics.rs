//! Counters of the post-process, read back and shown among Bevy's diagnostics.

use crate::pass::Contexts;
use afterimage::{COUNTERS_BYTES, FrameStats, Verdict, wgpu};
use bevy::diagnostic::{Diagnostic, DiagnosticPath, Diagnostics, RegisterDiagnostic};
use bevy::prelude::*;
use bevy::render::sync_world::MainEntity;
use bevy::render::{Render, RenderApp, RenderSystems};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex, atomic::AtomicU8, atomic::Ordering};

/// Counts the pixels of a camera with [`Afterimage`](crate::Afterimage) by what became of their history, a few frames
/// ago. Add it to the camera; without it nothing is counted, at no cost.
///
/// The shares are also Bevy diagnostics, `afterimage/kept` and `afterimage/disoccluded`, in percent. The time of the
/// post-process is the diagnostic `render/afterimage/elapsed_gpu` (and `elapsed_cpu`), if the application has Bevy's
/// `RenderDiagnosticsPlugin`.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Component, Default)]
pub struct AfterimageStats {
    /// All pixels. 0 before the first counts arrive.
    pub pixels: u64,
    /// Pixels whose history is valid and was kept.
    pub kept: u64,
    /// Pixels whose history is valid and was replaced.
    pub replaced: u64,
    /// Pixels where another surface came into sight.
    pub disoccluded: u64,
    /// Pixels whose history was rejected, disoccluded ones among them.
    pub rejected: u64,
    /// Pixels whose color was NaN or infinite.
    pub nonfinite: u64,
}

impl From<FrameStats> for AfterimageStats {
    fn from(stats: FrameStats) -> Self {
        Self {
            pixels: stats.pixels,
            kept: stats.valid().saturating_sub(stats.replaced),
            replaced: stats.replaced,
            disoccluded: stats.verdicts[Verdict::Disoccluded as usize],
            rejected: stats.rejected(),
            nonfinite: stats.nonfinite,
        }
    }
}

/// Percent of all pixels that show kept history.
const KEPT: DiagnosticPath = DiagnosticPath::const_new("afterimage/kept");
/// Percent of all pixels where another surface came into sight.
const DISOCCLUDED: DiagnosticPath = DiagnosticPath::const_new("afterimage/disoccluded");

/// Counts that arrived, by main-world camera.
type Arrived = (Entity, FrameStats);

#[derive(Resource)]
struct Arrivals(Mutex<Receiver<Arrived>>);

#[derive(Resource)]
struct Departures(Sender<Arrived>);

pub(crate) struct DiagnosticsPlugin;

impl Plugin for DiagnosticsPlugin {
    fn build(&self, app: &mut App) {
        let (sender, receiver) = channel();
        app.insert_resource(Arrivals(Mutex::new(receiver)))
            .register_diagnostic(Diagnostic::new(KEPT).with_suffix("%"))
            .register_diagnostic(Diagnostic::new(DISOCCLUDED).with_suffix("%"))
            .add_systems(PreUpdate, receive);
        if let Some(render_app) = app.get_sub_app_mut(RenderApp) {
            render_app
                .insert_resource(Departures(sender))
                .add_systems(Render, read_back.in_set(RenderSystems::Cleanup));
        }
    }
}

fn receive(arrivals: Res<Arrivals>, mut cameras: Query<&mut AfterimageStats>, mut diagnostics: Diagnostics) {
    let Ok(arrivals) = arrivals.0.lock() else { return };
    for (camera, stats) in arrivals.try_iter() {
        let Ok(mut shown) = cameras.get_mut(camera) else { continue };
        *shown = stats.into();
        let percent = |pixels: u64| 100.0 * pixels as f64 / shown.pixels.max(1) as f64;
        diagnostics.add_measurement(&KEPT, || percent(shown.kept));
        diagnostics.add_measurement(&DISOCCLUDED, || percent(shown.disoccluded));
    }
}

/// Counters of a camera, and a copy of them that is on its way back.
#[derive(Debug)]
pub(crate) struct Counters {
    pub buffer: wgpu::Buffer,
    copy: wgpu::Buffer,
    state: Arc<AtomicU8>,
}

/// States of the copy.
const FREE: u8 = 0;
/// Recorded in this frame.
const RECORDED: u8 = 1;
/// Requested from the device.
const REQUESTED: u8 = 2;
const MAPPED: u8 = 3;

impl Counters {
    pub fn new(device: &wgpu::Device) -> Self {
        let buffer = |usage| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("afterimage counters"),
                size: COUNTERS_BYTES,
                usage: usage | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })
        };
        Self {
            buffer: buffer(wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC),
            copy: buffer(wgpu::BufferUsages::MAP_READ),
            state: Arc::default(),
        }
    }

    /// Copies the counts of this frame, unless those of an earlier one are still on their way.
    pub fn record(&mut self, encoder: &mut wgpu::CommandEncoder) {
        if self.state.load(Ordering::Acquire) == FREE {
            encoder.copy_buffer_to_buffer(&self.buffer, 0, &self.copy, 0, COUNTERS_BYTES);
            self.state.store(RECORDED, Ordering::Release);
        }
    }

    /// After submission: requests the copy, or returns it if it has arrived.
    fn poll(&mut self) -> Option<FrameStats> {
        match self.state.load(Ordering::Acquire) {
            RECORDED => {
                self.state.store(REQUESTED, Ordering::Release);
                let state = self.state.clone();
                self.copy.map_async(wgpu::MapMode::Read, .., move |result| {
                    state.store(if result.is_ok() { MAPPED } else { FREE }, Ordering::Release);
                });
                None
            }
            MAPPED => {
                let stats = FrameStats::from_counters(&self.copy.get_mapped_range(..));
                self.copy.unmap();
                self.state.store(FREE, Ordering::Release);
                stats
            }
            _ => None,
        }
    }
}

fn read_back(mut contexts: ResMut<Contexts>, departures: Res<Departures>, cameras: Query<&MainEntity>) {
    for (&camera, context) in &mut contexts.by_camera {
        let stats = context.counters.as_mut().and_then(Counters::poll);
        if let (Some(stats), Ok(main)) = (stats, cameras.get(camera)) {
            // The receiver lives as long as the application.
            let _ = departures.0.send((main.id(), stats));
        }
    }
}
