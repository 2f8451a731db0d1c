//! Camera files of other programs on the command line.

use super::rig::{Folder, refuses, succeeds};
use std::fs;

/// The camera at (0, -4, 1) that looks along +y, in Blender's axes, in the form of each program.
const FILES: [(&str, &str); 4] = [
    (
        "cameras.json",
        r#"{"fps":24,"horizontal_fov_deg":60,"frames":[{"camera_to_world":[[2,0,0,0],[0,0,-2,-4],[0,2,0,1]]}]}"#,
    ),
    (
        "transforms.json of NeRF",
        r#"{"camera_angle_x":1.0471975511965976,"frames":[{"file_path":"./r_0","transform_matrix":[[1,0,0,0],[0,0,-1,-4],[0,1,0,1],[0,0,0,1]]}]}"#,
    ),
    (
        "camera path of nerfstudio",
        r#"{"camera_type":"perspective","render_width":100,"render_height":100,"fps":24,"keyframes":[],"camera_path":[{"camera_to_world":[1,0,0,0,0,0,-1,-4,0,1,0,1,0,0,0,1],"fov":60,"aspect":1}]}"#,
    ),
    (
        "cameras.json of 3D Gaussian splatting",
        r#"[{"id":0,"width":100,"height":50,"position":[0,-4,1],"rotation":[[1,0,0],[0,0,1],[0,-1,0]],"fx":86.60254037844387,"fy":86}]"#,
    ),
];

#[test]
fn camera_files_of_other_programs_show_the_same_picture() {
    let folder = Folder::new();
    let mut first = None;
    for (i, (kind, text)) in FILES.iter().enumerate() {
        let file = folder.write(&format!("{i}.JSON"), text.as_bytes());
        let said = succeeds(&["info", &file]);
        for line in [
            &format!("camera file: {kind}\nframes: 1, all alike\n")[..],
            "horizontal field of view, degrees: 60\n",
            "first camera, m, in the scene's axes (y up): 0.0000, 1.0000, 4.0000\n",
            "it looks along: 0.0000, 0.0000, -1.0000\n",
        ] {
            assert!(said.contains(line), "{said}");
        }
        let out = folder.text(&format!("out{i}"));
        let size = ["--size", "24x16", "--spp", "1", "--backend", "cpu", "--format", "exr"];
        succeeds(&[&["trace", "builtin:cubes", "--camera", &file, "--out", &out][..], &size].concat());
        let picture = fs::read(format!("{out}/color/000000.exr")).unwrap();
        assert!(*first.get_or_insert_with(|| picture.clone()) == picture, "{kind}");
    }
    // Planted: half of the field of view is another picture.
    let other = folder.write("other.json", FILES[0].1.replace("60", "30").as_bytes());
    let out = folder.text("other");
    let size = ["--size", "24x16", "--spp", "1", "--backend", "cpu", "--format", "exr"];
    succeeds(&[&["trace", "builtin:cubes", "--camera", &other, "--out", &out][..], &size].concat());
    assert!(fs::read(format!("{out}/color/000000.exr")).unwrap() != first.unwrap());
    let bad = folder.write("bad.json", br#"{"path":[]}"#);
    refuses(&["info", &bad], &["bad.json", "has no camera", "transforms.json"]);
    refuses(&["trace", "builtin:cubes", "--camera", &bad, "--out", &folder.text("bad")], &["bad.json", "nerfstudio"]);
}
