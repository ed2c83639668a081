//! The eigenvalues of a matrix that is not symmetric.

use faer::{
    Auto, Mat, Par, Spec, c64,
    diag::Diag,
    dyn_stack::{MemBuffer, MemStack},
    linalg::evd::{ComputeEigenvectors, EvdParams, SchurParams, evd_real, evd_scratch},
};

/// All eigenvalues of a square matrix by the QR algorithm with two shifts; nothing where it does not converge, or something is not finite.
///
/// faer's `Mat::eigenvalues` goes over to many shifts and early deflation from 75 rows on, and sorts the window that it deflates by size. With pairs of
/// equal size, which all undamped oscillations of a step are, that was seen to go on for ever. For some hundreds of rows two shifts take hardly longer.
pub(crate) fn eigenvalues(matrix: &Mat<f64>) -> Option<Vec<c64>> {
    let count = matrix.nrows();
    if count == 0 {
        return Some(Vec::new());
    }
    if matrix.col_iter().any(|column| column.iter().any(|value| !value.is_finite())) {
        return None;
    }
    let automatic = <EvdParams as Auto<f64>>::auto();
    let schur = SchurParams { blocking_threshold: usize::MAX, ..automatic.schur };
    let params = Spec::new(EvdParams { schur, ..automatic });
    let none = ComputeEigenvectors::No;
    let mut memory = MemBuffer::try_new(evd_scratch::<f64>(count, none, none, Par::Seq, params)).ok()?;
    let (mut real, mut imaginary) = (Diag::zeros(count), Diag::zeros(count));
    let stack = MemStack::new(&mut memory);
    evd_real(matrix.as_ref(), real.as_mut(), imaginary.as_mut(), None, None, Par::Seq, stack, params).ok()?;
    let parts = real.column_vector().iter().zip(imaginary.column_vector().iter());
    Some(parts.map(|(&re, &im)| c64::new(re, im)).collect())
}
