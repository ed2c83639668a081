//! Where a step begins to be too large.

/// A step below this part of the one where the search begins counts as 0.
const LEAST: f64 = 1e-3;
/// A method that is stable at so many times the time of the fastest rate has no limit.
pub(crate) const MOST: f64 = 1e4;

/// The smallest step at which `stable` fails, to a part `precision` of itself, for a body whose fastest rate is `rate`: searched in times of that rate, upwards
/// from the first of `range`, and downwards where it fails there. 0 where it fails far below too, infinite where it fails nowhere up to the second.
pub(crate) fn first_unstable(rate: f64, range: [f64; 2], precision: f64, mut stable: impl FnMut(f64) -> bool) -> f64 {
    if rate <= 0.0 {
        return f64::INFINITY;
    }
    let [from, most] = range.map(|part| part / rate);
    let mut low = from;
    if stable(low) {
        while stable(1.4 * low) {
            low *= 1.4;
            if low > most {
                return f64::INFINITY;
            }
        }
        return bisect(low, 1.4 * low, precision, stable);
    }
    while !stable(0.25 * low) {
        low *= 0.25;
        if low < LEAST * from {
            return 0.0;
        }
    }
    bisect(0.25 * low, low, precision, stable)
}

/// The edge between a step that is stable and a larger one that is not, to a part of itself.
pub(crate) fn bisect(mut low: f64, mut high: f64, precision: f64, mut stable: impl FnMut(f64) -> bool) -> f64 {
    while high > low * (1.0 + precision) {
        let middle = (low * high).sqrt();
        if stable(middle) { low = middle } else { high = middle }
    }
    low
}
