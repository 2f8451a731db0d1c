//! Lines in the log, in a process of their own: those that are written once are written once in a process.

#[path = "../examples/common/mod.rs"]
mod common;

use bevy::log::tracing_subscriber;
use bevy::prelude::*;
use bevy::render::camera::TemporalJitter;
use bevy_afterimage::Afterimage;
use common::headless::Headless;
use common::scene::{ScenePlugin, TONEMAPPING, stroll};
use std::io::Write;
use std::sync::Mutex;

static LOG: Mutex<Vec<u8>> = Mutex::new(vec![]);

struct Log;

impl Write for Log {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        LOG.lock().expect("the log").write(bytes)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

/// How many lines contain `word` after a few frames of a camera with `components`.
fn lines_about(word: &str, components: impl Bundle) -> usize {
    let mut headless = Headless::new(UVec2::new(64, 36), ScenePlugin { lamps: 0, moves: false });
    let target = headless.render_target();
    headless.app.world_mut().spawn((Camera3d::default(), target, TONEMAPPING, stroll(1.0), components));
    headless.frames(4);
    let log = LOG.lock().expect("the log");
    String::from_utf8_lossy(&log).lines().filter(|line| line.contains(word)).count()
}

#[test]
fn antialiasing_that_is_switched_off_is_said_once() {
    tracing_subscriber::fmt().with_writer(|| Log).init();
    let msaa = |msaa: Msaa| lines_about("Msaa", (msaa, Afterimage::default()));
    assert_eq!([Msaa::Off, Msaa::Sample4, Msaa::Sample2].map(msaa), [0, 1, 1]);
    let jitter = |antialias| {
        let afterimage = Afterimage { antialias, ..default() };
        lines_about("TemporalJitter", (Msaa::Off, TemporalJitter::default(), afterimage))
    };
    assert_eq!([false, true, true].map(jitter), [0, 1, 1]);
}
