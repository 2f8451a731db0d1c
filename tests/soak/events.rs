//! Random events of a stream, drawn for every frame, the same on every machine.

use afterimage_testing::Draws;

/// Events before or in a frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Event {
    pub reset: bool,
    pub size: Option<[u32; 2]>,
    pub exposure: Option<f32>,
    /// Some pixels of color, depth or motion are not finite or out of range.
    pub is_broken: bool,
    /// The gaze is lost.
    pub is_lost: bool,
    /// The frame has depth and motion inputs, with arbitrary values.
    pub moves: bool,
}

/// State of a stream: picture, gaze and exposure.
#[derive(Clone, Copy, Debug)]
pub struct StreamState {
    pub frame: u64,
    pub picture: u32,
    pub gaze: u32,
    pub exposure: f32,
}

/// An endless stream.
pub struct Stream {
    draws: Draws,
    full: [u32; 2],
    state: StreamState,
}

impl Stream {
    pub fn new(name: &str, full: [u32; 2]) -> Self {
        let state = StreamState { frame: 0, picture: 0, gaze: 0, exposure: 1.0 };
        Self { draws: Draws::new(name), full, state }
    }

    pub fn state(&self) -> StreamState {
        self.state
    }

    pub fn next(&mut self) -> Event {
        self.state.frame += 1;
        let mut one_in = |n: u32| self.draws.bits().is_multiple_of(n);
        let mut event = Event {
            reset: one_in(60),
            is_broken: one_in(8),
            is_lost: one_in(15),
            moves: one_in(2),
            ..Event::default()
        };
        let (resizes, steps, looks, changes) = (one_in(90), one_in(40), one_in(12), one_in(25));
        if resizes {
            let [w, h] = self.full;
            let sizes = [[w, h], [w, h], [w - 1, h + 1], [w / 2, h / 2], [(w / 3) | 1, (h / 3) | 1], [1, 1], [7, 2]];
            event.size = Some(sizes[self.draws.bits() as usize % sizes.len()]);
        } else if self.state.frame.is_multiple_of(100) {
            event.size = Some(self.full);
        }
        if steps {
            let exposure = 2.0_f32.powi(self.draws.bits() as i32 % 4);
            event.exposure = Some(exposure / self.state.exposure);
            self.state.exposure = exposure;
        }
        if looks {
            self.state.gaze = self.draws.bits() % 8;
        }
        if changes {
            self.state.picture = self.draws.bits() % 3;
        }
        event
    }
}
