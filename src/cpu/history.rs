//! The state between frames: one type owns both halves of the ping-pong and swaps them itself.

/// Reservoirs of all views, this frame's and the last one's. 24 bytes a pixel and view, 32 with A-ES keys.
#[derive(Clone, Debug, PartialEq)]
pub struct History {
    view_len: usize,
    previous: Plane,
    current: Plane,
    filled: bool,
    held_gaze: Vec<Option<[f32; 2]>>,
}

/// Packed reservoirs of all views, view after view, and their A-ES keys if any.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Plane {
    pub words: Vec<[u32; 3]>,
    pub log_keys: Vec<f32>,
}

impl Plane {
    fn new(len: usize, keys: bool) -> Self {
        Self { words: vec![[0; 3]; len], log_keys: vec![0.0; if keys { len } else { 0 }] }
    }
}

impl History {
    pub(super) fn new(size_px: [u32; 2], view_count: u32, keys: bool) -> Self {
        let view_len = size_px[0] as usize * size_px[1] as usize;
        let len = view_len * view_count as usize;
        Self {
            view_len,
            previous: Plane::new(len, keys),
            current: Plane::new(len, keys),
            filled: false,
            held_gaze: vec![None; view_count as usize],
        }
    }

    pub(super) fn forget(&mut self) {
        self.filled = false;
        self.held_gaze.fill(None);
    }

    /// Makes what was written the past.
    pub(super) fn swap(&mut self) {
        std::mem::swap(&mut self.previous, &mut self.current);
        self.filled = true;
    }

    /// Whether there is a past at all.
    pub fn is_filled(&self) -> bool {
        self.filled
    }

    pub(super) fn held_gaze(&mut self, view: usize) -> &mut Option<[f32; 2]> {
        &mut self.held_gaze[view]
    }

    /// The past of `view` to read, and the rows to write.
    pub(super) fn split(&mut self, view: usize) -> (PastView<'_>, &mut [[u32; 3]], &mut [f32]) {
        let range = view * self.view_len..(view + 1) * self.view_len;
        let keys = if self.previous.log_keys.is_empty() { 0..0 } else { range.clone() };
        let past =
            PastView { words: &self.previous.words[range.clone()], log_keys: &self.previous.log_keys[keys.clone()] };
        (past, &mut self.current.words[range], &mut self.current.log_keys[keys])
    }

    /// Packed reservoirs of the last processed frame, view after view ([`pack`](crate::kernel::pack)).
    pub fn words(&self) -> &[[u32; 3]] {
        &self.previous.words
    }

    pub(super) fn restore(&mut self, words: &[[u32; 3]]) {
        self.previous.words.copy_from_slice(words);
        self.previous.log_keys.fill(f32::MIN);
        self.filled = true;
    }

    /// Bytes held.
    pub fn memory_bytes(&self) -> usize {
        [&self.previous, &self.current].iter().map(|p| size_of_val(&p.words[..]) + size_of_val(&p.log_keys[..])).sum()
    }
}

/// Last frame's reservoirs of one view.
#[derive(Clone, Copy)]
pub(super) struct PastView<'a> {
    pub words: &'a [[u32; 3]],
    pub log_keys: &'a [f32],
}
