//! The doctor finds planted errors, and accuses no right input.

mod clips;
mod twins;

use afterimage::*;
use clips::{Clip, Delivery, foveations};

#[test]
#[ignore]
fn explore() {
    let clips = [
        Clip::open("fixtures/sequences/lateral_160x90", None, 0, 6),
        Clip::open("analytic:lateral", Some([320, 180]), 1, 8),
        Clip::open("analytic:turn", Some([320, 180]), 1, 8),
        Clip::open("analytic:occluder", Some([320, 180]), 1, 8),
        Clip::open("../shared/data/sequences/sponza_lateral", None, 1, 8),
        Clip::open("../shared/data/sequences/sponza_object", None, 1, 8),
    ];
    for clip in &clips {
        for foveation in foveations()
            .into_iter()
            .chain([Foveation::default(), Foveation { filter: Filter::Block, ..Foveation::default() }])
        {
            println!("== {} {:?} {}/{}", clip.name, foveation.filter, foveation.rate_mid, foveation.rate_far);
            let right = Delivery::right(clip, foveation);
            println!("   right: {}", right.findings()[0]);
            let size = clip.size();
            let [w, h] = size.map(|s| s as f32);
            let planted: Vec<(&str, Box<dyn Fn([f32; 2]) -> [f32; 2]>)> = vec![
                ("sign", Box::new(|[x, y]| [-x, -y])),
                ("y", Box::new(|[x, y]| [x, -y])),
                ("uv", Box::new(move |[x, y]| [x / w, y / h])),
                ("ndc", Box::new(move |[x, y]| [2.0 * x / w, 2.0 * y / h])),
                ("double", Box::new(|[x, y]| [2.0 * x, 2.0 * y])),
                ("half", Box::new(|[x, y]| [0.5 * x, 0.5 * y])),
                ("swap", Box::new(|[x, y]| [y, x])),
            ];
            for (name, change) in planted {
                let mut wrong = right.clone();
                for f in &mut wrong.frames {
                    f.motion = f.motion.as_ref().map(|m| m.map(&change));
                }
                println!("   {name}: {}", wrong.findings()[0]);
            }
        }
    }
}
