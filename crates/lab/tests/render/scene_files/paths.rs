//! URIs: a scene may read its own data and files in its own folder.

use super::builder::{Gltf, TRIANGLE, Written, png};
use super::{assert_refused, assert_sound, open};
use base64::Engine;
use serde_json::json;

/// A folder `scene/` with a `scene.gltf` of one triangle, whose buffer has that URI.
fn with_buffer(address: &str) -> (Written, Vec<u8>) {
    let mut file = Gltf::of(&TRIANGLE);
    file.json["buffers"] = json!([{"byteLength": file.bin.len(), "uri": address}]);
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("scene")).unwrap();
    let path = folder.path().join("scene/scene.gltf");
    std::fs::write(&path, file.json.to_string()).unwrap();
    // A file outside of the scene's folder.
    std::fs::write(folder.path().join("secret.bin"), &file.bin).unwrap();
    (Written { folder, path }, file.bin)
}

/// Under percent-encoded names, and under names as they are written: percent signs that are no escapes, names that look
/// like escapes, and the separators of Windows.
#[test]
fn files_in_the_folder_are_read() {
    for (address, name) in [
        ("a.bin", "a.bin"),
        ("my%20data/%C3%A4.bin", "my data/ä.bin"),
        ("./b.bin", "b.bin"),
        ("c..bin", "c..bin"),
        ("example 10%.bin", "example 10%.bin"),
        ("100%sure.bin", "100%sure.bin"),
        ("a%20b.bin", "a%20b.bin"),
        ("data\\a.bin", "data/a.bin"),
        (".\\data\\my%20a.bin", "data/my a.bin"),
        ("data%5ca.bin", "data/a.bin"),
    ] {
        let (written, bytes) = with_buffer(address);
        let target = written.folder.path().join("scene").join(name);
        std::fs::create_dir_all(target.parent().unwrap()).unwrap();
        std::fs::write(target, bytes).unwrap();
        let scene = open(&written.path).unwrap();
        assert_sound(&scene);
        assert_eq!(scene.still().len(), 1, "{address}");
    }
}

#[test]
fn data_addresses_are_read_with_and_without_padding() {
    let (_, bytes) = with_buffer("");
    let padded = base64::engine::general_purpose::STANDARD.encode(&bytes);
    let percent: String = bytes.iter().map(|b| format!("%{b:02x}")).collect();
    for address in [
        format!("data:application/octet-stream;base64,{padded}"),
        format!("data:;base64,{}", padded.trim_end_matches('=')),
        format!("data:application/gltf-buffer,{percent}"),
        format!("data:;base64, {}\n\t{} \r\n", &padded[..8], &padded[8..]),
        format!("data:;base64,{}", padded.replace('=', "%3D").replace('+', "%2B").replace('/', "%2F")),
    ] {
        assert_eq!(open(&with_buffer(&address).0.path).unwrap().still().len(), 1);
    }
    for address in ["data:", "data:;base64,!!!", "data:;base64", "data:,%zz", "data:;base64,AAAA"] {
        assert_refused(&with_buffer(address).0.path, &["export the scene again"]);
    }
}

#[test]
fn addresses_that_leave_the_folder_are_refused() {
    let parents = ["../secret.bin", "..", "./../secret.bin", "sub/../../secret.bin", "..\\secret.bin"];
    let elsewhere = ["/etc/passwd", "C:/secret.bin", "//host/share.bin", "file:///etc/passwd", "http://host/a.bin"];
    let escaped =
        ["%2e%2e/secret.bin", "%2E%2E%2Fsecret.bin", "%2fetc%2fpasswd", "file%3A///etc/passwd", "%5c%5chost%5cshare"];
    for address in [parents, elsewhere, escaped].concat() {
        let (written, _) = with_buffer(address);
        // The file exists, so that only the check prevents reading it.
        std::fs::create_dir(written.folder.path().join("scene/sub")).unwrap();
        assert_refused(&written.path, &["its own folder"]);
    }
}

#[cfg(unix)]
#[test]
fn links_out_of_the_folder_are_refused_and_links_inside_are_not() {
    use std::os::unix::fs::symlink;
    let (written, bytes) = with_buffer("link.bin");
    let scene = written.folder.path().join("scene");
    symlink(written.folder.path().join("secret.bin"), scene.join("link.bin")).unwrap();
    assert_refused(&written.path, &["link out of the folder"]);
    std::fs::remove_file(scene.join("link.bin")).unwrap();
    // A link to an outer folder.
    let (through, _) = with_buffer("sub/secret.bin");
    symlink(through.folder.path(), through.folder.path().join("scene/sub")).unwrap();
    assert_refused(&through.path, &["link out of the folder"]);
    std::fs::write(scene.join("real.bin"), bytes).unwrap();
    symlink("real.bin", scene.join("link.bin")).unwrap();
    assert!(open(&written.path).is_ok());
}

#[cfg(unix)]
#[test]
fn what_is_no_file_is_not_read() {
    // A folder; an endless device is refused in the same way.
    let (written, _) = with_buffer("sub");
    std::fs::create_dir(written.folder.path().join("scene/sub")).unwrap();
    assert_refused(&written.path, &["is not a file"]);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.glb");
    std::os::unix::fs::symlink("/dev/zero", &path).unwrap();
    assert_refused(&path, &["is not a file"]);
}

#[test]
fn missing_buffers_and_textures_are_named() {
    assert_refused(&with_buffer("gone.bin").0.path, &["gone.bin"]);
    let mut file = Gltf::with_material(json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}));
    file.push("images", json!({"uri": "gone.png"}));
    file.push("textures", json!({"source": 0}));
    file.assert_refused(&["gone.png"]);
    // Unused textures are not read.
    file.json["materials"] = json!([{}]);
    assert_eq!(file.open().textures.len(), 0);
    // It is found in the folder, and in a data URI.
    file.json["materials"] = json!([{"emissiveTexture": {"index": 0}}]);
    let written = file.written();
    std::fs::write(written.folder.path().join("gone.png"), png([2, 2], |_, _| [9; 4])).unwrap();
    assert_eq!(open(&written.path).unwrap().textures[0].texels, [[9; 4]; 4]);
}
