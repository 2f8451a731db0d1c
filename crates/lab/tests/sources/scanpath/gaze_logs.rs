//! Exports of eye trackers: all of them tell the same gaze on the same screen, in the columns, units and axes of each.

use super::at;
use afterimage_lab::scanpath::*;
use std::fmt::Write;

/// The screen of all recordings.
const PX: [u32; 2] = [1920, 1080];
const MM: [f32; 2] = [531.0, 299.0];
const DISTANCE_MM: f32 = 650.0;

/// The gaze: time in milliseconds and pixels; the fourth sample is lost.
const GAZE: [(u64, Option<[f64; 2]>); 5] = [
    (0, Some([960.0, 790.0])),
    (10, Some([100.0, 60.0])),
    (20, Some([1800.0, 1000.0])),
    (30, None),
    (40, Some([1500.0, 270.0])),
];

fn options(eye: Eye) -> GazeLogOptions {
    GazeLogOptions {
        eye,
        screen_px: Some(PX),
        screen_mm: Some(MM),
        distance_mm: Some(DISTANCE_MM),
        ..Default::default()
    }
}

/// Shares of the screen.
fn share(px: [f64; 2]) -> [f64; 2] {
    [px[0] / 1920.0, px[1] / 1080.0]
}

/// Direction: x right, y up, z ahead, of length 1.
fn forward(px: [f64; 2]) -> [f64; 3] {
    let x = (px[0] - 960.0) * 531.0 / 1920.0 / 650.0;
    let y = (540.0 - px[1]) * 299.0 / 1080.0 / 650.0;
    let length = (x * x + y * y + 1.0).sqrt();
    [x / length, y / length, 1.0 / length]
}

/// A table: its names, and the row of each sample; `None` has no row.
fn table(names: &str, row: impl Fn(u64, Option<[f64; 2]>) -> String) -> String {
    let mut text = format!("{names}\n");
    for (ms, px) in GAZE {
        writeln!(text, "{}", row(ms, px)).unwrap();
    }
    text
}

/// Exports with gaze of both eyes, as their writers make them.
fn exports() -> Vec<(Vendor, &'static str, String)> {
    let shares = |px: Option<[f64; 2]>| px.map(share);
    let pair = |v: Option<[f64; 2]>, lost: &str| v.map_or(format!("{lost},{lost}"), |[x, y]| format!("{x:.9},{y:.9}"));
    let valid = |px: Option<[f64; 2]>| u8::from(px.is_some());
    // Tobii Pro Lab: rows of other sensors and of events between the samples; no validity where there is no gaze.
    let pro_lab = |unit: &str, per_ms: u64| {
        table(
            &format!(
                "\u{feff}Recording timestamp [{unit}]\tSensor\tEvent\tGaze point X [DACS px]\tGaze point Y [DACS px]\t\
                 Validity left\tValidity right"
            ),
            |ms, px| {
                let t = 5_000 * per_ms + ms * per_ms;
                let gaze = pair(px, "").replace(',', "\t");
                let word = if px.is_some() { "Valid\tInvalid" } else { "Invalid\tInvalid" };
                format!(
                    "{t}\tMouse\t\t3\t4\tValid\tValid\n{t}\t\tKeyboardEvent\t\t\t\t\n{t}\tEye Tracker\t\t{gaze}\t{word}"
                )
            },
        )
    };
    let studio =
        table("RecordingTimestamp\tGazePointX (ADCSpx)\tGazePointY (ADCSpx)\tValidityLeft\tValidityRight", |ms, px| {
            format!("{ms}\t{}\t{}", pair(px, "").replace(',', "\t"), if px.is_some() { "0\t4" } else { "4\t4" })
        });
    let sdk = table(
        "device_time_stamp,left_gaze_point_on_display_area_x,left_gaze_point_on_display_area_y,\
         left_gaze_point_validity,\
         right_gaze_point_on_display_area_x,right_gaze_point_on_display_area_y,right_gaze_point_validity",
        |ms, px| {
            let of = |dx: f64| format!("{},{}", pair(shares(px).map(|[x, y]| [x + dx, y]), "nan"), valid(px));
            format!("{},{},{}", 1_712_414_508_200_000 + 1000 * ms, of(-0.01), of(0.01))
        },
    );
    let sdk_tuples = table(
        "device_time_stamp;left_gaze_point_on_display_area;left_gaze_point_validity;right_gaze_point_on_display_area;\
         right_gaze_point_validity",
        |ms, px| {
            // The right eye is lost throughout: the left one is the gaze.
            let [x, y] = shares(px).unwrap_or([f64::NAN; 2]);
            format!("{};({x:.9}, {y:.9});{};(nan, nan);0", 7_000_000 + 1000 * ms, valid(px)).replace("NaN", "nan")
        },
    );
    let core = table("gaze_timestamp,world_index,confidence,norm_pos_x,norm_pos_y,base_data", |ms, px| {
        let confidence = if px.is_some() { 0.98 } else { 0.4 };
        let up = pair(shares(px).map(|[x, y]| [x, 1.0 - y]), "0.5");
        format!("{:.6},0,{confidence},{up},74701.3-0", 74_701.3 + ms as f64 / 1e3)
    });
    let surface = table(
        "world_timestamp,world_index,gaze_timestamp,x_norm,y_norm,x_scaled,y_scaled,on_surf,confidence",
        |ms, px| {
            let confidence = if px.is_some() { 0.9 } else { 0.0 };
            let up = pair(shares(px).map(|[x, y]| [x, 1.0 - y]), "0.5");
            format!("74701,0,{:.6},{up},1,1,True,{confidence}", 74_701.3 + ms as f64 / 1e3)
        },
    );
    let neon = table(
        "section id,recording id,timestamp [ns],gaze x [px],gaze y [px],worn,fixation id,blink id,azimuth \
         [deg],elevation [deg]",
        |ms, px| {
            let [x, y, z] = forward(px.unwrap_or([5.0, 5.0]));
            let blink = if px.is_some() { "" } else { "3" };
            let (azimuth, elevation) = (x.atan2(z).to_degrees(), y.asin().to_degrees());
            format!(
                "a1,c3,{},1,2,1.0,1,{blink},{azimuth:.9},{elevation:.9}",
                1_717_171_717_005_000_123 + 1_000_000 * ms
            )
        },
    );
    let mapper = table(
        "section id,recording id,timestamp [ns],gaze detected on surface,gaze position on surface x [normalized],\
         gaze position on surface y [normalized],fixation id,blink id",
        |ms, px| format!("a1,c3,{},True,{},,", 1_717_171_717_005_000_123 + 1_000_000 * ms, pair(shares(px), "")),
    );
    let gazepoint = table(
        "MEDIA_ID,CNT,TIME(2024/05/01 10:00:00.000),TIMETICK(f=10000000),FPOGX,FPOGY,FPOGV,BPOGX,BPOGY,BPOGV,BKID,",
        // TIME begins again with each picture; the fixation lags.
        |ms, px| {
            format!("0,1,0.00,{},0.1,0.1,1,{},{},0,", 48_860_001_560 + 10_000 * ms, pair(shares(px), "0"), valid(px))
        },
    );
    let varjo = table(
        "raw_timestamp,relative_to_unix_epoch_timestamp,status,gaze_forward_x,gaze_forward_y,gaze_forward_z",
        |ms, px| {
            let [x, y, z] = forward(px.unwrap_or([5.0, 5.0]));
            let status = if px.is_some() { 2 } else { 0 };
            format!("{},{},{status},{x:.9},{y:.9},{z:.9}", 1_000_000 * ms, 1_717_171_717_005_000_123 + 1_000_000 * ms)
        },
    );
    let varjo_tuples = table("raw_timestamp;status;gaze_forward", |ms, px| {
        let [x, y, z] = forward(px.unwrap_or([5.0, 5.0]));
        format!("{};{};({x:.9}, {y:.9}, {z:.9})", 1_000_000 * ms, if px.is_some() { 2 } else { 1 })
    });
    let sranipal = |time: &str, per_ms: u64, spaces: &str| {
        let names = format!(
            "{time},frame,eye_valid_L,eye_valid_R,gaze_direct_L.x,gaze_direct_L.y,gaze_direct_L.z,\
             gaze_direct_R.x,gaze_direct_R.y,gaze_direct_R.z"
        );
        table(&names, |ms, px| {
            // SRanipal's x points to the left.
            let [x, y, z] = forward(px.unwrap_or([5.0, 5.0]));
            let mask = if px.is_some() { 31 } else { 8 };
            format!("{},1,{mask},8,{:.9},{y:.9},{z:.9},0,0,0", per_ms * ms, -x)
        })
        .replace(',', spaces)
    };
    let report = table(
        "RECORDING_SESSION_LABEL\tTIMESTAMP\tLEFT_GAZE_X\tLEFT_GAZE_Y\tLEFT_IN_BLINK\tRIGHT_GAZE_X\tRIGHT_GAZE_Y\t\
         RIGHT_IN_BLINK",
        |ms, px| {
            let gaze = pair(px, ".").replace(',', "\t");
            format!("s1\t{}.00\t{gaze}\t0\t.\t.\t0", 2_091_650 + ms)
        },
    );
    let webgazer = table("x,y,t", |ms, px| format!("{},{:.1}", pair(px, "null"), ms as f64));
    // A logger of one's own: the name of its time has no unit, or one of several spellings.
    let plain = |names: &str, per_s: f64| {
        table(names, |ms, px| format!("{},{}", 3e3 * per_s + ms as f64 * per_s / 1e3, pair(px, "nan")))
    };
    vec![
        (Vendor::Tobii, "Pro Lab, us", pro_lab("\u{3bc}s", 1000)),
        (Vendor::Tobii, "Pro Lab, ms", pro_lab("ms", 1)),
        (Vendor::Tobii, "Pro Lab of a computer with decimal commas", pro_lab("\u{b5}s", 1000).replace('.', ",")),
        (Vendor::Tobii, "Studio", studio),
        (Vendor::Tobii, "SDK", sdk),
        (Vendor::Tobii, "SDK, tuples", sdk_tuples),
        (Vendor::Pupil, "Core", core),
        (Vendor::Pupil, "Core's surface", surface),
        (Vendor::Neon, "Neon", neon),
        (Vendor::Neon, "marker mapper", mapper),
        (Vendor::Gazepoint, "Analysis", gazepoint),
        (Vendor::Varjo, "Base", varjo),
        (Vendor::Varjo, "tuples", varjo_tuples),
        (Vendor::Sranipal, "ms", sranipal("time_stamp(ms)", 1, ",")),
        (Vendor::Sranipal, "100 ns, spaces", sranipal("time(100ns)", 10_000, "   ")),
        (Vendor::Sranipal, "no unit", sranipal("time", 1, "\t")),
        (Vendor::Eyelink, "sample report", report),
        (Vendor::Eyelink, "ASC", asc(false)),
        (Vendor::Eyelink, "ASC, binocular", asc(true)),
        (Vendor::Webgazer, "page", webgazer),
        (Vendor::Webgazer, "seconds", plain("Time,GazeX,GazeY", 1.0)),
        (Vendor::Webgazer, "microseconds", plain("timestamp,x,y", 1e6)),
        (Vendor::Webgazer, "nanoseconds", plain("timestamp,gaze_x,gaze_y", 1e9)),
        (Vendor::Webgazer, "seconds by name", plain("time [s],x,y", 1.0)),
        (Vendor::Webgazer, "microseconds by name", plain("timestamp_us,x,y", 1e6)),
    ]
}

/// The export of that writer.
fn export(name: &str) -> String {
    exports().into_iter().find(|export| export.1 == name).unwrap().2
}

/// EyeLink's text: numbers of a calibration, messages, a blink during which the pupil is still seen.
fn asc(is_binocular: bool) -> String {
    let eyes = if is_binocular { "LEFT\tRIGHT" } else { "RIGHT" };
    let mut text = format!(
        "** CONVERTED FROM a.edf using edfapi 4.2.1\n** TYPE: EDF_FILE BINARY EVENT SAMPLE TAGGED\n\nMSG\t2091650 \
         DISPLAY_COORDS 0 0 1919 1079\nMSG\t2135820 !CAL Cal coeff:(X=a+bx)\n   227.35 -1.5024  153.47\n\
         START\t2154556 \t{eyes}\tSAMPLES\tEVENTS\nPRESCALER\t1\nSAMPLES\tGAZE\t{eyes}\tRATE\t1000.00\tTRACKING\tCR\n"
    );
    for (ms, px) in GAZE {
        let t = 2_154_556 + ms;
        let side = if is_binocular { 'L' } else { 'R' };
        match px {
            Some([x, y]) if is_binocular => {
                writeln!(text, "{t}\t  {}\t  {y}\t  778.0\t  {}\t  {y}\t  778.0\t.....", x - 3.0, x + 3.0).unwrap();
            }
            Some([x, y]) => writeln!(text, "{t}\t  {x}\t  {y}\t  778.0\t    0.0\t...").unwrap(),
            None if is_binocular => {
                writeln!(text, "SBLINK L {t}\n{t}\t 900.0\t 900.0\t 3.0\t .\t .\t 0.0\t.....").unwrap()
            }
            None => writeln!(text, "SBLINK R {t}\n{t}\t 900.0\t 900.0\t 3.0\t...").unwrap(),
        }
        if px.is_none() {
            writeln!(text, "EBLINK {side} {t}\t{t}\t2\nMSG\t{t} TRIALID 1").unwrap();
        }
    }
    text + "END\t2154700 \tSAMPLES\tEVENTS\tRES\t  37.17\t  37.75\n"
}

fn read(text: &str, eye: Eye) -> GazeLog {
    parse_gaze_log("log", text.as_bytes(), &options(eye)).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

/// Whether a scanpath is [`GAZE`], to a hundredth of a pixel.
fn is_the_gaze(path: &Scanpath) -> bool {
    let agrees = |sample: &Sample, (ms, px): (u64, Option<[f64; 2]>)| {
        let is_there = match (sample.px, px) {
            (Some(a), Some(b)) => (0..2).all(|i| (f64::from(a[i]) - b[i]).abs() < 0.01),
            (a, b) => a.is_none() && b.is_none(),
        };
        is_there && sample.t_s == ms as f64 / 1e3
    };
    path.samples().len() == GAZE.len() && path.samples().iter().zip(GAZE).all(|(sample, gaze)| agrees(sample, gaze))
}

#[test]
fn every_vendors_export_is_the_gaze() {
    let mut vendors = vec![];
    for (vendor, writer, text) in exports() {
        let log = read(&text, Eye::Both);
        assert!(is_the_gaze(&log.scanpath), "{vendor:?}, {writer}: {:?}", log.scanpath.samples());
        assert_eq!((log.vendor, log.warnings), (Some(vendor), vec![]), "{writer}");
        assert_eq!(log.scanpath.screen().size_px, PX);
        let known = log.scanpath.screen().tangent_per_px().unwrap();
        assert!((known[0] - 531.0 / 1920.0 / 650.0).abs() < 1e-9, "{known:?}");
        // Asked for by name, it is the same; another vendor's name is refused in one line.
        let named =
            |from| parse_gaze_log("log", text.as_bytes(), &GazeLogOptions { from: Some(from), ..options(Eye::Both) });
        assert_eq!(named(vendor).unwrap().scanpath, log.scanpath);
        let other = if vendor == Vendor::Varjo { Vendor::Tobii } else { Vendor::Varjo };
        let error = named(other).unwrap_err().to_string();
        assert!(error.contains("expected the columns") && !error.contains('\n'), "{error}");
        vendors.push(vendor);
        // What is written is a scanpath that says the same.
        let written = super::csv(&log.scanpath);
        assert!(is_the_gaze(&parse_csv("log", &written).unwrap()), "{writer}");
    }
    assert!(Vendor::ALL.iter().all(|vendor| vendors.contains(vendor)));
}

#[test]
fn an_export_in_other_axes_or_units_is_not_the_gaze() {
    let planted = [
        // Another unit of time; ticks.
        export("Pro Lab, ms").replace("[ms]", "[\u{3bc}s]"),
        export("Analysis").replace("f=10000000", "f=1000000"),
        export("seconds by name").replace("[s]", "[ms]"),
        // A blink, and an eye that is not valid, that nobody marks.
        export("Neon").replace(",3,", ",,"),
        export("SDK, tuples").replace(";(nan, nan);0", ";(0.5, 0.5);1"),
    ];
    for text in planted {
        assert!(!is_the_gaze(&read(&text, Eye::Both).scanpath), "{text}");
    }
}

#[test]
fn one_eye_can_be_chosen_where_the_log_has_it() {
    for (text, dx) in [(export("SDK"), 0.01 * 1920.0), (export("ASC, binocular"), 3.0)] {
        for (eye, dx) in [(Eye::Left, -dx), (Eye::Right, dx)] {
            let seen = read(&text, eye).scanpath.samples()[0].px.unwrap();
            assert!((seen[0] - (960.0 + dx) as f32).abs() < 0.01 && (seen[1] - 790.0).abs() < 0.01, "{eye:?} {seen:?}");
        }
    }
    for name in ["Core", "ASC"] {
        let error = parse_gaze_log("log", export(name).as_bytes(), &options(Eye::Left)).unwrap_err().to_string();
        assert!(error.contains("no gaze of the left eye alone"), "{error}");
    }
}

#[test]
fn a_log_asks_for_the_screen_that_it_does_not_state() {
    let parse = |name: &str, options: GazeLogOptions| parse_gaze_log("log", export(name).as_bytes(), &options);
    let nothing = GazeLogOptions::default();
    for name in ["Pro Lab, us", "page", "sample report"] {
        let error = parse(name, nothing).unwrap_err().to_string();
        assert!(error.contains("does not state the size of the screen") && error.contains("`screen_px`"), "{error}");
    }
    // Shares of the screen need no size in pixels: they are stretched to the frame.
    for name in ["SDK", "Core", "Analysis", "marker mapper"] {
        let log = parse(name, nothing).unwrap();
        assert!(is_the_gaze(&log.scanpath), "{name}");
        let [warning] = &log.warnings[..] else { panic!("{:?}", log.warnings) };
        assert!(warning.contains("`screen_mm` and `distance_mm`"), "{warning}");
        assert_eq!(GazeMap::default_for(log.scanpath.screen()), GazeMap::Fit);
    }
    // Directions need no screen: angles are kept.
    for name in ["Base", "ms", "Neon"] {
        let log = parse(name, nothing).unwrap();
        assert_eq!((log.warnings.len(), log.scanpath.screen().size_px), (0, [2000, 2000]), "{name}");
        let slope = log.scanpath.screen().tangent_per_px().unwrap();
        let px = log.scanpath.samples()[1].px.unwrap();
        let [x, y, z] = forward([100.0, 60.0]);
        let tangent = [0, 1].map(|i| f64::from(px[i] - 1000.0) * slope[i]);
        assert!((tangent[0] - x / z).abs() < 1e-5 && (tangent[1] + y / z).abs() < 1e-5, "{tangent:?}");
        assert!(parse(name, GazeLogOptions { distance_mm: Some(600.0), ..nothing }).is_err());
    }
    // With the size of a picture alone, a scene camera's pixels count.
    let picture = parse("Neon", GazeLogOptions { screen_px: Some([1600, 1200]), ..nothing }).unwrap();
    assert_eq!(picture.scanpath.samples()[0], at(0.0, [1.0, 2.0]));
    // EyeLink's text and Pro Lab's may state it.
    assert_eq!(parse("ASC", nothing).unwrap().scanpath.screen().size_px, PX);
    let screen = "MSG\t1 !CMD 0 screen_phys_coord = -265.5, 149.5, 265.5, -149.5\n\
                  MSG\t1 !CMD 0 screen_distance = 640 660\nSTART\t";
    let logged = export("ASC").replace("START\t", screen);
    let log = parse_gaze_log("log", logged.as_bytes(), &nothing).unwrap();
    assert_eq!((log.scanpath.screen().size_cm, log.scanpath.screen().distance_cm), (Some([53.1, 29.9]), Some(65.0)));
    assert_eq!(log.warnings, [""; 0]);
    let stated = export("Pro Lab, us")
        .replace("Validity right", "Validity right\tRecording resolution width\tRecording resolution height")
        .replace("alid\n", "alid\t1920\t1080\n");
    assert!(is_the_gaze(&parse_gaze_log("log", stated.as_bytes(), &nothing).unwrap().scanpath));
}

#[test]
fn damaged_and_foreign_logs_are_refused_in_one_line() {
    let sdk = "device_time_stamp,left_gaze_point_on_display_area_x,left_gaze_point_on_display_area_y,\
     left_gaze_point_validity\n";
    let cases = [
        ("a,b,c\n1,2,3\n".to_owned(), "instead of the column names of a scanpath or of an eye tracker's export"),
        (format!("{sdk}0,0.5,0.5,1\n1000,half,0.5,1\n"), "log, line 3: left_gaze_point_on_display_area_x is \"half\""),
        (format!("{sdk}0,0.5,0.5,1\nsoon,0.5,0.5,1\n"), "line 3: the time is \"soon\""),
        (format!("{sdk}0,0.5,0.5,1\n1000,0.5,0.5,maybe\n"), "line 3: the validity is \"maybe\""),
        (format!("{sdk}0,0,5,0,5,1\n"), "line 2: 6 columns"),
        (format!("{sdk}5000000,0.5,0.5,1\n1000,0.5,0.5,1\n"), "it has several recordings"),
        (sdk.to_owned(), "there is no sample"),
        (format!("{sdk}0,nan,nan,0\n"), "lost in all 1 samples"),
        (asc(false).replace("SAMPLES\tGAZE", "SAMPLES\tHREF"), "the samples are \"HREF\""),
        (asc(false).replace("\t  778.0", "").replace("\t  790\t    0.0", ""), "is no sample"),
    ];
    for (text, expected) in cases {
        let error = parse_gaze_log("log", text.as_bytes(), &options(Eye::Both)).unwrap_err().to_string();
        assert!(error.contains(expected) && error.starts_with("log") && !error.contains('\n'), "{text}\n{error}");
    }
    // Samples a little out of order are sorted.
    let text = format!("{sdk}0,0.5,0.5,1\n2000,0.7,0.5,1\n1000,0.6,0.5,1\n");
    let log = read(&text, Eye::Both);
    let times: Vec<f64> = log.scanpath.samples().iter().map(|s| s.t_s).collect();
    assert_eq!(times, [0.0, 0.001, 0.002]);
    assert!(log.warnings[0].contains("1 samples out of order"), "{:?}", log.warnings);
}

fn named(list: &str, unit: GazeUnit, per_second: Option<f64>) -> GazeColumns {
    let of = |key: &str| list.split(',').find_map(|part| part.strip_prefix(key)).map(str::to_owned);
    let at = ["x=", "y=", "z="].into_iter().filter_map(of).collect();
    GazeColumns { time: of("t=").unwrap(), at, valid: of("valid="), unit, per_second }
}

#[test]
fn columns_that_are_named_are_the_gaze_in_every_unit() {
    let lost = |px: Option<[f64; 2]>| px.unwrap_or([5.0, 5.0]);
    let angles = |px| {
        let [x, y, z] = forward(lost(px));
        [x.atan2(z), y.asin()]
    };
    let valid = |px: Option<[f64; 2]>| u8::from(px.is_some());
    use GazeUnit::{Degrees, Pixels, Radians, Shares, Sphere};
    let cases = [
        (
            "t=Clock,x=POR X [px],y=POR Y [px]",
            Pixels,
            Some(1e6),
            // Events between the samples have text.
            table("## Sample Rate: 60\nClock\tType\tPOR X [px]\tPOR Y [px]", |ms, px| {
                let at = px.map_or("\t".into(), |[x, y]| format!("{x}\t{y}"));
                format!("{0}\tSMP\t{at}\n{0}\tMSG\t# Message: UE-keypress\t\n{0}\tMSG", 7_000_000 + 1000 * ms)
            }),
        ),
        (
            "t=n,x=x,y=y,valid=!val",
            Degrees,
            Some(1e3),
            table("n,x,y,val", |ms, px| {
                let [x, y] = angles(px).map(f64::to_degrees);
                format!("{ms},{x:.9},{y:.9},{}", 4 * (1 - valid(px)))
            }),
        ),
        (
            "t=tracking_timestamp_us,x=-yaw,y=pitch,valid=ok",
            Radians,
            None,
            table("tracking_timestamp_us,yaw,pitch,ok", |ms, px| {
                let [x, y] = angles(px);
                format!("{},{:.12},{y:.12},{}", 50_000_000 + 1000 * ms, -x, if px.is_some() { "True" } else { "False" })
            }),
        ),
        (
            "t=time,x=longitude,y=latitude",
            Sphere,
            None,
            table("time,longitude,latitude", |ms, px| {
                let [x, y] = angles(px).map(|v| if px.is_some() { v.to_degrees().to_string() } else { String::new() });
                format!("{},{x},{y}", ms as f64 / 1e3)
            }),
        ),
        (
            "t=t,x=u,y=-v,valid=conf",
            Shares,
            None,
            table("t,u,v,conf", |ms, px| {
                let [x, y] = share(lost(px));
                format!("{ms},{x:.9},{:.9},{}", 1.0 - y, if px.is_some() { "0.7" } else { "0" })
            }),
        ),
        (
            "t=eyeDataTimestamp,x=gazeDirection_x,y=gazeDirection_y,z=gazeDirection_z,valid=gazeHasValue",
            Pixels,
            Some(1e3),
            table("eyeDataTimestamp,gazeHasValue,gazeDirection_x,gazeDirection_y,gazeDirection_z", |ms, px| {
                let [x, y, z] = forward(lost(px));
                format!(
                    "{},{},{x:.9},{y:.9},{z:.9}",
                    1_600_000_000_000 + ms,
                    if px.is_some() { "True" } else { "False" }
                )
            }),
        ),
    ];
    for (list, unit, per_second, text) in cases {
        let columns = named(list, unit, per_second);
        let log = parse_gaze_columns("log", text.as_bytes(), &columns, &options(Eye::Both))
            .unwrap_or_else(|e| panic!("{list}: {e}"));
        assert!(is_the_gaze(&log.scanpath), "{list}: {:?}", log.scanpath.samples());
        let rows_of_text = text.matches("MSG").count();
        assert_eq!((log.vendor, log.warnings.len()), (None, usize::from(rows_of_text > 0)), "{:?}", log.warnings);
        // Another unit, or another column, is another gaze.
        let other = if unit == Degrees { Radians } else { Degrees };
        let wrong = GazeColumns { unit: other, ..columns.clone() };
        let wrong = parse_gaze_columns("log", text.as_bytes(), &wrong, &options(Eye::Both));
        assert!(list.contains("z=") || unit == Sphere || !wrong.is_ok_and(|log| is_the_gaze(&log.scanpath)), "{list}");
    }
}

#[test]
fn columns_that_cannot_be_are_refused_in_one_line() {
    let text = "t,u,v\n0,0.5,0.5\n10,half,x\n20,0.5,0.5\n";
    let read = |list, unit| {
        parse_gaze_columns("log", text.as_bytes(), &named(list, unit, None), &options(Eye::Both))
            .map_err(|e| e.to_string())
    };
    let error = read("t=t,x=u,y=w", GazeUnit::Shares).unwrap_err();
    assert!(error.contains("has no column \"w\"; it has t, u, v"), "{error}");
    let error = read("t=t,x=u,y=-v", GazeUnit::Pixels).unwrap_err();
    assert!(error.contains("pixels cannot be turned around"), "{error}");
    let error = read("t=t,x=u", GazeUnit::Shares).unwrap_err();
    assert!(error.contains("1 columns of gaze"), "{error}");
    let log = read("t=t,x=u,y=v", GazeUnit::Shares).unwrap();
    assert!(
        log.scanpath.samples().len() == 2 && log.warnings[0].contains("1 rows without numbers"),
        "{:?}",
        log.warnings
    );
    let recording = parse_gaze_log("log", b"SR_RESEARCH_COMBINED_FILE\0\0\x01\xff", &options(Eye::Both)).unwrap_err();
    assert!(recording.to_string().contains("convert it with edf2asc"), "{recording}");
}

/// Times of the clock on the wall, as loggers in Python and Unity write them.
#[test]
fn clock_times_are_read() {
    let minutes = |ms: u64| format!("{:02}:{:02}.{:03}", 59 + ms / 1000, ms / 1000 % 60, ms % 1000);
    for (names, before, after) in [
        ("timestamp,x,y", "2021-04-05T12:", "Z"),
        ("time,gaze_x,gaze_y", "2021-04-05 12:", "+02:00"),
        ("timestamp;x;y", "23:", ""),
    ] {
        let text = table(&names.replace(';', ","), |ms, px| {
            let at = px.map_or("nan,nan".into(), |[x, y]| format!("{x},{y}"));
            format!("{before}{}{after},{at}", minutes(ms))
        });
        assert!(is_the_gaze(&read(&text, Eye::Both).scanpath), "{text}");
    }
    let error = parse_gaze_log("log", b"timestamp,x,y\n12:00:00,1,2\nsoon,1,2\n", &options(Eye::Both));
    let error = error.unwrap_err().to_string();
    assert!(error.contains("line 3: the time is \"soon\"") && error.contains("2021-04-05T12:00:00"), "{error}");
}
