//! Shaders contain no arithmetic that compilers compute in another order than it is written: rule 6 of
//! `shaders/README.md`, read from the WGSL.

use super::library::SHADERS;
use super::modules::composed_modules;
use afterimage::shader::Composed;
use afterimage::wgpu::naga;
use naga::{
    BinaryOperator as Op, Block, Expression as E, Function, Handle, Literal, MathFunction, Module, Scalar, ScalarKind,
    Statement, TypeInner, UnaryOperator,
};
use std::collections::{BTreeSet, HashMap, HashSet};

/// A function whose expressions are examined.
struct Reader<'a> {
    module: &'a Module,
    function: &'a Function,
}

impl Reader<'_> {
    /// Components of a constant float; NaN where an override sets it.
    fn constant(&self, of: Handle<E>) -> Option<Vec<f32>> {
        constant_in(self.module, &self.function.expressions, of)
    }

    /// Whether an expression is a constant, the product with which is rounded.
    fn rounds(&self, of: Handle<E>) -> bool {
        self.constant(of).is_some_and(|c| c.iter().any(|x| !is_power_of_two(*x)))
    }

    /// Operands of an expression, if its operator is `op`.
    fn operands(&self, of: Handle<E>, ops: &[Op]) -> Option<[Handle<E>; 2]> {
        match self.function.expressions[of] {
            E::Binary { op, left, right } if ops.contains(&op) => Some([left, right]),
            _ => None,
        }
    }

    /// Whether two expressions are written alike.
    fn same(&self, a: Handle<E>, b: Handle<E>) -> bool {
        let expressions = &self.function.expressions;
        a == b
            || match (&expressions[a], &expressions[b]) {
                (E::AccessIndex { base, index }, E::AccessIndex { base: b, index: i }) => {
                    index == i && self.same(*base, *b)
                }
                (E::Load { pointer }, E::Load { pointer: p }) => self.same(*pointer, *p),
                (E::LocalVariable(a), E::LocalVariable(b)) => a == b,
                (E::GlobalVariable(a), E::GlobalVariable(b)) => a == b,
                (E::FunctionArgument(a), E::FunctionArgument(b)) => a == b,
                _ => false,
            }
    }

    /// What a compiler may rewrite in one expression.
    fn fault(&self, of: Handle<E>) -> Option<&'static str> {
        let (product, quotient) = (&[Op::Multiply][..], &[Op::Divide][..]);
        let (sum, either) = (&[Op::Add, Op::Subtract][..], &[Op::Multiply, Op::Divide][..]);
        let has_constant = |h, ops| self.operands(h, ops).is_some_and(|pair| pair.iter().any(|&o| self.rounds(o)));
        let E::Binary { op, left, right } = self.function.expressions[of] else { return None };
        let orders = [[left, right], [right, left]];
        match op {
            Op::Divide if self.rounds(right) => Some("a quotient by a constant: x * (1.0 / K)"),
            Op::Divide => {
                let undone = self.operands(left, product).is_some_and(|p| p.iter().any(|&o| self.same(o, right)));
                undone.then_some("(a * b) / b")
            }
            Op::Multiply => {
                let over = |h| self.operands(h, quotient).is_some_and(|q| self.constant(q[0]).is_some());
                if orders.iter().any(|[k, x]| self.rounds(*k) && (has_constant(*x, either) || over(*x))) {
                    return Some("two constant factors: x * (A * B)");
                }
                let root = |h: Handle<E>| match self.function.expressions[h] {
                    E::Math { fun: MathFunction::Sqrt, arg, .. } => Some(arg),
                    _ => None,
                };
                if let (Some(a), Some(b)) = (root(left), root(right))
                    && self.same(a, b)
                {
                    return Some("sqrt(x) * sqrt(x)");
                }
                let undone = |[a, b]: &[Handle<E>; 2]| self.operands(*a, quotient).is_some_and(|q| self.same(q[1], *b));
                orders.iter().any(undone).then_some("(a / b) * b")
            }
            Op::Add | Op::Subtract => {
                let constant = |h: Handle<E>| self.constant(h).is_some_and(|c| c.iter().any(|x| *x != 0.0));
                let with_constant = |h| self.operands(h, sum).is_some_and(|s| s.iter().any(|&o| constant(o)));
                if orders.iter().any(|[k, x]| constant(*k) && with_constant(*x)) {
                    return Some("two constant terms: x + (A + B)");
                }
                if let (Some(a), Some(b)) = (self.operands(left, product), self.operands(right, product)) {
                    let shared = a.iter().any(|&x| b.iter().any(|&y| self.same(x, y) && self.constant(x).is_none()));
                    if shared && !(self.same(a[0], a[1]) || self.same(b[0], b[1])) {
                        return Some("a * b + a * c: a * (b + c)");
                    }
                }
                let other = if op == Op::Add { Op::Subtract } else { Op::Add };
                let undone = |[a, b]: &[Handle<E>; 2]| self.operands(*a, &[other]).is_some_and(|s| self.same(s[1], *b));
                orders.iter().take(if op == Op::Add { 2 } else { 1 }).any(undone).then_some("(a - b) + b")
            }
            _ => None,
        }
    }
}

fn constant_in(module: &Module, expressions: &naga::Arena<E>, of: Handle<E>) -> Option<Vec<f32>> {
    let each = |h: &Handle<E>| constant_in(module, expressions, *h);
    match &expressions[of] {
        E::Literal(Literal::F32(x)) => Some(vec![*x]),
        E::Constant(c) => constant_in(module, &module.global_expressions, module.constants[*c].init),
        E::Override(o) => {
            let is_float = matches!(
                module.types[module.overrides[*o].ty].inner,
                TypeInner::Scalar(Scalar { kind: ScalarKind::Float, .. })
            );
            is_float.then(|| vec![f32::NAN])
        }
        E::Splat { value, .. } => each(value),
        E::Compose { components, .. } => Some(components.iter().map(each).collect::<Option<Vec<_>>>()?.concat()),
        E::AccessIndex { base, index } => each(base)?.get(*index as usize).map(|x| vec![*x]),
        E::Unary { op: UnaryOperator::Negate, expr } => Some(each(expr)?.iter().map(|x| -x).collect()),
        _ => None,
    }
}

fn is_power_of_two(x: f32) -> bool {
    x.is_normal() && x.to_bits() & 0x007f_ffff == 0
}

/// Every call in a block: the called function and its arguments.
fn calls<'a>(block: &'a Block, visit: &mut impl FnMut(Handle<Function>, &'a [Handle<E>])) {
    for statement in block {
        match statement {
            Statement::Call { function, arguments, .. } => visit(*function, arguments),
            Statement::Block(inner) => calls(inner, visit),
            Statement::If { accept, reject, .. } => [accept, reject].into_iter().for_each(|b| calls(b, visit)),
            Statement::Switch { cases, .. } => cases.iter().for_each(|case| calls(&case.body, visit)),
            Statement::Loop { body, continuing, .. } => [body, continuing].into_iter().for_each(|b| calls(b, visit)),
            _ => {}
        }
    }
}

/// What compilers may rewrite in a module, each with its place.
fn faults(composed: &Composed) -> BTreeSet<String> {
    let module = naga::front::wgsl::parse_str(&composed.source).unwrap();
    let mut faults = BTreeSet::new();
    // Parameters that a function divides by, itself or in the functions that it calls: after inlining, a constant
    // argument is a constant divisor. Called functions come first.
    let mut divisors: HashMap<Handle<Function>, HashSet<u32>> = HashMap::new();
    let entries = module.entry_points.iter().map(|entry| (None, &entry.function));
    for (handle, function) in module.functions.iter().map(|(h, f)| (Some(h), f)).chain(entries) {
        let reader = Reader { module: &module, function };
        let mut report = |of: Handle<E>, what: &str| {
            let line = function.expressions.get_span(of).location(&composed.source).line_number;
            let (file, line) = composed.origin(line).unwrap_or(("?", line));
            faults.insert(format!("{file}:{line}: {what}"));
        };
        let argument = |h: Handle<E>| match function.expressions[h] {
            E::FunctionArgument(i) => Some(i),
            _ => None,
        };
        let mut own = HashSet::new();
        for (of, expression) in function.expressions.iter() {
            if let Some(what) = reader.fault(of) {
                report(of, what);
            }
            if let E::Binary { op: Op::Divide, right, .. } = *expression {
                own.extend(argument(right));
            }
        }
        calls(&function.body, &mut |callee, arguments| {
            for &i in divisors.get(&callee).into_iter().flatten() {
                let passed = arguments[i as usize];
                own.extend(argument(passed));
                if reader.rounds(passed) {
                    report(passed, "a constant that the called function divides by");
                }
            }
        });
        divisors.extend(handle.map(|handle| (handle, own)));
    }
    faults
}

#[test]
fn compilers_have_nothing_to_reorder() {
    let mut all = BTreeSet::new();
    let mut count = 0;
    for composed in composed_modules() {
        all.extend(faults(&composed));
        count += 1;
    }
    println!("{count} modules");
    assert!(all.is_empty(), "{}", all.into_iter().collect::<Vec<_>>().join("\n"));
}

#[test]
fn planted_expressions_are_reported() {
    let right = [
        "x * (1.0f / 3.0f)",
        "(x * 3.0) * 0.5",
        "x * y + x",
        "(x + y) + 1.5",
        "f32(u / 3u)",
        "1.0 / x",
        "x / max(y, 1e-3)",
    ];
    let wrong = [
        "x / 3.0",
        "(v / vec3f(2.0, 4.0, 5.0)).x",
        "x / O",
        "(x * 3.0) * 1.1",
        "1.1 * (1.0 / x)",
        "1.5 + (x - y - 0.25)",
        "x * y + x * v.x",
        "v.x * v.y - v.z * v.x",
        "(x - y) + y",
        "(x * y) / y",
        "(x / y) * y",
        "sqrt(x) * sqrt(x)",
        "called(0.1)",
    ];
    for (expression, is_wrong) in right.map(|e| (e, false)).into_iter().chain(wrong.map(|e| (e, true))) {
        let text = format!(
            "const K: f32 = 0.3;
override O: f32 = 2.0;
fn half(a: f32, b: f32) -> f32 {{ return a / b; }}
fn called(b: f32) -> f32 {{ return half(2.0, b); }}
fn planted(x: f32, y: f32, v: vec3f, u: u32) -> f32 {{
    let result = {expression};
    return f32(result);
}}"
        );
        let found = faults(&SHADERS.compose_with(&[], &text));
        assert_eq!(!found.is_empty(), is_wrong, "{expression}: {found:?}");
    }
}
