//! Data lines of nodes, elements and sets.
// SPDX-License-Identifier: BSD-3-Clause

use super::number::{integer, real, trim};

/// A line that is not plainly right: its first byte and its number.
pub type Odd = (usize, i64);

/// Nodes: label, then three coordinates a row; line number of each.
#[derive(Debug, Default)]
pub struct Nodes {
    pub labels: Vec<i64>,
    pub points: Vec<f64>,
    pub lines: Vec<i64>,
    pub odd: Vec<Odd>,
}

/// Rows of `width` whole numbers; line number of each.
#[derive(Debug, Default)]
pub struct Table {
    pub values: Vec<i64>,
    pub lines: Vec<i64>,
    pub odd: Vec<Odd>,
}

/// Lines of a piece of text with their first byte and number; comments and empty ones left out.
fn lines(data: &[u8], first: i64) -> impl Iterator<Item = (usize, i64, &[u8])> {
    let mut start = 0;
    let mut number = first - 1;
    std::iter::from_fn(move || {
        loop {
            if start >= data.len() {
                return None;
            }
            let rest = &data[start..];
            let length = rest.iter().position(|&c| c == b'\n').unwrap_or(rest.len());
            let at = start;
            start += length + 1;
            number += 1;
            let line = trim(&rest[..length]);
            if !line.is_empty() && !line.starts_with(b"**") {
                return Some((at, number, line));
            }
        }
    })
}

fn label(field: &[u8]) -> Option<i64> {
    integer(field).filter(|&n| n > 0)
}

/// Reads `label, x, y[, z]`; empty coordinates are zero.
pub fn nodes(data: &[u8], first: i64) -> Nodes {
    let mut found = Nodes::default();
    for (at, number, line) in lines(data, first) {
        if let Some((name, point)) = node(line) {
            found.labels.push(name);
            found.points.extend_from_slice(&point);
            found.lines.push(number);
        } else {
            found.odd.push((at, number));
        }
    }
    found
}

fn node(line: &[u8]) -> Option<(i64, [f64; 3])> {
    let mut fields = line.split(|&c| c == b',').map(trim);
    let name = label(fields.next()?)?;
    let mut point = [0.0; 3];
    let mut count = 0;
    for field in fields {
        if !field.is_empty() {
            *point.get_mut(count)? = real(field)?;
        }
        count += 1;
    }
    // One comma after the last coordinate adds no field.
    (1..=4).contains(&count).then_some((name, point))
}

/// Reads rows of `width` whole numbers; a line that ends with a comma goes on in the next one.
pub fn table(data: &[u8], first: i64, width: usize) -> Table {
    let mut found = Table::default();
    let mut row = Vec::with_capacity(width);
    let mut head = (0, 0);
    let mut good = true;
    for (at, number, line) in lines(data, first) {
        if row.is_empty() && good {
            head = (at, number);
        }
        let body = line.strip_suffix(b",").unwrap_or(line);
        for field in body.split(|&c| c == b',') {
            match integer(trim(field)) {
                Some(value) if row.len() < width => row.push(value),
                _ => good = false,
            }
        }
        let open = body.len() < line.len() && row.len() < width;
        if open && good {
            continue;
        }
        if good && row.len() == width && row[0] > 0 {
            found.values.extend_from_slice(&row);
            found.lines.push(head.1);
        } else {
            found.odd.push(head);
        }
        row.clear();
        good = true;
    }
    if !row.is_empty() {
        found.odd.push(head);
    }
    found
}

/// Reads labels, any number a line; `None` if anything else stands there.
pub fn labels(data: &[u8], first: i64) -> Option<Vec<i64>> {
    let mut found = Vec::new();
    for (_, _, line) in lines(data, first) {
        for field in line.split(|&c| c == b',').map(trim) {
            if !field.is_empty() {
                found.push(label(field)?);
            }
        }
    }
    Some(found)
}

#[cfg(test)]
mod tests {
    use super::{labels, nodes, table};

    #[test]
    fn nodes_skip_comments_and_report_odd_lines() {
        let text = b"1, 0., 1.\n** comment\n\n 2,1.d0,,\r\n3, nan, 0\nx\n4, 1, 2, 3, 4\n5\n6,,2.\n";
        let found = nodes(text, 10);
        assert_eq!(found.labels, [1, 2, 6]);
        assert_eq!(found.points, [0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 2.0, 0.0]);
        assert_eq!(found.lines, [10, 13, 18]);
        assert_eq!(found.odd.iter().map(|o| o.1).collect::<Vec<_>>(), [14, 15, 16, 17]);
        assert_eq!(&text[found.odd[1].0..=found.odd[1].0], b"x");
    }

    #[test]
    fn rows_go_on_after_a_comma() {
        let found =
            table(b"1, 2, 3\n4, 5,\n6\n7, 8\n-1, 2, 3\n9, 1, 2,\n3, 3, 3, 3\n1, 2,\n", 1, 3);
        assert_eq!(found.values, [1, 2, 3, 4, 5, 6, 9, 1, 2]);
        assert_eq!(found.lines, [1, 2, 6]);
        assert_eq!(found.odd.iter().map(|o| o.1).collect::<Vec<_>>(), [4, 5, 7, 8]);
    }

    #[test]
    fn labels_are_all_or_nothing() {
        assert_eq!(labels(b"1, 2, 3,\n4\n", 1), Some(vec![1, 2, 3, 4]));
        assert_eq!(labels(b"1, 2\nname\n", 1), None);
    }

    #[test]
    fn nothing_panics_on_any_bytes() {
        let letters = b"0123456789,,,\n\n*.eD+- \t\r\xff\0";
        let mut state = 1u32;
        for _ in 0..3000 {
            let text: Vec<u8> = (0..40)
                .map(|_| {
                    state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                    letters[(state >> 16) as usize % letters.len()]
                })
                .collect();
            let found = nodes(&text, 1);
            assert_eq!(found.points.len(), 3 * found.labels.len());
            assert_eq!(table(&text, 1, 4).values.len() % 4, 0);
            let _ = labels(&text, 1);
        }
    }
}
