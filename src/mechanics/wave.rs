//! The sine of a phase counted in cycles.

use super::Real;

/// Coefficients (−1)^k (2π)^(2k+1)/(2k+1)! of the sine's series in cycles, correctly rounded. The first term left out is below 2e-18 on a
/// quarter cycle.
const SERIES: [f64; 11] = [
    core::f64::consts::TAU,
    -41.34170224039976,
    81.60524927607506,
    -76.70585975306139,
    42.058693944897655,
    -15.09464257682299,
    3.819952584848282,
    -0.7181223017785006,
    0.10422916220813984,
    -0.012031585942120627,
    0.0011309237482517963,
];

/// The nearest whole number. Adding and taking away 1.5·2⁵² leaves no place for a fraction; it works up to 2⁵¹, and rounds ties to even.
#[inline(always)]
fn round<R: Real>(x: R) -> R {
    let shift = R::splat(6_755_399_441_055_744.0);
    (x + shift) - shift
}

/// The part of `cycles` in −½…½ that is left without whole cycles. Exact.
#[inline(always)]
fn fraction<R: Real>(cycles: R) -> R {
    cycles - round(cycles)
}

/// sin(2π·cycles), within 2 units in the last place of 1.
///
/// A phase in cycles is reduced exactly, however large it is (up to 2⁵¹), and quarter turns come out exact. The same bits on every platform and
/// in every lane, which the mathematics libraries of platforms do not promise.
#[inline(always)]
pub fn sin_cycles<R: Real>(cycles: R) -> R {
    let (zero, quarter, half) = (R::splat(0.0), R::splat(0.25), R::splat(0.5));
    let r = fraction(cycles);
    // The second and third quarters mirror the first and the fourth; ½ − r is exact there.
    let mirrored = r.if_below(zero, -half, half) - r;
    let r = quarter.if_below(r.abs(), mirrored, r);
    let square = r * r;
    let mut sum = R::splat(SERIES[SERIES.len() - 1]);
    for &coefficient in SERIES[1..SERIES.len() - 1].iter().rev() {
        sum = sum * square + R::splat(coefficient);
    }
    (sum * square) * r + R::splat(SERIES[0]) * r
}

/// The sign of [`sin_cycles`]: +1, −1, or 0 at whole and half cycles.
#[inline(always)]
pub(super) fn square_cycles<R: Real>(cycles: R) -> R {
    let (zero, one, half) = (R::splat(0.0), R::splat(1.0), R::splat(0.5));
    let r = fraction(cycles);
    let sign = r.if_below(zero, -one, zero.if_below(r, one, zero));
    r.abs().if_below(half, sign, zero)
}
