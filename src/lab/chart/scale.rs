//! Logarithmic axes.

/// A logarithmic axis: which values it shows, and between which pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LogScale {
    /// The decimal logarithm of the value at `from`.
    low: f64,
    /// That of the value at `to`.
    high: f64,
    /// The pixel of the lowest value.
    from: f64,
    /// The pixel of the highest value.
    to: f64,
}

/// A value at which an axis has a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tick {
    /// The value.
    pub value: f64,
    /// Its digit: 1 for powers of ten.
    pub digit: u32,
    /// The power of ten.
    pub exponent: i32,
    /// Whether it is written.
    pub written: bool,
}

impl LogScale {
    /// No axis spans more, whatever was measured.
    const MOST_DECADES: f64 = 24.0;

    /// An axis that shows all of the positive and finite `values` and at least a decade, with a margin of `margin` of its length at
    /// both ends. Without values it shows `otherwise`.
    pub fn new(values: impl IntoIterator<Item = f64>, otherwise: [f64; 2], margin: f64, from: f64, to: f64) -> Self {
        let logs = values.into_iter().filter(|value| value.is_finite() && *value > 0.0).map(libm::log10);
        let range = logs.fold(None, |range: Option<(f64, f64)>, log| {
            let (low, high) = range.unwrap_or((log, log));
            Some((low.min(log), high.max(log)))
        });
        let (mut low, mut high) = range.unwrap_or((libm::log10(otherwise[0]), libm::log10(otherwise[1])));
        let missing = (1.0 - (high - low)).max(0.0) / 2.0;
        (low, high) = (low - missing, (high + missing).min(low - missing + Self::MOST_DECADES));
        let margin = (margin * (high - low)).max(0.12);
        Self { low: low - margin, high: high + margin, from, to }
    }

    /// The pixel of a value; outside of the axis for what it does not show, and at its low end for zero.
    pub fn place(&self, value: f64) -> f64 {
        self.place_log(if value > 0.0 { libm::log10(value) } else { self.low })
    }

    /// The pixel of a value, at the nearer end for what the axis does not show.
    pub fn place_within(&self, value: f64) -> f64 {
        self.place(value).clamp(self.from.min(self.to), self.from.max(self.to))
    }

    /// The pixel of a value by its decimal logarithm.
    pub fn place_log(&self, log: f64) -> f64 {
        self.from + (log - self.low) / (self.high - self.low) * (self.to - self.from)
    }

    /// The smallest and the largest value that it shows, as decimal logarithms.
    pub fn logs(&self) -> [f64; 2] {
        [self.low, self.high]
    }

    /// Whether it shows a value.
    pub fn shows(&self, value: f64) -> bool {
        value > 0.0 && (self.low..=self.high).contains(&libm::log10(value))
    }

    /// Its lines: at powers of ten, and between them where there is room.
    pub fn ticks(&self) -> Vec<Tick> {
        let span = self.high - self.low;
        let pixels_a_decade = (self.to - self.from).abs() / span;
        let step = (40.0 / pixels_a_decade).ceil().max(1.0) as i32;
        let written_digits: &[u32] = match pixels_a_decade {
            pixels if pixels > 420.0 => &[1, 2, 3, 5],
            pixels if pixels > 210.0 => &[1, 2, 5],
            _ => &[1],
        };
        let digits = if pixels_a_decade > 45.0 { 1..=9 } else { 1..=1 };
        let exponents = self.low.floor() as i32..=self.high.floor() as i32;
        let all = exponents.flat_map(|exponent| digits.clone().map(move |digit| (digit, exponent)));
        all.map(|(digit, exponent)| Tick {
            value: f64::from(digit) * libm::pow(10.0, f64::from(exponent)),
            digit,
            exponent,
            written: written_digits.contains(&digit) && exponent.rem_euclid(step) == 0,
        })
        .filter(|tick| self.shows(tick.value))
        .collect()
    }
}

/// A number in few digits: `0.0125`, `250`, `1.5e-6`.
pub fn short(value: f64) -> String {
    if value == 0.0 {
        return "0".into();
    }
    if !value.is_finite() {
        return value.to_string();
    }
    let trim = |text: String| match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text,
    };
    let exponent = libm::log10(value.abs()).floor();
    if (-4.0..5.0).contains(&exponent) {
        return trim(format!("{value:.*}", (2.0 - exponent).max(0.0) as usize));
    }
    let text = format!("{value:.1e}");
    match text.split_once('e') {
        Some((digits, exponent)) => format!("{}e{exponent}", trim(digits.into())),
        None => text,
    }
}
