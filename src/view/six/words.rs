//! What the creatures are at, in words at the edge of the window.

use bevy::prelude::*;
use bevy_egui::{
    EguiContexts, EguiPrimaryContextPass,
    egui::{self, Align2, Color32, RichText},
};

use crate::{
    body::{Bonds, Collisions, Columns, Particles, Rule, Rules},
    mechanics::six_matrix::{Road, SixParts, look},
    scenes::SceneBodies,
};

pub(in crate::view) fn plugin(app: &mut App) {
    app.add_systems(EguiPrimaryContextPass, write);
}

type Bodies<'w, 's> = Query<
    'w,
    's,
    (
        &'static Name,
        &'static Particles,
        &'static Columns,
        &'static Bonds,
        &'static Collisions,
        &'static Rules,
        Option<&'static Road>,
    ),
>;

/// One line a creature: which beams miss and what is decided, or the phase of the muscle and which legs grip.
fn write(mut contexts: EguiContexts, scene: Option<Res<SceneBodies>>, bodies: Bodies) -> Result {
    let line = |(name, particles, columns, bonds, collisions, rules, road)| {
        let parts = SixParts { particles, columns, bonds, collisions, rules, road, pull: None };
        Some(format!("{}: {}", Name::as_str(name), words(&parts)?))
    };
    // As the scene lists them: queries go by what components a body has just now.
    let listed = scene.iter().flat_map(|scene| &scene.0);
    let lines: Vec<_> = listed.filter_map(|body| line(bodies.get(*body).ok()?)).collect();
    if lines.is_empty() {
        return Ok(());
    }
    egui::Area::new("six words".into()).anchor(Align2::CENTER_BOTTOM, [0.0, -14.0]).interactable(false).show(
        contexts.ctx_mut()?,
        |ui| {
            egui::Frame::popup(ui.style()).show(ui, |ui| {
                for line in lines {
                    ui.label(RichText::new(line).color(Color32::WHITE));
                }
            });
        },
    );
    Ok(())
}

fn words(parts: &SixParts<'_>) -> Option<String> {
    let mut words = Vec::new();
    for rule in parts.rules.iter() {
        match rule {
            Rule::Counter(counter) => {
                let count = parts.columns.memory().get(counter.on.first()?.index())?.x;
                let phase = if count > 0.0 { "contracts" } else { "relaxes" };
                words.push(format!("{phase}, step {:.0} of {:.0}", count.abs(), counter.half));
            }
            Rule::Drive(drive) => {
                let position: Vec<_> = parts.particles.positions().collect();
                let sight = look(drive, &position, parts.road);
                let wheel = |goal: f64| match goal {
                    goal if goal > 0.0 => "forwards",
                    goal if goal < 0.0 => "backwards",
                    _ => "free",
                };
                let (left, right) = sight.goals;
                words.push(format!(
                    "beams that miss: {}; left {}, right {}",
                    sight.decision(),
                    wheel(left),
                    wheel(right)
                ));
            }
            _ => {}
        }
    }
    let legs: Vec<_> = parts.grips().map(|(_, grips)| if grips { "grips" } else { "free" }).collect();
    if !legs.is_empty() {
        words.push(format!("legs from the front: {}", legs.join(", ")));
    }
    Some(words.join("; "))
}
