//! Compiles matrix products, transposition and determinants. Matrices are stored column by column.

use naga::TypeInner;

use super::compiler::{Compiler, Result};
use crate::layout::count;
use crate::operation::{Op, Word};
use crate::scalar::Binary;

impl Compiler<'_> {
    /// Compiles a product of a matrix with a matrix or vector; `None` for other operands.
    pub(super) fn product(&mut self, left: &TypeInner, a: Word, right: &TypeInner, b: Word) -> Result<Option<Word>> {
        let (rows, inner, columns, vector_left) = match (left, right) {
            (TypeInner::Matrix { columns: inner, rows, .. }, TypeInner::Matrix { columns, .. }) => {
                (count(*rows), count(*inner), count(*columns), false)
            }
            (TypeInner::Matrix { columns: inner, rows, .. }, TypeInner::Vector { .. }) => {
                (count(*rows), count(*inner), 1, false)
            }
            (TypeInner::Vector { .. }, TypeInner::Matrix { columns, rows: inner, .. }) => {
                (1, count(*inner), count(*columns), true)
            }
            _ => return Ok(None),
        };
        let to = self.take(rows * columns);
        for column in 0..columns {
            for row in 0..rows {
                let first = if vector_left { a } else { a + row };
                let step = if vector_left { 1 } else { rows };
                let sum = self.dot(first, step, b + column * inner, inner);
                self.push(Op::Copy { to: to + column * rows + row, from: sum, count: 1 });
            }
        }
        Ok(Some(to))
    }

    /// Computes a sum of products; the left factors are `step` words apart.
    fn dot(&mut self, a: Word, step: u32, b: Word, length: u32) -> Word {
        let mut sum = self.take(1);
        self.push(Op::Binary { op: Binary::MultiplyF, to: sum, a, b });
        for number in 1..length {
            let product = self.take(2);
            self.push(Op::Binary { op: Binary::MultiplyF, to: product, a: a + number * step, b: b + number });
            self.push(Op::Binary { op: Binary::AddF, to: product + 1, a: sum, b: product });
            sum = product + 1;
        }
        sum
    }

    pub(super) fn transpose(&mut self, inner: &TypeInner, a: Word) -> Result<Word> {
        let TypeInner::Matrix { columns, rows, .. } = inner else { return Err("the transpose of a vector".to_owned()) };
        let (columns, rows) = (count(*columns), count(*rows));
        let to = self.take(columns * rows);
        for column in 0..columns {
            for row in 0..rows {
                self.push(Op::Copy { to: to + row * columns + column, from: a + column * rows + row, count: 1 });
            }
        }
        Ok(to)
    }

    /// Computes the determinant by expansion along the first column.
    pub(super) fn determinant(&mut self, inner: &TypeInner, a: Word) -> Result<Word> {
        let TypeInner::Matrix { columns, rows, .. } = inner else {
            return Err("the determinant of a vector".to_owned());
        };
        if columns != rows {
            return Err("the determinant of a non-square matrix".to_owned());
        }
        let size = count(*columns);
        Ok(self.minor(a, size, &(1..size).collect::<Vec<_>>(), &(0..size).collect::<Vec<_>>(), 0))
    }

    /// Computes the minor of the rows `rows`, the column `column` and the columns `others`.
    fn minor(&mut self, a: Word, size: u32, others: &[u32], rows: &[u32], column: u32) -> Word {
        let at = |row: u32| a + column * size + row;
        let Some((next, rest)) = others.split_first() else { return at(rows[0]) };
        let mut sum = None;
        for (number, row) in rows.iter().enumerate() {
            let left: Vec<u32> = rows.iter().copied().filter(|other| other != row).collect();
            let part = self.minor(a, size, rest, &left, *next);
            let product = self.take(1);
            self.push(Op::Binary { op: Binary::MultiplyF, to: product, a: at(*row), b: part });
            sum = Some(match sum {
                None => product,
                Some(sum) => {
                    let op = if number % 2 == 0 { Binary::AddF } else { Binary::SubtractF };
                    let to = self.take(1);
                    self.push(Op::Binary { op, to, a: sum, b: product });
                    to
                }
            });
        }
        sum.unwrap_or(a)
    }
}
