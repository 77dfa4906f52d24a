//! Decimal numbers of decks: finite and normal, or none.
// SPDX-License-Identifier: BSD-3-Clause

/// Largest number of digits of a label that is taken here.
const MAX_DIGITS: usize = 18;

/// Field without blanks around it.
pub fn trim(field: &[u8]) -> &[u8] {
    let blank = |c: &u8| matches!(c, b' ' | b'\t' | b'\r');
    let first = field.iter().position(|c| !blank(c)).unwrap_or(field.len());
    let last = field.iter().rposition(|c| !blank(c)).map_or(first, |i| i + 1);
    &field[first..last]
}

/// Whole number of a trimmed field, if it is written as `[+-]digits` and has at most 18 digits.
pub fn integer(field: &[u8]) -> Option<i64> {
    let (negative, digits) = match field {
        [b'-', rest @ ..] => (true, rest),
        [b'+', rest @ ..] => (false, rest),
        _ => (false, field),
    };
    if digits.is_empty() || digits.len() > MAX_DIGITS || !digits.iter().all(u8::is_ascii_digit) {
        return None;
    }
    let size = digits.iter().fold(0i64, |n, c| 10 * n + i64::from(c - b'0'));
    Some(if negative { -size } else { size })
}

/// Real number of a trimmed field: decimal, Fortran's `D` exponents too; finite, and zero or
/// normal.
pub fn real(field: &[u8]) -> Option<f64> {
    let mut copy = [0u8; 64];
    let n = field.len();
    if n == 0 || n > copy.len() {
        return None;
    }
    let mut nonzero = false;
    let mut mantissa = true;
    for (to, from) in copy.iter_mut().zip(field) {
        *to = match from {
            b'0'..=b'9' => {
                nonzero |= mantissa && *from != b'0';
                *from
            }
            b'+' | b'-' | b'.' => *from,
            b'e' | b'E' | b'd' | b'D' => {
                mantissa = false;
                b'e'
            }
            _ => return None,
        };
    }
    let value: f64 = std::str::from_utf8(&copy[..n]).ok()?.parse().ok()?;
    let good = value.is_finite() && if nonzero { value.is_normal() } else { value == 0.0 };
    good.then_some(value)
}

#[cfg(test)]
mod tests {
    use super::{integer, real, trim};

    #[test]
    fn whole_numbers_are_digits_with_a_sign() {
        for (text, value) in [("7", Some(7)), ("+12", Some(12)), ("-3", Some(-3)), ("", None)] {
            assert_eq!(integer(text.as_bytes()), value);
        }
        for text in ["1.", "1 2", "0x1", "-", "1e3", "1234567890123456789", "\u{661}"] {
            assert_eq!(integer(text.as_bytes()), None, "{text}");
        }
    }

    #[test]
    fn reals_are_finite_and_normal() {
        for (text, value) in [
            ("1.", 1.0),
            (".5", 0.5),
            ("-2.5e-3", -2.5e-3),
            ("1D+2", 100.0),
            ("1.d-2", 0.01),
            ("0", 0.0),
            ("-0.000", 0.0),
            ("0e5", 0.0),
        ] {
            assert_eq!(real(text.as_bytes()), Some(value), "{text}");
        }
        for text in [
            "", "nan", "inf", "infinity", "1e400", "1e-310", "1e-400", "0x1", ".", "e5", "1e",
            "--1",
        ] {
            assert_eq!(real(text.as_bytes()), None, "{text}");
        }
    }

    #[test]
    fn blanks_and_returns_are_trimmed() {
        assert_eq!(trim(b" \t 1. 2\r"), b"1. 2");
        assert_eq!(trim(b"  "), b"");
    }
}
