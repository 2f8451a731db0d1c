//! Options whose values are those of an enum of the library.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};

/// An enum whose values have names on the command line.
pub trait Named: Copy + PartialEq + Send + Sync + 'static {
    /// All values in the order of `--help`, each with its name and its text in `--help`.
    fn rows() -> Vec<(Self, &'static str, &'static str)>;

    /// Name on the command line and in reports, and name of folders.
    fn name(self) -> &'static str {
        let row = Self::rows().into_iter().find(|row| row.0 == self);
        row.expect("every value has a row").1
    }
}

/// Parser of the names of an enum: `#[arg(value_parser = by_name::<T>())]`.
pub fn by_name<T: Named>() -> impl TypedValueParser<Value = T> {
    let names = T::rows().into_iter().map(|(_, name, help)| PossibleValue::new(name).help(help));
    PossibleValuesParser::new(names).map(|given| {
        let row = T::rows().into_iter().find(|row| row.1 == given);
        row.expect("other names are refused before").0
    })
}
