//! Deserialises scene values with full key paths of errors.
//!
//! The parser's own deserialiser would truncate long lists and accept lists for tables.

use serde::de::value::StrDeserializer;
use serde::de::{self, DeserializeSeed, Deserializer, Error as _, MapAccess, SeqAccess, Unexpected, Visitor};
use serde::forward_to_deserialize_any;
use std::borrow::Cow;
use std::fmt;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

pub(super) const NO_WORD: &str = "no word";

#[derive(Debug)]
pub(super) struct Fault {
    pub message: String,
    /// Keys from the root to the value.
    pub path: Vec<String>,
}

impl Fault {
    fn below(mut self, key: impl fmt::Display) -> Fault {
        self.path.insert(0, key.to_string());
        self
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.path.join("."), self.message)
    }
}

impl std::error::Error for Fault {}

impl de::Error for Fault {
    fn custom<T: fmt::Display>(message: T) -> Fault {
        Fault { message: message.to_string(), path: Vec::new() }
    }
}

pub(super) struct Value<'i>(Spanned<DeValue<'i>>);

impl<'i> Value<'i> {
    pub fn root(tree: Spanned<DeTable<'i>>) -> Value<'i> {
        let span = tree.span();
        Value(Spanned::new(span, DeValue::Table(tree.into_inner())))
    }
}

impl<'de> Deserializer<'de> for Value<'de> {
    type Error = Fault;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Fault> {
        match self.0.into_inner() {
            DeValue::Array(items) => visitor.visit_seq(Items(items.into_iter().enumerate())),
            DeValue::Table(entries) => visitor.visit_map(Entries(entries.into_iter(), None)),
            DeValue::Datetime(_) => Err(Fault::invalid_type(Unexpected::Other("a date"), &visitor)),
            DeValue::String(text) => match text {
                Cow::Borrowed(text) => visitor.visit_borrowed_str(text),
                Cow::Owned(text) => visitor.visit_string(text),
            },
            DeValue::Boolean(value) => visitor.visit_bool(value),
            DeValue::Integer(digits) => match i64::from_str_radix(digits.as_str(), digits.radix()) {
                Ok(number) => visitor.visit_i64(number),
                Err(_) => match u64::from_str_radix(digits.as_str(), digits.radix()) {
                    Ok(number) => visitor.visit_u64(number),
                    Err(_) => Err(Fault::custom("integer number overflowed")),
                },
            },
            DeValue::Float(digits) => match digits.as_str().parse::<f64>() {
                Ok(number) if number.is_finite() || digits.as_str().contains("inf") || number.is_nan() => {
                    visitor.visit_f64(number)
                }
                _ => Err(Fault::custom("floating-point number overflowed")),
            },
        }
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Fault> {
        visitor.visit_some(self)
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        visitor: V,
    ) -> Result<V::Value, Fault> {
        visitor.visit_newtype_struct(self)
    }

    fn deserialize_tuple<V: Visitor<'de>>(self, length: usize, visitor: V) -> Result<V::Value, Fault> {
        match self.0.get_ref() {
            DeValue::Array(items) if items.len() != length => {
                Err(Fault::invalid_length(items.len(), &visitor))
            }
            _ => self.deserialize_any(visitor),
        }
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Fault> {
        match self.0.get_ref() {
            DeValue::Array(_) => Err(Fault::invalid_type(Unexpected::Seq, &visitor)),
            _ => self.deserialize_any(visitor),
        }
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Fault> {
        match self.0.get_ref() {
            DeValue::String(word) => visitor.visit_enum(StrDeserializer::new(word)),
            _ => Err(Fault::custom(NO_WORD)),
        }
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf unit unit_struct seq
        tuple_struct map identifier ignored_any
    }
}

struct Items<I>(I);

impl<'de, I: Iterator<Item = (usize, Spanned<DeValue<'de>>)>> SeqAccess<'de> for Items<I> {
    type Error = Fault;

    fn next_element_seed<S: DeserializeSeed<'de>>(&mut self, seed: S) -> Result<Option<S::Value>, Fault> {
        let Some((index, item)) = self.0.next() else { return Ok(None) };
        seed.deserialize(Value(item)).map(Some).map_err(|fault| fault.below(index))
    }

    fn size_hint(&self) -> Option<usize> {
        Some(self.0.size_hint().0)
    }
}

/// Table entries, and the one whose key was read.
struct Entries<'de, I>(I, Option<(String, Spanned<DeValue<'de>>)>);

impl<'de, K: AsRef<str>, I: Iterator<Item = (Spanned<K>, Spanned<DeValue<'de>>)>> MapAccess<'de>
    for Entries<'de, I>
{
    type Error = Fault;

    fn next_key_seed<S: DeserializeSeed<'de>>(&mut self, seed: S) -> Result<Option<S::Value>, Fault> {
        let Some((key, value)) = self.0.next() else { return Ok(None) };
        let key = key.get_ref().as_ref().to_string();
        let read =
            seed.deserialize(StrDeserializer::<Fault>::new(&key)).map_err(|fault| fault.below(&key))?;
        self.1 = Some((key, value));
        Ok(Some(read))
    }

    fn next_value_seed<S: DeserializeSeed<'de>>(&mut self, seed: S) -> Result<S::Value, Fault> {
        let (key, value) = self.1.take().ok_or_else(|| Fault::custom("a value without a key"))?;
        seed.deserialize(Value(value)).map_err(|fault| fault.below(key))
    }
}
