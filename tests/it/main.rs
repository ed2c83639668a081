//! Integration tests: headless apps, one file a subject.

mod hand;
mod support;

mod alone;
mod animal;
mod animals;
#[cfg(feature = "window")]
mod camera;
mod chart;
mod choosing;
mod cli;
mod clock;
mod closed_forms;
mod contact;
mod crawlers;
mod determinism;
mod edges;
mod exact_worm;
mod failures;
mod files;
mod friction;
mod gait;
mod gallery;
mod garden_worm;
mod jelly;
mod jelly_exercise;
mod jelly_files;
mod jelly_limits;
mod jelly_regular;
mod jelly_springs;
mod jitter;
mod lab;
mod laws;
mod limits;
mod limits_shipped;
mod limits_uneven;
mod methods;
#[cfg(feature = "window")]
mod panel;
#[cfg(feature = "window")]
mod panel_bodies;
#[cfg(feature = "window")]
mod panel_gait;
#[cfg(feature = "window")]
mod panel_pages;
mod parameters;
#[cfg(feature = "window")]
mod picture;
#[cfg(feature = "window")]
mod picture_animals;
mod race;
mod saving;
mod shapes;
mod shows;
mod six_files;
mod six_hand;
mod six_house;
mod six_matrix;
mod six_odd;
#[cfg(feature = "window")]
mod six_rescue;
mod six_roads;
mod six_signs;
mod stability;
mod steering;
mod stiffness;
mod strand;
mod sync;
mod watch;
