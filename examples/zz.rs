//! x
use afterimage::scene::builtin;
use afterimage::trace::{cpu::CpuTracer, film::Film, settings::*, view::View, work, world::World};
fn main() {
    let s = builtin::cornell();
    let size = [64u32, 64];
    let w = World::new(&s);
    let view = View::of_camera(&s.pose(0.0).cameras[0], size, None).unwrap();
    for depth in [1, 3] {
        for integ in [Integrator::Mis, Integrator::Nee, Integrator::Naive] {
            let tracer = CpuTracer::new(TraceSettings { max_depth: depth, integrator: integ, ..Default::default() });
            let mut film = Film::new(size);
            let spp = if integ == Integrator::Naive { 4000 } else { 200 };
            tracer.trace(&w, &view, 0, &work::uniform(size[0], 0..size[1], 0..spp), &mut film);
            let (m, v) = (film.color(), film.variance());
            let f = |i: usize| i / 64 > 14;
            let mean =
                m.pixels().iter().enumerate().filter(|(i, _)| f(*i)).map(|(_, p)| p[1] as f64).sum::<f64>() / 4096.;
            let sd = v.pixels().iter().enumerate().filter(|(i, _)| f(*i)).map(|(_, p)| p[1] as f64).sum::<f64>().sqrt()
                / 4096.;
            println!("{depth} {integ:?} {mean:.5} +- {sd:.5}");
        }
    }
}
