//! Pixels that a method chose, with the numbers of paths that it asks for.

use crate::Tracer;
use crate::film::Film;
use crate::work::Spans;
use crate::world::World;
use afterimage_lab::frame::ShadingRequest;
use afterimage_lab::view::View;
use std::collections::BTreeSet;
use std::ops::Range;

/// Samples traced per call, which bounds the memory of their paths.
const STEP: u32 = 1 << 20;

/// Traces the requested pixels of frame `frame`; `samples` paths each, unless the request has numbers of its own.
pub fn trace_requested(
    tracer: &Tracer,
    world: &World,
    view: &View,
    frame: u64,
    request: &ShadingRequest,
    samples: u32,
) -> Film {
    let mut film = Film::new(request.mask.size());
    for (pixels, samples) in by_paths(request, samples.max(1)) {
        for pixels in pixels.chunks((STEP / samples.len() as u32).max(1) as usize) {
            let spans = Spans::new(pixels.iter().copied(), samples.clone());
            tracer.trace(world, view, frame, &spans, &mut film);
        }
    }
    film
}

/// Requested pixels and numbers of their samples: for each number of paths, the pixels with at least as many get the
/// samples that the next lower number leaves out.
fn by_paths(request: &ShadingRequest, samples: u32) -> Vec<(Vec<[u32; 2]>, Range<u32>)> {
    let pixels: Vec<_> = request.pixels().collect();
    let Some(paths) = &request.paths else { return vec![(pixels, 0..samples)] };
    let of = |[x, y]: [u32; 2]| u32::from(paths.at(x as usize, y as usize));
    let numbers: BTreeSet<u32> = pixels.iter().map(|&px| of(px)).filter(|&paths| paths > 0).collect();
    let from = [0].into_iter().chain(numbers.iter().copied());
    let with = |least: u32| pixels.iter().copied().filter(|&px| of(px) >= least).collect();
    from.zip(&numbers).map(|(from, &to)| (with(to), from..to)).collect()
}
