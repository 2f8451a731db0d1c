//! Times of the frames of a clip: of a pass, of the renderer, and of both together.

use crate::clock::{Elapsed, Quartiles};
use serde::{Deserialize, Serialize};

/// Times of a renderer or of a pass, one a frame.
#[derive(Clone, Debug, Default)]
pub struct Times(Vec<Elapsed>);

impl Times {
    /// Adds a frame.
    pub fn push(&mut self, elapsed: Elapsed) {
        self.0.push(elapsed);
    }

    /// Time of the last frame.
    pub fn last(&self) -> Option<Elapsed> {
        self.0.last().copied()
    }

    /// Times without those of the first `count` frames.
    pub fn after(&self, count: usize) -> Self {
        Self(self.0.get(count..).unwrap_or_default().to_vec())
    }

    /// Cost of each frame, [`Elapsed::cost_ms`].
    pub fn cost_ms(&self) -> Vec<f64> {
        self.0.iter().map(Elapsed::cost_ms).collect()
    }

    /// Median of the costs; `None` without frames.
    pub fn median_cost_ms(&self) -> Option<f64> {
        Quartiles::of(&self.cost_ms()).map(|q| q.median)
    }

    /// Wall time of a frame; `None` without frames.
    pub fn wall_ms(&self) -> Option<Quartiles> {
        Quartiles::of(&self.0.iter().map(|e| e.wall_ms).collect::<Vec<_>>())
    }

    /// Median CPU time of a frame, if the system measures it.
    pub fn cpu_ms(&self) -> Option<f64> {
        self.median(|e| e.cpu_ms)
    }

    /// Median time of a frame by timestamp queries, if the device has them.
    pub fn device_ms(&self) -> Option<f64> {
        self.median(|e| e.device_ms)
    }

    fn median(&self, of: impl Fn(&Elapsed) -> Option<f64>) -> Option<f64> {
        let all: Option<Vec<f64>> = self.0.iter().map(of).collect();
        Quartiles::of(&all?).map(|q| q.median)
    }
}

/// Time of the renderer alone, medians of a frame in milliseconds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RenderTime {
    /// Wall time.
    pub render_ms: Option<f64>,
    /// CPU time of the process.
    pub render_cpu_ms: Option<f64>,
    /// Time by timestamp queries.
    pub render_device_ms: Option<f64>,
}

impl RenderTime {
    /// Medians of `times`; all `None` without frames.
    pub fn of(times: &Times) -> Self {
        Self {
            render_ms: times.wall_ms().map(|q| q.median),
            render_cpu_ms: times.cpu_ms(),
            render_device_ms: times.device_ms(),
        }
    }

    /// The clock that comes first in [`Elapsed::cost_ms`].
    pub fn cost_ms(&self) -> Option<f64> {
        self.render_device_ms.or(self.render_cpu_ms).or(self.render_ms)
    }
}

/// Time of a whole frame in milliseconds: the renderer's and the pass's medians, and their sums. `None` if no frame is
/// rendered.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FrameTime {
    /// Of the renderer.
    #[serde(flatten)]
    pub render: RenderTime,
    /// Wall time of renderer and pass.
    pub total_ms: Option<f64>,
    /// CPU time of renderer and pass.
    pub total_cpu_ms: Option<f64>,
    /// Time of the pass by timestamp queries.
    pub device_ms: Option<f64>,
    /// Time of renderer and pass by timestamp queries.
    pub total_device_ms: Option<f64>,
}

impl FrameTime {
    /// Of a renderer and a pass.
    pub fn of(render: RenderTime, post: &Times) -> Self {
        let sum = |a: Option<f64>, b: Option<f64>| Some(a? + b?);
        let device_ms = post.device_ms();
        Self {
            render,
            total_ms: sum(render.render_ms, post.wall_ms().map(|q| q.median)),
            total_cpu_ms: sum(render.render_cpu_ms, post.cpu_ms()),
            device_ms,
            total_device_ms: sum(render.render_device_ms, device_ms),
        }
    }
}
