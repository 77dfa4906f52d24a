//! Bulk data of decks: data lines of numbers into arrays, odd lines handed back by number.
//!
//! The syntax of decks is written down once, in the Python lexer. Here only lines that are
//! plainly right are taken; any other is reported, and read again there.
// SPDX-License-Identifier: BSD-3-Clause

pub mod number;
pub mod rows;
pub mod tokens;
