//! Files of scanpaths.

use super::*;

#[test]
fn broken_files_are_refused_with_the_line() {
    let head = "# screen_px: 200x100\nt_s,x_px,y_px,valid\n";
    for (text, line) in [
        ("", "no samples"),
        ("t_s,x_px,y_px,valid\n0,1,1,1\n", "line 2: expected the screen's size"),
        ("# screen_px: 0x9\n", "line 1: expected the screen's size"),
        ("x,y\n", "line 1: expected the columns"),
        (&format!("{head}0,1,1\n"), "line 3: expected four numbers"),
        (&format!("{head}0,1,1,1\n-1,1,1,1\n"), "line 4: expected finite times"),
        (head, "no samples"),
    ] {
        let error = Scanpath::parse(text).expect_err(text).to_string();
        assert!(error.starts_with(line), "{text:?}: {error}");
    }
}

#[test]
fn lost_samples_are_lost() {
    let text = "# screen_px: 200x100\nt_s,x_px,y_px,valid\n1,1,1,0\n2,nan,1,1\n3,200,100,1\n";
    let scanpath = Scanpath::parse(text).unwrap();
    assert_eq!([0.0, 1.5, 2.0, 9.0].map(|t| scanpath.at(t)), [None, None, None, Some(Vec2::ONE)]);
    assert_eq!(scanpath.end_s(), 3.0);
}
