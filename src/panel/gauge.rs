//! The gauge of dt against the stability limit. It judges the setting and not the state: it is red before anything explodes.

use bevy_egui::egui::{self, Color32, CornerRadius, Sense, pos2, vec2};

use super::{colors, setting::number_text, settings::Settings};

/// dt against the stability limit of one body.
#[derive(Clone, Debug, PartialEq)]
pub struct Gauge {
    /// The step.
    pub dt: f64,
    /// The largest stable step; infinite where nothing can explode.
    pub limit: f64,
    /// The body.
    pub body: String,
}

/// How a step stands to its limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stability {
    /// Below half of the limit.
    Safe,
    /// From half of the limit up to it: stable, and not accurate.
    Close,
    /// At the limit or above: it explodes.
    Unstable,
}

impl Gauge {
    /// dt as a fraction of the limit.
    pub fn fraction(&self) -> f64 {
        self.dt / self.limit
    }

    /// How dt stands to the limit.
    pub fn stability(&self) -> Stability {
        match self.fraction() {
            fraction if fraction < 0.5 => Stability::Safe,
            fraction if fraction < 1.0 => Stability::Close,
            // A limit that is no number is none to trust.
            _ => Stability::Unstable,
        }
    }

    /// dt against the limit in words.
    pub fn words(&self) -> String {
        if self.limit == f64::INFINITY {
            return format!("dt {}: nothing here sets a limit", number_text(self.dt));
        }
        let (dt, limit) = (number_text(self.dt), number_text(round(self.limit)));
        format!("dt {dt} is {} % of the limit {limit}", percent(self.fraction()))
    }

    /// What that means, and what to do.
    pub fn advice(&self) -> String {
        match self.stability() {
            Stability::Safe => format!("{}: stable", self.body),
            Stability::Close => format!("{}: stable but coarse; half of the limit is safe", self.body),
            Stability::Unstable => format!("{}: will explode; lower dt, k or D, or make masses heavier", self.body),
        }
    }
}

impl Stability {
    /// The colour that says so.
    pub fn color(self) -> Color32 {
        match self {
            Self::Safe => colors::GREEN,
            Self::Close => colors::AMBER,
            Self::Unstable => colors::RED,
        }
    }

    /// The sign that says so without the colour.
    pub fn sign(self) -> &'static str {
        match self {
            Self::Safe => "✔",
            Self::Close => "⚠",
            Self::Unstable => "✖",
        }
    }
}

/// The gauge: a bar, the numbers and what they mean.
pub fn section(ui: &mut egui::Ui, settings: &mut Settings) {
    let Some(gauge) = &settings.gauge else { return };
    let stability = gauge.stability();
    bar(ui, gauge.fraction(), stability.color());
    ui.colored_label(stability.color(), gauge.words());
    ui.label(egui::RichText::new(format!("{} {}", stability.sign(), gauge.advice())).small()).on_hover_text(
        "A step above the limit lets the springs answer with more than they were given, more at every step.",
    );
}

/// A bar from 0 to a quarter beyond the limit, with marks at half of it and at it.
fn bar(ui: &mut egui::Ui, fraction: f64, color: Color32) {
    const SPAN: f32 = 1.25;
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), 10.0), Sense::hover());
    let painter = ui.painter();
    let corner = CornerRadius::same(3);
    painter.rect_filled(rect, corner, colors::WELL);
    // A sliver is always seen, so that the bar reads as one.
    let filled = (fraction as f32 / SPAN).clamp(0.012, 1.0);
    painter.rect_filled(rect.with_max_x(rect.left() + rect.width() * filled), corner, color);
    for (mark, gray) in [(0.5, 0x70), (1.0, 0xf0)] {
        let x = rect.left() + rect.width() * mark / SPAN;
        painter.line_segment([pos2(x, rect.top()), pos2(x, rect.bottom())], (1.5, Color32::from_gray(gray)));
    }
}

/// Four significant digits: a limit is a bound, not a measurement.
fn round(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}

fn percent(fraction: f64) -> String {
    let percent = fraction * 100.0;
    match percent {
        percent if percent < 0.05 => "less than 0.1".into(),
        percent if percent < 9.95 => format!("{percent:.1}"),
        percent => format!("{percent:.0}"),
    }
}
