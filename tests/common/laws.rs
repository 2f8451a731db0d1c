//! Laws of hard cases that executors share, as tests: `laws! { Cpu, held, test: "H51", law; }`. `held` runs a law on
//! the executor and returns what it measured, or `None` without one.

macro_rules! laws {
    ($side:ident, $held:ident, $($test:ident: $row:literal, $law:ident;)*) => {$(
        #[test]
        fn $test() {
            let Some(figure) = $held($law) else { return };
            holds!($row, $side, "{figure}");
        }
    )*};
}
pub(crate) use laws;
