//! Hard cases of masks on the GPU, H86 and up: each frame is equal on both executors, bit for bit, and the laws
//! are those of the CPU.

use super::*;
use crate::images::{Images, planned};
use crate::mask_hard::*;
use std::cell::RefCell;
use std::rc::Rc;

/// Both executors. Returns to the pool when it is dropped, because a device and its pipelines take long to make.
struct Both {
    rig: Option<Rig>,
    pool: Rc<RefCell<Vec<Rig>>>,
}

impl Shows for Both {
    fn show(&mut self, index: u64, shots: &[Shot]) -> Vec<Color> {
        let rig = self.rig.as_mut().unwrap();
        rig.exposure = shots[0].exposure;
        let views: Vec<_> = shots.iter().map(|shot| shot.view.clone()).collect();
        let (made, _) = rig.both(index, shots[0].reset, &views);
        let size = rig.context.size_px;
        let pixels = made.shown.chunks(made.shown.len() / shots.len());
        pixels.map(|p| Image::from_pixels(size, p.iter().map(|c| c.map(f32::from_bits)).collect()).unwrap()).collect()
    }

    fn plan(&self, index: u64, shot: &Shot) -> Mask {
        let images = Images::of([&shot.view]);
        let frame = afterimage::cpu::Frame { reset: shot.reset, ..images.frame(index) };
        planned(&mut self.rig.as_ref().unwrap().cpu.clone(), &frame).remove(0)
    }

    fn set_settings(&mut self, settings: Settings) {
        self.rig.as_mut().unwrap().set_settings(settings);
    }
}

impl Drop for Both {
    fn drop(&mut self) {
        self.pool.borrow_mut().extend(self.rig.take());
    }
}

/// What a law measured; `None`, after a message, without an adapter.
pub(super) fn run_law(law: fn(Make) -> Option<String>) -> Option<String> {
    let pool: Rc<RefCell<Vec<Rig>>> = Rc::default();
    law(&|desc: ContextDesc| {
        let fits = |rig: &Rig| (rig.context.size_px, rig.context.view_count) == (desc.size_px, desc.view_count);
        let used = pool.borrow().iter().position(fits);
        let rig = match used {
            Some(i) => {
                let mut rig = pool.borrow_mut().swap_remove(i);
                rig.set_settings(desc.settings);
                rig.forget();
                rig
            }
            None => Rig::new(desc, desc.settings)?,
        };
        Some(Box::new(Both { rig: Some(rig), pool: pool.clone() }))
    })
}

mask_laws!(Gpu, run_law);
