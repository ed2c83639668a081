//! What the panel shows and what it asks for, as plain data: sections are tested on it without an app.

use std::path::PathBuf;

use bevy::ecs::prelude::*;

use super::{blocks::BlockLabel, chart::ChartState, gauge::Gauge, race::RunnerInfo, row::Edit, setting::Setting};
use crate::mechanics::integrators::{Method, StickRule};

/// At most this many messages are kept; older ones go.
const MOST_MESSAGES: usize = 5;

/// Everything that the panel's sections show and change. The bridge fills it from the world before the panel is drawn, and afterwards
/// carries out the [`actions`](Self::actions).
#[derive(Clone, Debug, Default, Resource)]
pub struct Settings {
    /// The panel is put away, and only a button to bring it back is shown.
    pub hidden: bool,
    /// Every live parameter, in the order of the registry.
    pub parameters: Vec<Setting>,
    /// The bodies of the scene.
    pub bodies: Vec<BodyInfo>,
    /// Which of the bodies the panel shows.
    pub selected: usize,
    /// What is set for one body is set for all that have it.
    pub together: bool,
    /// The method of the scene.
    pub method: Method,
    /// When friction acts within a step of the scene.
    pub stick: StickRule,
    /// No body of the scene has a method: they follow the rules of the six-matrix particle system.
    pub without_method: bool,
    /// The work-precision chart of the scene.
    pub chart: ChartState,
    /// The runners of a race, the truth first; none where there is no race.
    pub race: Vec<RunnerInfo>,
    /// The labels of blocks side by side; none where there is only one.
    pub blocks: Vec<BlockLabel>,
    /// Whether time stands still.
    pub paused: bool,
    /// While in slow motion: the time scale to go back to.
    pub normal_time_scale: Option<f64>,
    /// The simulated time.
    pub time: f64,
    /// How many steps the scene has taken.
    pub step: u64,
    /// Seconds of a tick.
    pub tick: f64,
    /// What is being typed as steps a tick.
    pub steps_draft: Option<String>,
    /// Why the last steps a tick were not taken.
    pub steps_refusal: Option<String>,
    /// dt against the stability limit of the body that is nearest to its own, or nothing where no body has one.
    pub gauge: Option<Gauge>,
    /// What a frame costs.
    pub cost: CostInfo,
    /// The open scene and how to change it.
    pub files: Files,
    /// What happened, newest last.
    pub messages: Vec<Note>,
    /// What was asked for and is not done yet.
    pub actions: Vec<Action>,
}

/// One body.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyInfo {
    /// Its entity.
    pub entity: Entity,
    /// Its name, with which its parameters' paths begin.
    pub name: String,
    /// Why it is frozen, where it is.
    pub frozen: Option<String>,
}

/// What a frame costs, smoothed so that it can be read.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CostInfo {
    /// Milliseconds from one frame to the next.
    pub frame: f64,
    /// Milliseconds of physics in a frame.
    pub physics: f64,
    /// Steps that the last tick took.
    pub steps_per_tick: u64,
}

/// The open scene and the fields to change it.
#[derive(Clone, Debug, PartialEq)]
pub struct Files {
    /// The title of the open scene.
    pub title: String,
    /// Where it came from.
    pub source: String,
    /// The names of the scenes that can be opened.
    pub scenes: Vec<String>,
    /// The file to save to.
    pub save_to: String,
    /// The file or scene to load.
    pub load_from: String,
}

impl Files {
    /// Where the settings are saved unless another file is named.
    pub const OWN: &str = "my-garden.scene.ron";
}

impl Default for Files {
    fn default() -> Self {
        Self {
            title: String::new(),
            source: String::new(),
            scenes: Vec::new(),
            save_to: Self::OWN.into(),
            load_from: Self::OWN.into(),
        }
    }
}

/// Something to tell the user.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Note {
    /// Something went wrong.
    pub problem: bool,
    /// What, for people.
    pub text: String,
}

/// Something that the user asked for. The bridge does it after the panel is drawn.
#[derive(Clone, Debug, PartialEq)]
pub enum Action {
    /// Set the parameter at `path`.
    Set {
        /// The parameter's path.
        path: String,
        /// Its new value.
        value: f64,
    },
    /// Move every body by this method.
    Method(Method),
    /// Measure the work-precision chart of the scene.
    Measure,
    /// Step one body by this method.
    MethodOf(Entity, Method),
    /// Stop time, or let it go on.
    Pause(bool),
    /// Take exactly one tick, and stand still.
    Tick,
    /// Put every body back to where it started.
    Restart,
    /// Save the scene with its changed parameters.
    Save(PathBuf),
    /// Open another scene, by name or file.
    Load(String),
    /// Open the same scene again from its file.
    Reload,
}

impl Settings {
    /// The parameter at `path`.
    pub fn get(&self, path: &str) -> Option<&Setting> {
        self.parameters.iter().find(|setting| setting.path == path)
    }

    /// The parameter at `path`, to change.
    pub fn get_mut(&mut self, path: &str) -> Option<&mut Setting> {
        self.parameters.iter_mut().find(|setting| setting.path == path)
    }

    /// The body that the panel shows.
    pub fn body(&self) -> Option<&BodyInfo> {
        self.bodies.get(self.selected)
    }

    /// Sets the parameter at `path` by what a row of it answered, and asks for the change in the world.
    pub fn request(&mut self, path: &str, value: f64) {
        if let Some(setting) = self.get_mut(path) {
            setting.value = value;
            setting.refusal = None;
        }
        self.actions.push(Action::Set { path: path.into(), value });
    }

    /// Does to the parameter at `path` what was done to its row.
    pub(super) fn edit(&mut self, path: &str, edit: Edit) {
        let Some(setting) = self.get(path) else { return };
        let value = match edit {
            Edit::Value(value) => value,
            Edit::Reset => setting.default,
        };
        self.request(path, value);
    }

    /// The step, 0 while it is not known.
    pub fn dt(&self) -> f64 {
        self.get("clock.dt").map_or(0.0, |setting| setting.value)
    }

    /// Stops time or lets it go on.
    pub fn pause(&mut self, paused: bool) {
        self.paused = paused;
        self.actions.push(Action::Pause(paused));
    }

    /// Asks for one tick, after which time stands still.
    pub fn tick(&mut self) {
        self.paused = true;
        self.actions.push(Action::Tick);
    }

    /// Tells the user something. The same text twice in a row is told once.
    pub fn tell(&mut self, problem: bool, text: impl Into<String>) {
        let note = Note { problem, text: text.into() };
        if self.messages.last() != Some(&note) {
            self.messages.push(note);
        }
        let surplus = self.messages.len().saturating_sub(MOST_MESSAGES);
        self.messages.drain(..surplus);
    }
}
