//! Tests that measure their process, its memory or its CPU time: tests beside them would be measured, too.

use std::process::{Command, Stdio};

/// Name of the environment variable with the test that a process was started for.
const ALONE: &str = "AFTERIMAGE_TEST_ALONE";

/// Runs the body of the calling test in a process of its own: this program again, for this test only. Call it first,
/// from the test's thread.
///
/// # Panics
/// If the test fails there, or the program has no test of this thread's name.
#[track_caller]
pub fn alone(body: impl FnOnce()) {
    let name = std::thread::current().name().expect("tests have named threads").to_owned();
    if std::env::var(ALONE).is_ok_and(|test| test == name) {
        return body();
    }
    let program = std::env::current_exe().expect("the path of this program");
    let output = Command::new(program)
        .args(["--exact", &name, "--include-ignored", "--nocapture", "--test-threads=1"])
        .env(ALONE, &name)
        // Skips are said there.
        .stderr(Stdio::inherit())
        .output()
        .expect("this program starts again");
    let said = String::from_utf8_lossy(&output.stdout);
    println!("{said}");
    assert!(output.status.success() && said.contains("test result: ok. 1 passed"), "{name}, in a process of its own");
}

#[cfg(test)]
mod tests {
    use super::{ALONE, alone};
    use std::panic::{catch_unwind, resume_unwind};
    use std::sync::atomic::{AtomicU32, Ordering};

    static VISITS: AtomicU32 = AtomicU32::new(0);

    fn visit() {
        assert_eq!(VISITS.fetch_add(1, Ordering::Relaxed), 0, "another test was here");
    }

    #[test]
    fn tests_share_nothing() {
        alone(visit);
    }

    #[test]
    fn not_even_a_static() {
        alone(visit);
    }

    #[test]
    fn a_test_that_fails_there_fails() {
        let outcome = catch_unwind(|| alone(|| resume_unwind(Box::new("planted"))));
        if std::env::var_os(ALONE).is_some() {
            resume_unwind(outcome.unwrap_err());
        }
        assert!(outcome.is_err());
    }

    #[test]
    fn a_name_that_no_test_has_fails() {
        let thread = std::thread::Builder::new().name("no test".to_owned());
        assert!(thread.spawn(|| alone(|| ())).unwrap().join().is_err());
    }
}
