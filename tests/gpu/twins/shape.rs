//! Values in words: how a row of a probe holds them, how WGSL reads and writes them, and the call of a function on both
//! sides from the types of its Rust twin.

pub use super::probe::{Out, Row};
use glam::{Vec2, Vec3, Vec3A, Vec4};

/// A value in words.
pub trait Shape: Sized {
    const WORDS: usize;
    /// Name of a WGSL scalar, whose arrays are vectors there.
    const SCALAR: Option<&'static str> = None;
    fn read(row: &Row<'_>, at: usize) -> Self;
    fn write(&self, out: &mut Out);
    /// WGSL expression of the value at a word; several arguments for an array of vectors or structs.
    fn wgsl_read(at: usize) -> String;
    /// WGSL statements that write the value of an expression.
    fn wgsl_write(value: &str) -> String;
}

/// Types that the harness of a probe reads and writes by one call.
macro_rules! plain {
    ($($type:ty: $words:literal, $scalar:expr, $read:expr, $write:expr, $wgsl_read:literal, $wgsl_write:literal;)*) => {$(
        impl Shape for $type {
            const WORDS: usize = $words;
            const SCALAR: Option<&'static str> = $scalar;
            fn read(row: &Row<'_>, at: usize) -> Self {
                let read: fn(&Row<'_>, usize) -> $type = $read;
                read(row, at)
            }
            fn write(&self, out: &mut Out) {
                let write: fn(&mut Out, $type) = $write;
                write(out, *self);
            }
            fn wgsl_read(at: usize) -> String {
                format!($wgsl_read, at)
            }
            fn wgsl_write(value: &str) -> String {
                format!($wgsl_write, value)
            }
        }
    )*};
}

plain! {
    f32: 1, Some("f32"), |r, at| r.f(at), |o, x| o.f(x), "in_f({}u)", "out_f({});";
    u32: 1, Some("u32"), |r, at| r.u(at), |o, x| o.u(x), "in_u({}u)", "out_u({});";
    i32: 1, Some("i32"), |r, at| r.u(at) as i32, |o, x| o.u(x as u32), "bitcast<i32>(in_u({}u))", "out_u(bitcast<u32>({}));";
    bool: 1, None, |r, at| r.u(at) != 0, |o, x| o.b(x), "in_u({}u) != 0u", "out_b({});";
    Vec3: 3, None, |r, at| r.v(at), |o, x| o.v(x), "in_v({}u)", "out_v({});";
    Vec3A: 3, None, |r, at| r.v(at).into(), |o, x| o.v(x.into()), "in_v({}u)", "out_v({});";
}

impl<T: Shape, const N: usize> Shape for [T; N] {
    const WORDS: usize = N * T::WORDS;
    fn read(row: &Row<'_>, at: usize) -> Self {
        std::array::from_fn(|i| T::read(row, at + i * T::WORDS))
    }
    fn write(&self, out: &mut Out) {
        self.iter().for_each(|x| x.write(out));
    }
    fn wgsl_read(at: usize) -> String {
        let elements = (0..N).map(|i| T::wgsl_read(at + i * T::WORDS)).collect::<Vec<_>>().join(", ");
        T::SCALAR.map_or(elements.clone(), |scalar| format!("vec{N}<{scalar}>({elements})"))
    }
    fn wgsl_write(value: &str) -> String {
        let part = |i: usize| if T::SCALAR.is_some() { format!(".{}", &"xyzw"[i..=i]) } else { format!("[{i}]") };
        (0..N).map(|i| T::wgsl_write(&(value.to_owned() + &part(i)))).collect()
    }
}

/// Types that are arrays in words.
macro_rules! as_array {
    ($($type:ty: $array:ty;)*) => {$(
        impl Shape for $type {
            const WORDS: usize = <$array>::WORDS;
            fn read(row: &Row<'_>, at: usize) -> Self {
                <$array>::read(row, at).into()
            }
            fn write(&self, out: &mut Out) {
                <$array>::from(*self).write(out);
            }
            fn wgsl_read(at: usize) -> String {
                <$array>::wgsl_read(at)
            }
            fn wgsl_write(value: &str) -> String {
                <$array>::wgsl_write(value)
            }
        }
    )*};
}

impl Shape for u64 {
    const WORDS: usize = 2;
    fn read(row: &Row<'_>, at: usize) -> Self {
        u64::from(row.u(at)) | u64::from(row.u(at + 1)) << 32
    }
    fn write(&self, out: &mut Out) {
        [*self as u32, (*self >> 32) as u32].write(out);
    }
    fn wgsl_read(at: usize) -> String {
        <[u32; 2]>::wgsl_read(at)
    }
    fn wgsl_write(value: &str) -> String {
        <[u32; 2]>::wgsl_write(value)
    }
}

as_array! {
    Vec2: [f32; 2];
    Vec4: [f32; 4];
}

/// Several arguments; as a result, a struct with names in WGSL, which its probe writes by `out_` calls.
macro_rules! tuple {
    ($($part:ident $i:tt)*) => {
        impl<$($part: Shape),*> Shape for ($($part,)*) {
            const WORDS: usize = 0 $(+ $part::WORDS)*;
            fn read(row: &Row<'_>, mut at: usize) -> Self {
                ($(next::<$part>(row, &mut at),)*)
            }
            fn write(&self, out: &mut Out) {
                $(self.$i.write(out);)*
            }
            fn wgsl_read(mut at: usize) -> String {
                [$(spelled::<$part>(&mut at)),*].join(", ")
            }
            fn wgsl_write(_: &str) -> String {
                unimplemented!("fields of a tuple have no names in WGSL")
            }
        }
    };
}

tuple!(A 0 B 1);
tuple!(A 0 B 1 C 2);
tuple!(A 0 B 1 C 2 D 3);

/// A code of the kernel, whose variants are 0, 1 ...
macro_rules! code {
    ($type:ty: $($variant:ident),*) => {
        impl Shape for $type {
            const WORDS: usize = 1;
            fn read(row: &Row<'_>, at: usize) -> Self {
                let code = [$(<$type>::$variant),*][row.u(at) as usize];
                assert_eq!(code as u32, row.u(at));
                code
            }
            fn write(&self, out: &mut Out) {
                out.u(*self as u32);
            }
            fn wgsl_read(at: usize) -> String {
                u32::wgsl_read(at)
            }
            fn wgsl_write(value: &str) -> String {
                u32::wgsl_write(value)
            }
        }
    };
}
pub(crate) use code;

/// A struct of the kernel: fields in the order of WGSL, `as` whose name there where it is another.
macro_rules! shape {
    ($type:path $(as $wgsl:literal)? { $($field:ident $(as $other:literal)?: $part:ty),* $(,)? }) => {
        impl Shape for $type {
            const WORDS: usize = 0 $(+ <$part as Shape>::WORDS)*;
            #[allow(unused_assignments, reason = "the place after the last field")]
            fn read(row: &Row<'_>, mut at: usize) -> Self {
                $(let $field = next::<$part>(row, &mut at);)*
                Self { $($field),* }
            }
            fn write(&self, out: &mut Out) {
                $(Shape::write(&self.$field, out);)*
            }
            fn wgsl_read(mut at: usize) -> String {
                let fields = [$(spelled::<$part>(&mut at)),*];
                let name = [$($wgsl,)? stringify!($type)][0];
                format!("{}({})", name.rsplit("::").next().unwrap(), fields.join(", "))
            }
            fn wgsl_write(value: &str) -> String {
                let fields = [$(
                    <$part as Shape>::wgsl_write(
                        &format!("{value}.{}", [$($other,)? stringify!($field)][0])
                    )
                ),*];
                fields.concat()
            }
        }
    };
}
pub(crate) use shape;

/// The value at a place, which moves behind it.
pub fn next<T: Shape>(row: &Row<'_>, at: &mut usize) -> T {
    *at += T::WORDS;
    T::read(row, *at - T::WORDS)
}

/// The WGSL expression of the value at a place, which moves behind it.
pub fn spelled<T: Shape>(at: &mut usize) -> String {
    *at += T::WORDS;
    T::wgsl_read(*at - T::WORDS)
}

/// A Rust function whose arguments are a row and whose result is output.
pub trait Twin<Arguments> {
    /// Words of the arguments and of the result.
    const WORDS: [usize; 2];
    fn run(&self, row: &Row<'_>, out: &mut Out);
    /// WGSL statements of `call`: see `probe!`.
    fn wgsl(&self, call: &str) -> String;
}

macro_rules! twin {
    ($($argument:ident)*) => {
        impl<Function: Fn($($argument),*) -> Output, Output: Shape, $($argument: Shape),*> Twin<($($argument,)*)>
            for Function
        {
            const WORDS: [usize; 2] = [0 $(+ $argument::WORDS)*, Output::WORDS];
            #[allow(unused, reason = "without arguments")]
            fn run(&self, row: &Row<'_>, out: &mut Out) {
                let mut at = 0;
                self($(next::<$argument>(row, &mut at)),*).write(out);
            }
            #[allow(unused, reason = "without arguments")]
            fn wgsl(&self, call: &str) -> String {
                let mut at = 0;
                statements::<Output>(call, &[$(spelled::<$argument>(&mut at)),*])
            }
        }
    };
}

twin!();
twin!(A);
twin!(A B);
twin!(A B C);
twin!(A B C D);
twin!(A B C D E);
twin!(A B C D E F);
twin!(A B C D E F G);
twin!(A B C D E F G H);
twin!(A B C D E F G H I);
twin!(A B C D E F G H I J);

fn statements<Output: Shape>(call: &str, arguments: &[String]) -> String {
    if !call.contains('(') {
        return statements::<Output>(&format!("{call}({})", arguments.join(", ")), &[]);
    }
    let spelled = arguments.iter().enumerate().rev().fold(call.to_owned(), |c, (i, a)| c.replace(&format!("${i}"), a));
    if spelled.contains("out_") {
        return spelled;
    }
    let (before, value) = spelled.rsplit_once(';').unwrap_or(("", &spelled));
    format!("{before}; let result = {value}; {}", Output::wgsl_write("result"))
}
