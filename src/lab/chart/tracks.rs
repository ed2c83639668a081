//! The strip above a panel: which runs blew up, and where each method's stability limit is.

use super::{
    scale::LogScale,
    series::{Cost, Series},
    text::text_width,
};

/// The crosses and the limit of one series.
#[derive(Clone, Debug, PartialEq)]
pub struct Track {
    /// Which series.
    pub series: usize,
    /// Where its runs that blew up are, from the left.
    pub crosses: Vec<f64>,
    /// Where a run with the largest stable step would be.
    pub edge: Option<f64>,
    /// That step, to be written beside it.
    pub label: String,
    /// In which row it is drawn.
    pub row: usize,
}

impl Track {
    /// How high a row is.
    pub const HEIGHT: f64 = 17.0;
    /// The em of a label.
    pub const LABEL_SIZE: f64 = 12.0;
    /// From the limit to its label.
    pub const LABEL_GAP: f64 = 10.0;

    /// The tracks of all series that blew up or can. A limit is drawn once for a method, whatever its stick rule.
    pub fn all(all: &[Series], cost: Cost, duration: f64, x: &LogScale) -> Vec<Self> {
        let mut tracks: Vec<Self> = Vec::new();
        for (i, series) in all.iter().enumerate() {
            let place = |dt| series.cost_of(dt, cost, duration).map(|cost| x.place_within(cost));
            let first = all.iter().position(|other| other.method == series.method) == Some(i);
            let edge = series.edge().filter(|_| first).and_then(place);
            let crosses: Vec<f64> = series.blown.iter().filter_map(|point| place(point.setting.dt)).collect();
            if edge.is_some() || !crosses.is_empty() {
                let label = if edge.is_some() { series.limit_text() } else { String::new() };
                tracks.push(Self { series: i, crosses, edge, label, row: 0 });
            }
        }
        tracks
    }

    /// From where to where it is drawn.
    fn extent(&self) -> [f64; 2] {
        let all = self.crosses.iter().chain(&self.edge);
        let (left, right) =
            all.fold((f64::INFINITY, f64::NEG_INFINITY), |(left, right), &x| (left.min(x), right.max(x)));
        let label = self.edge.map(|edge| edge + Self::LABEL_GAP + text_width(&self.label, Self::LABEL_SIZE));
        [left - 22.0, right.max(label.unwrap_or(right)) + 12.0]
    }
}

/// Gives each track the first row in which it has room.
pub fn pack(mut tracks: Vec<Track>, right: f64) -> Vec<Track> {
    tracks.sort_by(|a, b| a.extent()[0].total_cmp(&b.extent()[0]));
    let mut ends: Vec<f64> = Vec::new();
    for track in &mut tracks {
        let [from, to] = track.extent();
        track.row = ends.iter().position(|&end| end <= from).unwrap_or(ends.len());
        if track.row == ends.len() {
            ends.push(to.min(right));
        } else {
            ends[track.row] = to;
        }
    }
    tracks
}
