//! The roads of a scene.

use std::collections::BTreeMap;

use super::{
    FileError, SceneFile,
    load::{conflict, named_in},
};
use crate::{
    creatures::{
        RoadForm,
        library::{self, ROAD, Source},
    },
    mechanics::six_matrix::Road,
};

/// Roads by the names that a scene calls them. Creatures on the same road share its particles.
#[derive(Clone, Debug, Default)]
pub(super) struct Roads(BTreeMap<String, (Source, RoadForm, Road)>);

impl Roads {
    /// Reads and builds every road that a scene names.
    pub(super) fn read(file: &SceneFile, scene: &Source) -> Result<Self, FileError> {
        let mut roads = Self::default();
        let own = file.creatures.iter().enumerate();
        let own = own.filter_map(|(i, placement)| Some((format!("creatures[{i}].road"), placement.road.as_ref()?)));
        for (path, name) in own.chain(file.road.iter().map(|road| ("road".into(), road))) {
            if roads.0.contains_key(name) {
                continue;
            }
            let source = library::find(ROAD, name, scene.folder()).map_err(|error| named_in(scene, path, error))?;
            let form = library::read_road(&source)?.form;
            let road = form.build().map_err(|error| conflict(&source, error))?;
            roads.0.insert(name.clone(), (source, form, road));
        }
        Ok(roads)
    }

    pub(super) fn get(&self, name: &str) -> Option<(&RoadForm, &Road)> {
        self.0.get(name).map(|(_, form, road)| (form, road))
    }

    pub(super) fn source(&self, name: &str) -> Option<&Source> {
        self.0.get(name).map(|(source, ..)| source)
    }

    pub(super) fn sources(&self) -> impl Iterator<Item = &Source> {
        self.0.values().map(|(source, ..)| source)
    }
}
