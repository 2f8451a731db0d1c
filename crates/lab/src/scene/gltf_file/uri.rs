//! URIs in a scene: data URIs, and files in the scene's folder.

use super::errors::printable;
use crate::error::InputError;
use base64::Engine;
use base64::alphabet;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use std::path::{Component, Path, PathBuf};

/// Base64 with or without padding: files have both.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &alphabet::STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);

/// Target of a URI.
#[derive(Debug)]
pub(super) enum Resolved {
    Data(Vec<u8>),
    /// Canonical path of an existing file inside the folder, symbolic links resolved.
    File(PathBuf),
}

/// Resolves a URI against the scene's folder.
///
/// # Errors
/// `NotSupported` if it leads, or could lead, out of the folder; `Io` if there is no such file; `Invalid` if its data
/// is damaged.
pub(super) fn resolve(subject: &str, folder: &Path, uri: &str) -> Result<Resolved, InputError> {
    let damaged = |problem: &str| {
        InputError::invalid(subject, format!("the URI \"{}\" {problem}", printable(uri)), "export the scene again")
    };
    if let Some(rest) = uri.strip_prefix("data:") {
        let (kind, data) = rest.split_once(',').ok_or_else(|| damaged("has no data"))?;
        let data = percent_decoded(data).ok_or_else(|| damaged("is not percent-encoded data"))?;
        if !kind.ends_with(";base64") {
            return Ok(Resolved::Data(data));
        }
        let data: Vec<u8> = data.into_iter().filter(|byte| !byte.is_ascii_whitespace()).collect();
        let data = BASE64.decode(data).map_err(|_| damaged("is not base64 data"))?;
        return Ok(Resolved::Data(data));
    }
    let refused = |problem: &str| {
        InputError::not_supported(
            subject,
            format!("it refers to \"{}\", which {problem}", printable(uri)),
            "a scene may only read files in its own folder; copy them there",
        )
    };
    // A name may be written as it is, with percent signs that are no escapes, and with the separators of Windows.
    let decoded = percent_decoded(uri).and_then(|bytes| String::from_utf8(bytes).ok());
    let mut first_error = None;
    for name in decoded.as_deref().into_iter().chain([uri]) {
        let found = file(subject, folder, uri, &name.replace('\\', "/"), &refused);
        match found {
            Ok(path) => return Ok(Resolved::File(path)),
            Err(error) => _ = first_error.get_or_insert(error),
        }
    }
    Err(first_error.expect("the URI itself was tried"))
}

/// Canonical path of the file of a relative path.
fn file(
    subject: &str,
    folder: &Path,
    uri: &str,
    name: &str,
    refused: &dyn Fn(&str) -> InputError,
) -> Result<PathBuf, InputError> {
    if name.is_empty() || name.contains('\0') {
        let problem = format!("the URI \"{}\" names no file", printable(uri));
        return Err(InputError::invalid(subject, problem, "export the scene again"));
    }
    // A colon marks a scheme or, on Windows, a drive or a stream.
    if name.contains(':') {
        return Err(refused("has a scheme or a drive"));
    }
    let relative = Path::new(name);
    for part in relative.components() {
        match part {
            Component::Normal(_) | Component::CurDir => {}
            Component::ParentDir => return Err(refused("goes up a folder")),
            Component::RootDir | Component::Prefix(_) => return Err(refused("is an absolute path")),
        }
    }
    let missing = |e: std::io::Error| {
        InputError::io(
            subject,
            format!("it refers to \"{}\", which cannot be read: {e}", printable(uri)),
            "put the file where the scene expects it",
        )
    };
    let folder = folder.canonicalize().map_err(missing)?;
    let path = folder.join(relative).canonicalize().map_err(missing)?;
    if !path.starts_with(&folder) {
        return Err(refused("is a link out of the folder"));
    }
    Ok(path)
}

/// Percent-decoded bytes; `None` if an escape is not hexadecimal.
fn percent_decoded(text: &str) -> Option<Vec<u8>> {
    let mut bytes = text.bytes();
    let mut decoded = Vec::with_capacity(text.len());
    let digit = |b: Option<u8>| char::from(b?).to_digit(16).map(|d| d as u8);
    while let Some(byte) = bytes.next() {
        decoded.push(match byte {
            b'%' => digit(bytes.next())? << 4 | digit(bytes.next())?,
            other => other,
        });
    }
    Some(decoded)
}
