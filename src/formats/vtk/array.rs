//! Arrays of numbers of some type.

use crate::formats::error::Fault;

/// Types of numbers, by VTK's names in XML and in legacy files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Number {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
    F32,
    F64,
}

impl Number {
    /// The type of a name.
    pub(super) fn of(name: &str) -> Option<Number> {
        Some(match name {
            "Int8" | "char" | "vtktypeint8" => Number::I8,
            "UInt8" | "unsigned_char" | "vtktypeuint8" => Number::U8,
            "Int16" | "short" | "vtktypeint16" => Number::I16,
            "UInt16" | "unsigned_short" | "vtktypeuint16" => Number::U16,
            "Int32" | "int" | "vtktypeint32" => Number::I32,
            "UInt32" | "unsigned_int" | "vtktypeuint32" => Number::U32,
            "Int64" | "long" | "vtktypeint64" | "vtkIdType" => Number::I64,
            "UInt64" | "unsigned_long" | "vtktypeuint64" => Number::U64,
            "Float32" | "float" => Number::F32,
            "Float64" | "double" => Number::F64,
            _ => return None,
        })
    }

    /// Bytes of a number.
    pub(super) fn width(self) -> usize {
        match self {
            Number::I8 | Number::U8 => 1,
            Number::I16 | Number::U16 => 2,
            Number::I32 | Number::U32 | Number::F32 => 4,
            Number::I64 | Number::U64 | Number::F64 => 8,
        }
    }

    /// Appends the numbers that stand in bytes.
    ///
    /// # Errors
    /// [`Fault::Number`] for a real number that is not whole, where whole ones are wanted; [`Fault::Truncated`] where the bytes
    /// are not those of so many numbers.
    pub(super) fn decode(self, bytes: &[u8], big_endian: bool, values: &mut Values) -> Result<(), Fault> {
        if !bytes.len().is_multiple_of(self.width()) {
            return Err(Fault::Truncated("a number of an array"));
        }
        macro_rules! each {
            ($type:ty) => {
                bytes.chunks_exact(self.width()).map(|chunk| {
                    let mut own = [0; size_of::<$type>()];
                    own.copy_from_slice(chunk);
                    if big_endian { <$type>::from_be_bytes(own) } else { <$type>::from_le_bytes(own) }
                })
            };
        }
        macro_rules! push {
            ($type:ty) => {
                match values {
                    Values::Whole(values) => values.extend(each!($type).map(|x| x as i64)),
                    Values::Real(values) => values.extend(each!($type).map(|x| x as f64)),
                }
            };
        }
        macro_rules! push_real {
            ($type:ty) => {
                match values {
                    Values::Whole(values) => {
                        for x in each!($type) {
                            values.push(whole(x.into())?);
                        }
                    }
                    Values::Real(values) => values.extend(each!($type).map(f64::from)),
                }
            };
        }
        match self {
            Number::I8 => push!(i8),
            Number::U8 => push!(u8),
            Number::I16 => push!(i16),
            Number::U16 => push!(u16),
            Number::I32 => push!(i32),
            Number::U32 => push!(u32),
            Number::I64 => push!(i64),
            Number::U64 => push!(u64),
            Number::F32 => push_real!(f32),
            Number::F64 => push_real!(f64),
        }
        Ok(())
    }
}

/// A real number that is a whole one.
///
/// # Errors
/// [`Fault::Number`].
fn whole(x: f64) -> Result<i64, Fault> {
    // Beyond 2^53 neighbouring whole numbers are one real number.
    if x.fract() == 0.0 && x.abs() <= (1_u64 << 53) as f64 {
        return Ok(x as i64);
    }
    Err(Fault::Number { what: "a whole number of an array", found: x.to_string() })
}

/// Numbers as they are wanted, whatever type the file has.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Values {
    Whole(Vec<i64>),
    Real(Vec<f64>),
}

impl Values {
    /// Appends a number that stands as a word.
    pub(super) fn push_word(&mut self, word: &str) -> Result<(), Fault> {
        let wrong = || Fault::Number { what: "an array's value", found: word.chars().take(40).collect() };
        match self {
            Values::Whole(values) => match word.parse() {
                Ok(value) => values.push(value),
                // Some writers put whole numbers down as reals.
                Err(_) => values.push(whole(word.parse().map_err(|_| wrong())?).map_err(|_| wrong())?),
            },
            Values::Real(values) => values.push(word.parse().map_err(|_| wrong())?),
        }
        Ok(())
    }

    /// How many there are.
    pub(super) fn len(&self) -> usize {
        match self {
            Values::Whole(values) => values.len(),
            Values::Real(values) => values.len(),
        }
    }

    /// The whole numbers; `None` where some are not whole.
    pub(super) fn whole(self) -> Option<Vec<i64>> {
        match self {
            Values::Whole(values) => Some(values),
            Values::Real(values) => values.into_iter().map(|x| whole(x).ok()).collect(),
        }
    }

    /// The real numbers.
    pub(super) fn real(self) -> Vec<f64> {
        match self {
            Values::Real(values) => values,
            Values::Whole(values) => values.into_iter().map(|x| x as f64).collect(),
        }
    }
}
