//! What of a signal is its fundamental.

/// A number with an angle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Complex {
    pub(super) re: f64,
    pub(super) im: f64,
}

impl Complex {
    /// e^(2πi·cycles)
    pub(super) fn turn(cycles: f64) -> Self {
        let (im, re) = libm::sincos(core::f64::consts::TAU * (cycles - libm::round(cycles)));
        Self { re, im }
    }

    pub(super) fn conjugate(self) -> Self {
        Self { im: -self.im, ..self }
    }

    pub(super) fn plus(self, other: Self) -> Self {
        Self { re: self.re + other.re, im: self.im + other.im }
    }

    pub(super) fn times(self, other: Self) -> Self {
        Self { re: self.re * other.re - self.im * other.im, im: self.re * other.im + self.im * other.re }
    }

    pub(super) fn scaled(self, by: f64) -> Self {
        Self { re: self.re * by, im: self.im * by }
    }

    pub(super) fn size(self) -> f64 {
        libm::hypot(self.re, self.im)
    }
}

/// A signal that was sampled evenly over whole cycles.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spectrum {
    pub(super) variance: f64,
    /// C, with the fundamental Re(C·e^(2πi·cycles)).
    pub(super) fundamental: Complex,
}

impl Spectrum {
    /// Of samples (cycles, value).
    pub(super) fn of(samples: impl ExactSizeIterator<Item = (f64, f64)> + Clone) -> Self {
        let count = samples.len() as f64;
        let mean = samples.clone().map(|(_, value)| value).sum::<f64>() / count;
        let (mut variance, mut fundamental) = (0.0, Complex::default());
        for (cycles, value) in samples {
            variance += (value - mean) * (value - mean) / count;
            fundamental = fundamental.plus(Complex::turn(-cycles).scaled(2.0 * (value - mean) / count));
        }
        Self { variance, fundamental }
    }

    /// √(1 − fundamental variance/variance) of several signals together; 0 where nothing varies.
    pub(super) fn rest(all: &[Self]) -> f64 {
        let variance: f64 = all.iter().map(|one| one.variance).sum();
        let fundamental: f64 = all.iter().map(|one| 0.5 * one.fundamental.size() * one.fundamental.size()).sum();
        if variance > 0.0 { (1.0 - fundamental / variance).max(0.0).sqrt() } else { 0.0 }
    }
}

/// The complex amplitudes C_j at the places s_j as a wave that runs towards growing s and one that runs back, C = F·e^(−2πis/λ) + B·e^(2πis/λ), by least
/// squares: the smaller modulus over the larger, or nothing where the two cannot be told apart.
pub(super) fn reflected(amplitudes: impl Iterator<Item = (f64, Complex)>, wavelength: f64) -> Option<f64> {
    let (mut count, mut overlap) = (0.0, Complex::default());
    let (mut forward, mut back) = (Complex::default(), Complex::default());
    for (place, amplitude) in amplitudes {
        let turn = Complex::turn(place / wavelength);
        count += 1.0;
        // Sum of the conjugate of e^(−2πis/λ) times e^(2πis/λ).
        overlap = overlap.plus(turn.times(turn));
        forward = forward.plus(amplitude.times(turn));
        back = back.plus(amplitude.times(turn.conjugate()));
    }
    // (count, overlap; overlap*, count) (F, B) = (forward, back), by Cramer's rule.
    let determinant = count * count - overlap.size() * overlap.size();
    if determinant <= 1e-9 * count * count {
        return None;
    }
    let f = forward.scaled(count).plus(overlap.times(back).scaled(-1.0)).size();
    let b = back.scaled(count).plus(overlap.conjugate().times(forward).scaled(-1.0)).size();
    (f.max(b) > 0.0).then(|| f.min(b) / f.max(b))
}
