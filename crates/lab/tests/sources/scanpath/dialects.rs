//! Dialects of scanpath files: what spreadsheets, R and pandas make of the same samples.

use super::{HEADER, at, parse};
use afterimage_lab::scanpath::*;

const SCREEN: &str = "# screen_px: 1024x768\n# screen_cm: 38.0x30.0\n# distance_cm: 67\n";

/// The rows that every dialect stands for; the second is lost.
fn expected() -> [Sample; 3] {
    [at(0.0, [960.5, 790.0]), Sample { t_s: 0.5, px: None }, at(1.0, [12.25, -3.0])]
}

fn samples(text: &str) -> Vec<Sample> {
    let path = parse_csv("gaze.csv", text.as_bytes()).unwrap_or_else(|e| panic!("{text}\n{e}"));
    assert_eq!((path.screen().size_px, path.screen().size_cm), ([1024, 768], Some([38.0, 30.0])), "{text}");
    path.samples().to_vec()
}

#[test]
fn every_dialect_is_the_same_scanpath() {
    let own = "t_s,x_px,y_px,valid\n0,960.5,790,1\n0.5,1,2,0\n1,12.25,-3,1\n";
    let dialects = [
        own.to_owned(),
        own.replace('\n', "\r\n"),
        own.replace(',', "\t"),
        own.replace(',', " "),
        own.replace(',', ";"),
        own.replace(',', ";").replace('.', ","),
        own.replace(',', " , "),
        own.replace("t_s,x_px,y_px,valid", "\"t_s\",\"x_px\",\"y_px\",\"valid\""),
        own.replace(",1\n", ",TRUE\n").replace(",0\n", ",FALSE\n"),
        own.replace(",1\n", ",true\n").replace(",0\n", ",false\n"),
        own.replace(",1\n", ",1.0\n").replace(",0\n", ",0.0\n"),
        own.replace(",0\n", ",NA\n"),
        own.replace(",0\n", ",\n"),
        // Further columns, rows filled up by a spreadsheet, and columns in another order.
        own.replace(",valid", ",valid,pupil_mm,label").replace(",1\n", ",1,3.2,a\n").replace(",0\n", ",0,,\n"),
        own.replace('\n', ",,\n"),
        "x_px,y_px,t_s,valid\n960.5,790,0,1\n1,2,0.5,0\n12.25,-3,1,1\n".to_owned(),
        "\"\",\"T_S\",\"X_px\",\"Y_px\"\n\"1\",0,960.5,790\n\"2\",0.5,NA,NA\n\"3\",1,12.25,-3\n".to_owned(),
        own.to_uppercase(),
    ];
    for dialect in dialects {
        assert_eq!(samples(&format!("{SCREEN}{dialect}")), expected(), "{dialect}");
    }
    for lost in ["NA,NA", ".,.", ",", "nan,nan", "NaN,NaN", "null,null", "None,2", "1,#N/A", "-nan(ind),1", "inf,1"] {
        let dialect = own.replace("0.5,1,2,0", &format!("0.5,{lost},1"));
        assert_eq!(samples(&format!("{SCREEN}{dialect}")), expected(), "{dialect}");
    }
    // The header as a spreadsheet saves it.
    let filled = SCREEN.replace('\n', ";;;\n").replace("# screen_px", "\"# screen_px").replace("768;", "768\";");
    assert_eq!(samples(&format!("\u{feff}{filled}{}", own.replace(',', ";"))), expected());
    let utf16: Vec<u8> = format!("\u{feff}{SCREEN}{own}").encode_utf16().flat_map(u16::to_le_bytes).collect();
    assert_eq!(parse_csv("g", &utf16).unwrap().samples(), expected());
    // Planted: a dialect that says something else is not the same.
    assert_ne!(samples(&format!("{SCREEN}{}", own.replace("t_s,x_px,y_px", "t_s,y_px,x_px"))), expected());
}

#[test]
fn of_equal_times_the_last_valid_sample_counts() {
    let path = parse("0,1,1,1\n0,2,2,1\n0.5,3,3,1\n0.5,4,4,0\n1,5,5,0\n1,6,6,1\n").unwrap();
    assert_eq!(path.samples(), [at(0.0, [2.0; 2]), at(0.5, [3.0; 2]), at(1.0, [6.0; 2])]);
    let text = format!("{HEADER}0,1,1,1\n0,2,2,1\n");
    let log = parse_gaze_log("gaze.csv", text.as_bytes(), &GazeLogOptions::default()).unwrap();
    assert!(log.warnings[0].contains("1 samples at the time of the one before"), "{:?}", log.warnings);
}

#[test]
fn wrong_units_and_lost_gaze_are_doubted_and_usual_recordings_are_not() {
    let doubts = |rows: &str| parse(rows).unwrap().warnings();
    let rows = |count: usize, row: &dyn Fn(f64) -> String| (0..count).map(|i| row(i as f64)).collect::<String>();
    let usual = rows(60, &|i| format!("{},{},{},1\n", i / 60.0, 100.0 + i, 300.0 - i));
    assert_eq!(doubts(&usual), [""; 0]);
    // From 0 to 1, a little off the screen at times.
    let shares = rows(60, &|i| format!("{},{},{},1\n", i / 60.0, 0.017 * i, 1.0 - 0.016 * i));
    let milliseconds = rows(60, &|i| format!("{},{},{},1\n", i * 16.667, 100.0 + i, 300.0));
    let lost = rows(60, &|i| format!("{},{},300,{}\n", i / 60.0, 100.0 + i, u8::from(i % 5.0 == 0.0)));
    for (rows, word) in [
        (&shares, "gaze.csv: all gaze lies within a pixel of a corner of 1024x768 pixels; are the coordinates 0 to 1?"),
        (&milliseconds, "60 samples in 983.353 s are 0.06 a second; are the times milliseconds?"),
        (&lost, "the gaze is lost in 48 of 60 samples"),
    ] {
        let said = doubts(rows);
        assert!(said.len() == 1 && said[0].contains(word), "{said:?}");
    }
    // A pause between two trials is not slow, and half of the gaze is not most of it.
    let [trial, other] =
        [(0.0, 1), (99.0, 0)].map(|(start, valid)| rows(30, &|i| format!("{},100,300,{valid}\n", start + i / 60.0)));
    assert_eq!(doubts(&(trial + &other)), [""; 0]);
    assert_eq!(doubts("0,0.5,0.5,1\n").len(), 1);
}
