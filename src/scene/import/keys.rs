//! Takes keys out of JSON; what is left was not understood.

use std::fmt;

use glam::DVec3;
use serde_json::Value;

use crate::error::Problem;

/// A key of the peer's scene that has no effect.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Ignored {
    /// JSON path.
    pub path: String,
    /// Empty where Sliceflow knows nothing like it.
    pub why: String,
    /// Whether the fluid will move in another way for lack of it.
    pub changes_physics: bool,
}

impl Ignored {
    pub fn new(path: impl Into<String>, why: impl Into<String>) -> Self {
        Self {
            path: path.into(),
            why: why.into(),
            changes_physics: false,
        }
    }

    /// For lack of it, the fluid will move in another way.
    pub fn physics(path: impl Into<String>, why: impl Into<String>) -> Self {
        Self {
            changes_physics: true,
            ..Self::new(path, why)
        }
    }
}

impl fmt::Display for Ignored {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.why.as_str() {
            "" => write!(f, "{}", self.path),
            why => write!(f, "{}: {why}", self.path),
        }
    }
}

/// An object with its place in the file.
pub struct Keys {
    pub path: String,
    value: Value,
    /// What parts that were taken out and given back have left.
    rest: Vec<Ignored>,
}

impl Keys {
    pub fn new(value: Value) -> Self {
        Self {
            path: String::new(),
            value,
            rest: Vec::new(),
        }
    }

    pub fn at(&self, key: &str) -> String {
        match self.path.as_str() {
            "" => key.to_owned(),
            path => format!("{path}.{key}"),
        }
    }

    fn take(&mut self, key: &str) -> Option<Value> {
        self.value.as_object_mut()?.shift_remove(key)
    }

    /// The value by `read`, or a problem that says what it should be.
    fn typed<T>(
        &mut self,
        key: &str,
        what: &str,
        read: impl Fn(&Value) -> Option<T>,
    ) -> Result<Option<T>, Problem> {
        let Some(value) = self.take(key) else {
            return Ok(None);
        };
        let wrong = || {
            Problem::new(
                self.at(key),
                format!("is {value}, which is not {what}"),
                format!("give {what}"),
            )
        };
        read(&value).map(Some).ok_or_else(wrong)
    }

    pub fn number(&mut self, key: &str) -> Result<Option<f64>, Problem> {
        self.typed(key, "a number", |value| value.as_f64().filter(|n| n.is_finite()))
    }

    /// Takes a key out that switches on what Sliceflow has not: a number that is not 0, true, a text or a list with something
    /// in it. Its loss changes the physics.
    pub fn lacking(&mut self, key: &str, why: &str) {
        let Some(value) = self.take(key) else { return };
        let is_on = match &value {
            Value::Null => false,
            Value::Bool(is_on) => *is_on,
            Value::Number(number) => number.as_f64() != Some(0.0),
            Value::String(text) => !text.is_empty(),
            Value::Array(list) => !list.is_empty(),
            Value::Object(object) => !object.is_empty(),
        };
        if is_on {
            self.rest.push(Ignored::physics(self.at(key), why));
        }
    }

    /// The same for every key that ends so.
    pub fn lacking_all(&mut self, ending: &str, why: &str) {
        let keys = self
            .value
            .as_object()
            .into_iter()
            .flat_map(|object| object.keys());
        let keys: Vec<String> = keys.filter(|key| key.ends_with(ending)).cloned().collect();
        for key in keys {
            self.lacking(&key, why);
        }
    }

    /// True and false, or 1 and 0.
    pub fn flag(&mut self, key: &str) -> Result<Option<bool>, Problem> {
        self.typed(key, "true or false", |value| {
            value
                .as_bool()
                .or_else(|| value.as_i64().map(|number| number != 0))
        })
    }

    pub fn text(&mut self, key: &str) -> Result<Option<String>, Problem> {
        self.typed(key, "a text", |value| value.as_str().map(str::to_owned))
    }

    pub fn vector(&mut self, key: &str) -> Result<Option<DVec3>, Problem> {
        self.typed(key, "three numbers", |value| {
            let numbers: Option<Vec<f64>> = value.as_array()?.iter().map(Value::as_f64).collect();
            match numbers?[..] {
                [x, y, z] => Some(DVec3::new(x, y, z)).filter(|v| v.is_finite()),
                _ => None,
            }
        })
    }

    /// A color's first three channels, 0 to 1.
    pub fn color(&mut self, key: &str) -> Result<Option<[f64; 3]>, Problem> {
        self.typed(key, "three or four numbers from 0 to 1", |value| {
            let channels: Option<Vec<f64>> = value.as_array()?.iter().map(Value::as_f64).collect();
            channels?.first_chunk().copied()
        })
    }

    /// One number for all axes, or three.
    pub fn scale(&mut self, key: &str) -> Result<Option<DVec3>, Problem> {
        match self.value.get(key).and_then(Value::as_f64) {
            Some(_) => Ok(self.number(key)?.map(DVec3::splat)),
            None => self.vector(key),
        }
    }

    /// An object within; its rest belongs to this one's.
    pub fn object<T>(
        &mut self,
        key: &str,
        read: impl FnOnce(&mut Keys) -> Result<T, Problem>,
    ) -> Result<Option<T>, Problem> {
        let Some(value) = self.take(key) else {
            return Ok(None);
        };
        let path = self.at(key);
        self.inner(path, value, read).map(Some)
    }

    /// A list of objects.
    pub fn list<T>(
        &mut self,
        key: &str,
        mut read: impl FnMut(&mut Keys) -> Result<T, Problem>,
    ) -> Result<Vec<T>, Problem> {
        let Some(elements) = self.typed(key, "a list", |value| value.as_array().cloned())? else {
            return Ok(Vec::new());
        };
        let mut all = Vec::new();
        for (i, value) in elements.into_iter().enumerate() {
            let path = format!("{}[{i}]", self.at(key));
            all.push(self.inner(path, value, &mut read)?);
        }
        Ok(all)
    }

    fn inner<T>(
        &mut self,
        path: String,
        value: Value,
        read: impl FnOnce(&mut Keys) -> Result<T, Problem>,
    ) -> Result<T, Problem> {
        if !value.is_object() {
            return Err(Problem::new(
                path,
                format!("is {value}, which is not an object"),
                "give { … }",
            ));
        }
        let mut inner = Keys {
            path,
            value,
            rest: Vec::new(),
        };
        let read = read(&mut inner)?;
        self.rest.extend(inner.rest());
        Ok(read)
    }

    /// What nobody has taken.
    pub fn rest(self) -> Vec<Ignored> {
        let keys = self
            .value
            .as_object()
            .into_iter()
            .flat_map(|object| object.keys());
        let left: Vec<_> = keys.map(|key| Ignored::new(self.at(key), "")).collect();
        self.rest.into_iter().chain(left).collect()
    }
}
