//! Laws of hard cases that executors share, as tests: `laws! { Cpu, run_law, test: "H51", law; }`, with a row or
//! several. `run_law` runs a law on the executor and returns what it measured, or `None` without one.

macro_rules! laws {
    ($side:ident, $run_law:ident, $($test:ident: $($row:literal),+, $law:ident;)*) => {$(
        #[test]
        fn $test() {
            let Some(figure) = $run_law($law) else { return };
            $(afterimage_testing::holds!($row, $side, "{figure}");)+
        }
    )*};
}
pub(crate) use laws;
