//! Confusion table: planted errors and clips, and whether each error is named.

use super::clips::{Clip, Delivery, foveations};
use super::planted::{PLANTED, Planted};
use crate::shared_data::shared_data;
use afterimage::doctor::{Check, Finding, Outcome};
use afterimage::internal::Foveation;
use rayon::prelude::*;

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
    let fixture = Clip::open("fixtures/sequences/lateral_160x90", None, 0, 6);
    let mut clips = vec![fixture, scene("analytic:turn"), scene("analytic:occluder")];
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
                let mends = finding.mend.as_ref().is_some_and(|m| m.contains(planted.mend));
                if !is_asked || fault != planted.fault || !mends {
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

/// A column of the table: a clip under a foveation.
struct Column {
    is_right: bool,
    fates: Vec<Fate>,
    misnamed: Vec<String>,
}

fn column(clip: &Clip, foveation: Foveation) -> Column {
    let delivery = Delivery::right(clip, foveation);
    let context = format!("{} {:?}", clip.name, foveation.kind);
    let findings = delivery.findings();
    let accused = findings.iter().filter(|f| f.fault().is_some());
    let mut misnamed: Vec<_> = accused.map(|f| format!("{context}: right input: {f}")).collect();
    let is_right = misnamed.is_empty();
    let mut fates = vec![];
    for planted in &PLANTED {
        let mut wrong = delivery.clone();
        (planted.plant)(clip, &mut wrong);
        let findings = wrong.findings();
        let fate = fate(planted, &findings);
        fates.push(fate);
        let lines: String = findings.iter().map(|f| format!("\n    {f}")).collect();
        let said = format!("{context}: {}: {fate:?}{lines}", planted.name);
        if std::env::var_os("DOCTOR_VERBOSE").is_some() {
            println!("{said}");
        }
        misnamed.extend((fate == Fate::Misnamed).then_some(said));
    }
    Column { is_right, fates, misnamed }
}

#[test]
fn planted_errors_are_named_and_none_is_misnamed() {
    let clips = clips();
    // The largest clip takes as long as the others together: it has mip levels alone.
    let of = |clip: &Clip| foveations().into_iter().take(if clip.size()[0] > 240 { 1 } else { 2 });
    let cases: Vec<_> = clips.iter().flat_map(|clip| of(clip).map(move |f| (clip, f))).collect();
    let columns: Vec<_> = cases.into_par_iter().map(|(clip, foveation)| column(clip, foveation)).collect();
    println!("columns: each clip with mip levels, then with blocks; + named, . cannot tell, X misnamed");
    clips.iter().for_each(|c| println!("  {}", c.name));
    let right = columns.iter().map(|c| if c.is_right { "   +" } else { "   X" });
    println!("{:37}{}", "right input", right.collect::<String>());
    for (i, planted) in PLANTED.iter().enumerate() {
        let row = columns.iter().map(|column| match column.fates[i] {
            Fate::Named => "   +",
            Fate::CannotTell => "   .",
            Fate::Misnamed => "   X",
        });
        println!("{:37}{}", planted.name, row.collect::<String>());
    }
    let fates = || columns.iter().flat_map(|c| &c.fates);
    let (named, all) = (fates().filter(|f| **f == Fate::Named).count(), fates().count());
    let misnamed: Vec<_> = columns.iter().flat_map(|c| c.misnamed.iter().map(String::as_str)).collect();
    println!("{named} of {all} named, {} misnamed", misnamed.len());
    assert!(misnamed.is_empty(), "{}", misnamed.join("\n"));
    assert!(10 * named > 7 * all, "{named} of {all}");
}

/// Frames by quads are given at full rate: right ones are not accused, and errors of everything but gaze and foveation
/// are named.
#[test]
fn frames_by_quads_are_examined_at_full_rate() {
    let clip = Clip::open("analytic:turn", Some([240, 135]), 1, 6);
    let right = Delivery::right(&clip, Foveation::quads());
    for finding in right.findings() {
        assert_eq!(finding.fault(), None, "{finding}");
        let has_evidence = !matches!(finding.check, Check::Gaze | Check::Foveation);
        assert!(has_evidence || matches!(finding.outcome, Outcome::CannotTell(_)), "{finding}");
    }
    let mut named = 0;
    for planted in PLANTED.iter().filter(|p| !matches!(p.check(), Check::Gaze | Check::Foveation)) {
        let mut wrong = right.clone();
        (planted.plant)(&clip, &mut wrong);
        let fate = fate(planted, &wrong.findings());
        println!("{:37}{fate:?}", planted.name);
        named += u32::from(fate == Fate::Named);
        assert_ne!(fate, Fate::Misnamed, "{}", planted.name);
    }
    assert!(named > 7, "{named}");
}
