//! Numbers between blanks: the text sections of Gmsh's files.
// SPDX-License-Identifier: BSD-3-Clause

use super::number::real;

/// Reads numbers between blanks and line ends; `Err` holds the first byte of one that is none.
pub fn reals(data: &[u8]) -> Result<Vec<f64>, usize> {
    let mut found = Vec::new();
    let mut at = 0;
    while at < data.len() {
        if data[at].is_ascii_whitespace() {
            at += 1;
            continue;
        }
        let rest = &data[at..];
        let length = rest.iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len());
        found.push(real(&rest[..length]).ok_or(at)?);
        at += length;
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::reals;

    #[test]
    fn numbers_between_any_blanks() {
        assert_eq!(reals(b" 1 2.5\r\n\t-3e-2\n"), Ok(vec![1.0, 2.5, -0.03]));
        assert_eq!(reals(b""), Ok(vec![]));
    }

    #[test]
    fn the_first_wrong_one_is_told() {
        assert_eq!(reals(b"1 2 nan x"), Err(4));
        assert_eq!(reals(b"1e400"), Err(0));
    }
}
