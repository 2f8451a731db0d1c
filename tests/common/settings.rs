//! Settings that many tests share.

use afterimage::internal::{Method, MethodKind, Settings, Wrs};

/// wrs with these settings.
pub fn wrs(wrs: Wrs) -> Settings {
    Settings { method: Method::Wrs(wrs), ..Settings::default() }
}

/// wrs without a gate.
pub fn ungated() -> Settings {
    ungated_of(MethodKind::Wrs)
}

/// A method without a gate, so that only the test in question rejects history.
pub fn ungated_of(kind: MethodKind) -> Settings {
    match kind {
        MethodKind::Wrs => wrs(Wrs { gate: None, ..Wrs::default() }),
        kind => Settings { method: kind.into(), ..Settings::default() },
    }
}
