//! Counters of the post-process, read back and shown among Bevy's diagnostics.

use crate::counters::AfterimageStats;
use crate::pass::Contexts;
use afterimage::wgpu;
use bevy::diagnostic::{Diagnostic, DiagnosticPath, Diagnostics, RegisterDiagnostic};
use bevy::platform::time::Instant;
use bevy::prelude::*;
use bevy::render::renderer::{PendingCommandBuffers, RenderDevice, RenderGraph, RenderGraphSystems, RenderQueue};
use bevy::render::sync_world::MainEntity;
use bevy::render::{Render, RenderApp, RenderSystems};
use std::sync::{Arc, Mutex};

/// Percent of all pixels that show kept history.
const KEPT: DiagnosticPath = DiagnosticPath::const_new("afterimage/kept");
/// Percent of all pixels where another surface came into sight.
const DISOCCLUDED: DiagnosticPath = DiagnosticPath::const_new("afterimage/disoccluded");

/// Counts that arrived, by main-world camera: of both worlds.
#[derive(Resource, Clone, Default)]
struct Arrived(Arc<Mutex<Vec<(Entity, AfterimageStats)>>>);

pub(crate) fn plugin(app: &mut App) {
    let arrived = Arrived::default();
    app.insert_resource(arrived.clone())
        .register_diagnostic(Diagnostic::new(KEPT).with_suffix("%"))
        .register_diagnostic(Diagnostic::new(DISOCCLUDED).with_suffix("%"))
        .add_systems(PreUpdate, receive);
    if let Some(render_app) = app.get_sub_app_mut(RenderApp) {
        render_app.insert_resource(arrived).add_systems(Render, read_back.in_set(RenderSystems::Cleanup)).add_systems(
            RenderGraph,
            (
                stamp::<0>.before(RenderGraphSystems::Render),
                stamp::<1>.after(RenderGraphSystems::Render).before(RenderGraphSystems::Submit),
            ),
        );
    }
}

/// After so many counts in which the device waited, it is said. They arrive in every second frame.
const WAITED: u32 = 64;

/// The last frame of the application, and since how many counts the device waited for most of each frame.
#[derive(Default)]
struct Pace {
    last: Option<Instant>,
    waited: u32,
}

fn receive(
    arrived: Res<Arrived>,
    mut cameras: Query<&mut AfterimageStats>,
    mut diagnostics: Diagnostics,
    mut pace: Local<Pace>,
) {
    let now = Instant::now();
    let frame_us = pace.last.replace(now).map_or(0, |last| now.duration_since(last).as_micros() as u64);
    let Ok(mut arrived) = arrived.0.lock() else { return };
    for (camera, counts) in arrived.drain(..) {
        let Ok(mut shown) = cameras.get_mut(camera) else { continue };
        *shown = AfterimageStats { frame_us, ..counts };
        let percent = |pixels: u64| 100.0 * pixels as f64 / shown.pixels.max(1) as f64;
        diagnostics.add_measurement(&KEPT, || percent(shown.kept));
        diagnostics.add_measurement(&DISOCCLUDED, || percent(shown.disoccluded));
        let device_us = shown.device_us;
        let has_waited = device_us > 0 && 2 * device_us < frame_us;
        pace.waited = if has_waited { pace.waited + 1 } else { 0 };
        if pace.waited == WAITED {
            warn_once!(
                "camera {camera}: shading fewer pixels does not make frames faster. The device works {:.1} ms in {:.1} \
                 ms a frame, and waits for the application, or for the display. Spend it on resolution, lights and \
                 materials, or render every pixel (FoveationKind::Off)",
                1e-3 * device_us as f64,
                1e-3 * frame_us as f64
            );
        }
    }
}

/// Times what the device does in a frame, for cameras that count.
fn stamp<const INDEX: u32>(
    mut contexts: ResMut<Contexts>,
    mut pending: ResMut<PendingCommandBuffers>,
    device: Res<RenderDevice>,
) {
    let mut counters = contexts.0.values_mut().filter_map(|context| context.counters.as_mut()).peekable();
    if counters.peek().is_some() {
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        counters.for_each(|counters| counters.stamp(&mut encoder, INDEX));
        pending.push([encoder.finish()]);
    }
}

fn read_back(
    mut contexts: ResMut<Contexts>,
    arrived: Res<Arrived>,
    queue: Res<RenderQueue>,
    cameras: Query<&MainEntity>,
) {
    let Ok(mut arrived) = arrived.0.lock() else { return };
    for (&camera, context) in &mut contexts.0 {
        let counts = context.counters.as_mut().and_then(|counters| counters.poll(queue.get_timestamp_period()));
        arrived.extend(cameras.get(camera).ok().map(|main| main.id()).zip(counts));
    }
}
