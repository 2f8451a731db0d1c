//! Counters of the post-process, read back and shown among Bevy's diagnostics.

use crate::counters::{AfterimageStats, Counters, Counts};
use crate::pass::Contexts;
use bevy::diagnostic::{Diagnostic, DiagnosticPath, Diagnostics, RegisterDiagnostic};
use bevy::prelude::*;
use bevy::render::sync_world::MainEntity;
use bevy::render::{Render, RenderApp, RenderSystems};
use std::sync::Mutex;
use std::sync::mpsc::{Receiver, Sender, channel};

/// Percent of all pixels that show kept history.
const KEPT: DiagnosticPath = DiagnosticPath::const_new("afterimage/kept");
/// Percent of all pixels where another surface came into sight.
const DISOCCLUDED: DiagnosticPath = DiagnosticPath::const_new("afterimage/disoccluded");

/// Counts that arrived, by main-world camera.
type Arrived = (Entity, Counts);

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
        shown.count(stats);
        let percent = |pixels: u64| 100.0 * pixels as f64 / shown.pixels.max(1) as f64;
        diagnostics.add_measurement(&KEPT, || percent(shown.kept));
        diagnostics.add_measurement(&DISOCCLUDED, || percent(shown.disoccluded));
    }
}

fn read_back(mut contexts: ResMut<Contexts>, departures: Res<Departures>, cameras: Query<&MainEntity>) {
    for (&camera, context) in &mut contexts.0 {
        let stats = context.counters.as_mut().and_then(Counters::poll);
        if let (Some(stats), Ok(main)) = (stats, cameras.get(camera)) {
            // The receiver lives as long as the application.
            let _ = departures.0.send((main.id(), stats));
        }
    }
}
