//! x
use afterimage::scene::builtin;
use afterimage::trace::{cpu::CpuTracer, film::Film, settings::*, view::View, work, world::World};
fn main() {
    let s = builtin::cornell();
    let size = [16u32, 16];
    let w = World::new(&s);
    let view = View::of_camera(&s.pose(0.0).cameras[0], size, None).unwrap();
    let mut imgs = vec![];
    for integ in [Integrator::Nee, Integrator::Naive] {
        let tracer = CpuTracer::new(TraceSettings { max_depth: 1, integrator: integ, ..Default::default() });
        let mut film = Film::new(size);
        let spp = if integ == Integrator::Naive { 20000 } else { 1000 };
        tracer.trace(&w, &view, 0, &work::uniform(size[0], 0..size[1], 0..spp), &mut film);
        imgs.push((film.color(), film.variance()));
    }
    for y in 0..16 {
        for x in 0..16 {
            let (a, b) = (imgs[0].0.at(x, y)[1], imgs[1].0.at(x, y)[1]);
            let sd = (imgs[0].1.at(x, y)[1] + imgs[1].1.at(x, y)[1]).sqrt();
            print!("{:5.2}({:4.1}) ", b / a.max(1e-9), (b - a) / sd.max(1e-9));
        }
        println!();
    }
}
