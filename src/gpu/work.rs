//! How much arithmetic a shader does, counted in what naga made of it.

use naga::proc::TypeResolution;
use naga::{Block, Expression, Function, Handle, MathFunction, ScalarKind, Statement, TypeInner};

use super::reflect::Shader;
use crate::error::Result;

/// Floating-point operations of one thread: each component of a sum, difference, product, quotient or function counts
/// one, a fused multiplication and addition two.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Work {
    /// Outside of loops.
    pub once: u64,
    /// In one turn of the innermost loop, as if every branch there were taken once.
    pub per_turn: u64,
}

impl Work {
    fn plus(self, other: Self) -> Self {
        Self {
            once: self.once + other.once,
            per_turn: self.per_turn + other.per_turn,
        }
    }
}

impl Shader {
    /// The arithmetic of an entry point and of what it calls.
    ///
    /// # Errors
    ///
    /// Where there is no such entry point.
    pub fn work(&self, entry: &str) -> Result<Work> {
        let index = self.entry_index(entry)?;
        let counter = Counter {
            shader: self,
            function: &self.module.entry_points[index].function,
            types: self.info.get_entry_point(index),
        };
        let depth = counter.depth(&counter.function.body);
        Ok(counter.block(&counter.function.body, depth))
    }
}

struct Counter<'a> {
    shader: &'a Shader,
    function: &'a Function,
    types: &'a naga::valid::FunctionInfo,
}

impl<'a> Counter<'a> {
    fn of(&self, called: Handle<Function>) -> Self {
        Self {
            shader: self.shader,
            function: &self.shader.module.functions[called],
            types: &self.shader.info[called],
        }
    }

    /// How deep loops lie in each other.
    fn depth(&self, block: &Block) -> u32 {
        let of = |statement: &Statement| match statement {
            Statement::Block(block) => self.depth(block),
            Statement::If { accept, reject, .. } => self.depth(accept).max(self.depth(reject)),
            Statement::Switch { cases, .. } => {
                cases.iter().map(|case| self.depth(&case.body)).max().unwrap_or(0)
            }
            Statement::Loop { body, continuing, .. } => 1 + self.depth(body).max(self.depth(continuing)),
            Statement::Call { function, .. } => {
                let called = self.of(*function);
                called.depth(&called.function.body)
            }
            _ => 0,
        };
        block.iter().map(of).max().unwrap_or(0)
    }

    /// `below`: how many loops lie between here and the innermost ones.
    fn block(&self, block: &Block, below: u32) -> Work {
        let mut work = Work::default();
        for statement in block.iter() {
            work = work.plus(match statement {
                Statement::Emit(range) => {
                    let sum = range.clone().map(|handle| self.expression(handle)).sum();
                    Work {
                        once: sum,
                        per_turn: 0,
                    }
                }
                Statement::Block(block) => self.block(block, below),
                Statement::If { accept, reject, .. } => {
                    self.block(accept, below).plus(self.block(reject, below))
                }
                Statement::Switch { cases, .. } => cases
                    .iter()
                    .map(|case| self.block(&case.body, below))
                    .fold(Work::default(), Work::plus),
                Statement::Loop { body, continuing, .. } => {
                    let inner = self
                        .block(body, below.saturating_sub(1))
                        .plus(self.block(continuing, below.saturating_sub(1)));
                    // What a loop around the innermost one does besides is little, and nobody knows how often.
                    Work {
                        once: 0,
                        per_turn: inner.per_turn + if below <= 1 { inner.once } else { 0 },
                    }
                }
                Statement::Call { function, .. } => {
                    let called = self.of(*function);
                    called.block(&called.function.body, below)
                }
                _ => Work::default(),
            });
        }
        work
    }

    fn expression(&self, handle: Handle<Expression>) -> u64 {
        use naga::BinaryOperator as Operator;
        match &self.function.expressions[handle] {
            Expression::Binary {
                op:
                    Operator::Add | Operator::Subtract | Operator::Multiply | Operator::Divide | Operator::Modulo,
                ..
            } => self.floats(handle),
            Expression::Math { fun, arg, .. } => match fun {
                MathFunction::Dot => (2 * self.floats(*arg)).saturating_sub(1),
                MathFunction::Length | MathFunction::Distance | MathFunction::Normalize => {
                    2 * self.floats(*arg)
                }
                MathFunction::Fma => 2 * self.floats(handle),
                _ => self.floats(handle),
            },
            _ => 0,
        }
    }

    /// Floating-point components of an expression.
    fn floats(&self, handle: Handle<Expression>) -> u64 {
        let types = &self.shader.module.types;
        let inner = match &self.types[handle].ty {
            TypeResolution::Handle(ty) => &types[*ty].inner,
            TypeResolution::Value(inner) => inner,
        };
        match inner {
            TypeInner::Scalar(scalar) if scalar.kind == ScalarKind::Float => 1,
            TypeInner::Vector { size, scalar } if scalar.kind == ScalarKind::Float => *size as u64,
            TypeInner::Matrix { columns, rows, .. } => *columns as u64 * *rows as u64,
            _ => 0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::compose::Variant;

    #[test]
    fn arithmetic_is_counted_by_hand() {
        let text = "
            var<storage, read_write> values: array<vec3f>;
            fn twice(x: vec3f) -> vec3f { return x + x; }
            @compute @workgroup_size(64)
            fn go(@builtin(global_invocation_id) id: vec3u) {
                var sum = twice(values[id.x]);
                for (var row = 0u; row < 9u; row++) {
                    for (var i = 0u; i < 4u; i++) {
                        let d = values[i] - sum;
                        if dot(d, d) < 1.0 { sum += 0.5 * twice(d); }
                    }
                }
                values[id.x] = sqrt(sum);
            }";
        let composed = crate::gpu::compose::of_text(text);
        let work = Shader::from_composed(&composed).unwrap().work("go").unwrap();
        // Outside 3 for `twice` and 3 for `sqrt`; inside 3 for d, 5 for the dot product, 3 each for twice, product and sum.
        assert_eq!((work.once, work.per_turn), (6, 17));
        let probe = Shader::load("probes/arithmetic", &Variant::default()).unwrap();
        assert!(probe.work("multiply_and_add").unwrap().per_turn > 0);
    }
}
