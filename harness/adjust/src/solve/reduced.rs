//! The matrix that remains after the elimination: dense, or by sparse columns of blocks.

/// Below this size a matrix is dense whatever it holds.
const ALWAYS_DENSE: usize = 400;
/// Share of blocks above which a matrix is dense.
const DENSE: f64 = 0.3;

/// Lower triangle of a symmetric matrix, column by column.
#[derive(Clone, Debug)]
pub(crate) struct Reduced {
    pub(crate) size: usize,
    pub(crate) values: Vec<f64>,
    pub(crate) sparse: Option<Pattern>,
}

/// Which blocks a sparse matrix has.
#[derive(Clone, Debug)]
pub(crate) struct Pattern {
    /// First unknown of each block, and their number.
    first: Vec<usize>,
    /// Of each column of blocks: its range in `rows`.
    start: Vec<usize>,
    /// Blocks of rows, sorted, with the place of their first row in the column.
    rows: Vec<(usize, usize)>,
    /// Of each column of blocks: where its values begin, and the length of its columns.
    values: Vec<(usize, usize)>,
}

impl Reduced {
    pub(crate) fn new(kept: &[usize], pattern: impl FnOnce() -> Vec<Vec<usize>>) -> Self {
        let size = kept[kept.len() - 1];
        let dense = || Self { size, values: vec![0.0; size * size], sparse: None };
        if size < ALWAYS_DENSE {
            return dense();
        }
        let pattern = pattern();
        let width = |block: usize| kept[block + 1] - kept[block];
        let of_column = |(column, rows): (usize, &Vec<usize>)| width(column) * rows.iter().map(|row| width(*row)).sum::<usize>();
        let filled: usize = pattern.iter().enumerate().map(of_column).sum();
        if filled as f64 > DENSE * 0.5 * (size * size) as f64 {
            return dense();
        }
        let (pattern, length) = Pattern::of(kept, &pattern);
        Self { size, values: vec![0.0; length], sparse: Some(pattern) }
    }

    /// Where the block of two kept blocks stands: its first value and the distance of its columns.
    #[inline]
    pub(crate) fn place(&self, row: (usize, usize), column: (usize, usize)) -> (usize, usize) {
        match &self.sparse {
            None => (column.1 * self.size + row.1, self.size),
            Some(pattern) => pattern.place(row.0, column.0),
        }
    }
}

impl Pattern {
    fn of(kept: &[usize], columns: &[Vec<usize>]) -> (Self, usize) {
        let mut found = Self { first: kept.to_vec(), start: vec![0], rows: Vec::new(), values: Vec::new() };
        let mut length = 0;
        for (column, rows) in columns.iter().enumerate() {
            let mut height = 0;
            for &row in rows {
                found.rows.push((row, height));
                height += kept[row + 1] - kept[row];
            }
            found.start.push(found.rows.len());
            found.values.push((length, height));
            length += height * (kept[column + 1] - kept[column]);
        }
        (found, length)
    }

    #[inline]
    fn place(&self, row: usize, column: usize) -> (usize, usize) {
        let rows = &self.rows[self.start[column]..self.start[column + 1]];
        let (first, height) = self.values[column];
        // The pattern was made from the same couplings: the block is there.
        let place = rows.binary_search_by_key(&row, |found| found.0).map_or(0, |i| rows[i].1);
        (first + place, height)
    }

    /// Pointers to columns and indices of rows, as sparse libraries want them.
    pub(crate) fn columns(&self) -> (Vec<usize>, Vec<usize>) {
        let (mut pointers, mut indices) = (vec![0], Vec::new());
        for column in 0..self.values.len() {
            let rows = &self.rows[self.start[column]..self.start[column + 1]];
            for _ in self.first[column]..self.first[column + 1] {
                rows.iter().for_each(|&(row, _)| indices.extend(self.first[row]..self.first[row + 1]));
                pointers.push(indices.len());
            }
        }
        (pointers, indices)
    }
}

impl Reduced {
    /// All of it, column by column, both triangles.
    pub(crate) fn into_dense(self) -> Vec<f64> {
        let n = self.size;
        let mut full = match &self.sparse {
            None => self.values,
            Some(pattern) => {
                let (pointers, indices) = pattern.columns();
                let mut full = vec![0.0; n * n];
                for column in 0..n {
                    for k in pointers[column]..pointers[column + 1] {
                        full[column * n + indices[k]] = self.values[k];
                    }
                }
                full
            }
        };
        for column in 0..n {
            for row in column + 1..n {
                full[row * n + column] = full[column * n + row];
            }
        }
        full
    }
}

impl Reduced {
    /// Takes the value of each row and column that the lower triangle holds.
    pub(crate) fn fill(&mut self, value: impl Fn(usize, usize) -> f64) {
        let Some(pattern) = &self.sparse else { return };
        for column in 0..pattern.values.len() {
            let (first, height) = pattern.values[column];
            for &(row, place) in &pattern.rows[pattern.start[column]..pattern.start[column + 1]] {
                for (j, at) in (pattern.first[column]..pattern.first[column + 1]).enumerate() {
                    let rows = pattern.first[row]..pattern.first[row + 1];
                    let into = &mut self.values[first + j * height + place..][..rows.len()];
                    into.iter_mut().zip(rows).for_each(|(into, row)| *into = value(row, at));
                }
            }
        }
    }

    /// Whether it has a block of two kept blocks, the row at or below the column.
    pub(crate) fn has(&self, row: usize, column: usize) -> bool {
        let rows =
            |pattern: &Pattern| pattern.rows[pattern.start[column]..pattern.start[column + 1]].binary_search_by_key(&row, |found| found.0);
        self.sparse.as_ref().is_none_or(|pattern| rows(pattern).is_ok())
    }
}
