//! Camera files of other programs on the command line.

use super::rig::{Folder, Out, refuses, succeeds, words};

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

/// The bytes of a scene's picture by a camera.
fn picture(camera: &str, more: &str) -> Vec<u8> {
    let line = format!("trace builtin:cubes --size 24x16 --spp 1 --backend cpu --format exr --camera {camera} {more}");
    Out::of(&words(&line)).bytes("color/000000.exr")
}

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
        let picture = picture(&file, "");
        assert!(*first.get_or_insert_with(|| picture.clone()) == picture, "{kind}");
    }
    // COLMAP: two files, a world with y down, and images in the order of their names.
    folder.write("cameras.txt", b"# models\n4 PINHOLE 100 50 86.60254037844387 86 50 25\n");
    let colmap = folder.write("images.txt", b"# images\n9 1 0 0 0 0 1 4 4 0.png\n1 2 3\n");
    let said = succeeds(&["info", &colmap]);
    assert!(said.starts_with("camera file: images.txt of COLMAP\nframes: 1, all alike\n"), "{said}");
    assert!(said.contains("(y up): 0.0000, 1.0000, 4.0000\nit looks along: 0.0000, 0.0000, -1.0000\n"), "{said}");
    assert!(picture(&colmap, "") == *first.as_ref().unwrap());
    // Planted: half of the field of view is another picture.
    let other = folder.write("other.json", FILES[0].1.replace("60", "30").as_bytes());
    assert!(picture(&other, "") != first.unwrap());
    let bad = folder.write("bad.json", br#"{"path":[]}"#);
    refuses(&["info", &bad], &["bad.json", "has no camera", "transforms.json"]);
    refuses(&["trace", "builtin:cubes", "--camera", &bad, "--out", &folder.text("bad")], &["bad.json", "nerfstudio"]);
}

/// The first camera of another scene, which may move. Its own geometry is not shown.
#[test]
fn a_camera_may_be_that_of_another_scene() {
    let folder = Folder::new();
    let other = r#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
        "nodes":[{"camera":0,"translation":[0,1,4]}],
        "cameras":[{"type":"perspective","perspective":{"yfov":0.7,"znear":0.1}}]}"#;
    let other = folder.write("other.GLTF", other.as_bytes());
    let own = folder.write("own.json", FILES[0].1.as_bytes());
    assert!(picture(&other, "--hfov 60") == picture(&own, "--hfov 60"));
    let none = folder.write("none.gltf", br#"{"asset":{"version":"2.0"}}"#);
    refuses(&["trace", "builtin:cubes", "--camera", &none, "--out", &folder.text("c")], &["none.gltf", "no camera"]);
    let missing = folder.text("missing.glb");
    refuses(&["trace", "builtin:cubes", "--camera", &missing, "--out", &folder.text("c")], &["missing.glb", "exist"]);
}
