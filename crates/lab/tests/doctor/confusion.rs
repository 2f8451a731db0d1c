//! Confusion table: planted errors and clips, and whether each error is named.

use super::clips::{Clip, Delivery, foveations};
use super::planted::{PLANTED, Planted};
use crate::shared_data::shared_data;
use afterimage::doctor::{Finding, Outcome};

/// How an error fared on a clip.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Fate {
    Named,
    CannotTell,
    Misnamed,
}

/// Clips of the workspace, and those of the shared data that are there.
fn clips() -> Vec<Clip> {
    let scene = |name: &str| Clip::open(name, Some([240, 135]), 1, 6);
    let mut clips = vec![
        Clip::open("fixtures/sequences/lateral_160x90", None, 0, 6),
        scene("analytic:lateral"),
        scene("analytic:turn"),
        scene("analytic:occluder"),
    ];
    clips.extend(shared_data("sequences/sponza_object").map(|path| Clip::open(path.to_str().unwrap(), None, 1, 6)));
    clips
}

/// A planted error is named if its check names its fault and the line that mends it, and no other check accuses.
fn fate(planted: &Planted, findings: &[Finding]) -> Fate {
    let mut fate = Fate::CannotTell;
    for finding in findings {
        let is_asked = finding.check == planted.check();
        match finding.outcome {
            Outcome::Wrong(fault) => {
                let is_right = is_asked
                    && fault == planted.fault
                    && finding.mend.as_ref().is_some_and(|m| m.contains(planted.mend));
                if !is_right {
                    return Fate::Misnamed;
                }
                fate = Fate::Named;
            }
            Outcome::Fits if is_asked => return Fate::Misnamed,
            _ => {}
        }
    }
    fate
}

#[test]
fn planted_errors_are_named_and_none_is_misnamed() {
    let clips = clips();
    let mut misnamed = vec![];
    let (mut named, mut all) = (0, 0);
    let mut rows: Vec<String> = PLANTED.iter().map(|p| format!("{:37}", p.name)).collect();
    let mut right = String::from("right input                          ");
    for clip in &clips {
        for foveation in foveations() {
            let delivery = Delivery::right(clip, foveation);
            let context = format!("{} {:?}", clip.name, foveation.filter);
            let findings = delivery.findings();
            let accused: Vec<_> = findings.iter().filter(|f| f.fault().is_some()).collect();
            right += if accused.is_empty() { "  ok" } else { "  XX" };
            misnamed.extend(accused.iter().map(|f| format!("{context}: right input: {f}")));
            for (planted, row) in PLANTED.iter().zip(&mut rows) {
                let mut wrong = delivery.clone();
                (planted.plant)(clip, &mut wrong);
                let findings = wrong.findings();
                let fate = fate(planted, &findings);
                *row += match fate {
                    Fate::Named => "   +",
                    Fate::CannotTell => "   .",
                    Fate::Misnamed => "   X",
                };
                all += 1;
                named += usize::from(fate == Fate::Named);
                if fate == Fate::Misnamed || std::env::var_os("DOCTOR_VERBOSE").is_some() {
                    let lines = findings.iter().map(|f| format!("\n    {f}"));
                    let text = format!("{context}: {}: {fate:?}{}", planted.name, lines.collect::<String>());
                    if fate == Fate::Misnamed {
                        misnamed.push(text);
                    } else {
                        println!("{text}");
                    }
                }
            }
        }
    }
    println!("columns: each clip with mip levels, then with blocks; + named, . cannot tell, X misnamed");
    clips.iter().for_each(|c| println!("  {}", c.name));
    println!("{right}");
    rows.iter().for_each(|row| println!("{row}"));
    println!("{named} of {all} named, {} misnamed", misnamed.len());
    assert!(misnamed.is_empty(), "{}", misnamed.join("\n"));
    assert!(10 * named > 7 * all, "{named} of {all}");
}
