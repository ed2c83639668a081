//! The gait of the animal that the panel shows, in numbers.

use bevy::ecs::prelude::*;
use bevy_egui::egui::{self, RichText};

use crate::{
    mechanics::{
        BodyParts,
        metrics::{Gait, GaitMetrics},
    },
    physics::Clock,
};

/// Watches the gait of one animal.
#[derive(Clone, Debug, Default)]
pub struct GaitWatch {
    gait: Option<(Entity, Gait)>,
    /// When it was looked at last, and measured last.
    seen: f64,
    measured: f64,
    /// The gait of the last cycles; nothing before a cycle is over.
    pub metrics: Option<GaitMetrics>,
}

impl GaitWatch {
    /// Looks at a body after a tick. Another body or a time that went back begin anew, and so do other waves.
    pub fn look(&mut self, entity: Entity, body: &BodyParts<'_>, clock: &Clock) {
        let time = clock.time();
        let known = self.gait.as_ref().is_some_and(|(known, gait)| {
            let period = body.waves.and_then(|waves| waves.longest_period());
            *known == entity && time >= self.seen && Some(gait.period()) == period
        });
        if !known {
            let gait = Gait::new(body).map(|gait| (entity, gait));
            *self = Self { gait, seen: time, measured: time, metrics: None };
        }
        self.seen = time;
        let Some((_, gait)) = &mut self.gait else { return };
        gait.sample(body, time, clock.dt());
        // Often enough to be read, and seldom enough to cost nothing.
        if time - self.measured >= 0.125 * gait.period() {
            self.measured = time;
            self.metrics = gait.measure();
        }
    }

    /// Whether the body that was seen last has a gait.
    pub fn is_of_animal(&self) -> bool {
        self.gait.is_some()
    }
}

/// The metrics as a table of two columns.
pub fn section(ui: &mut egui::Ui, watch: &GaitWatch) {
    if !watch.is_of_animal() {
        return;
    }
    ui.add_space(4.0);
    ui.label(RichText::new("gait over the last cycles").size(12.0));
    let Some(metrics) = &watch.metrics else {
        ui.weak("It is known once a cycle is over.");
        return;
    };
    egui::Grid::new("gait").num_columns(4).spacing([10.0, 1.0]).show(ui, |ui| {
        for pair in rows(metrics).chunks(2) {
            for (name, value) in pair {
                ui.label(RichText::new(*name).size(11.5).weak());
                ui.label(RichText::new(value).size(11.5));
            }
            ui.end_row();
        }
    });
}

/// What is shown of a gait: names and values.
fn rows(metrics: &GaitMetrics) -> [(&'static str, String); 10] {
    let per_cent = |part: f64| format!("{:.0} %", 100.0 * part);
    [
        ("a cycle", format!("{:.3} of its length", metrics.body_lengths)),
        ("angle", format!("{:.1}°", metrics.angle)),
        ("turn", format!("{:.1}° a cycle", metrics.turn)),
        ("slip", per_cent(metrics.slip)),
        ("lifted", per_cent(metrics.lifted)),
        ("off the path", format!("{:.3}", metrics.path_error)),
        ("worst strain", per_cent(metrics.worst_strain)),
        ("residue", per_cent(metrics.residue)),
        ("smallest cell", format!("{:.2}", metrics.smallest_cell)),
        ("cycles", metrics.cycles.to_string()),
    ]
}
