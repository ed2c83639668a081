//! A strand at one moment.

use bevy::math::DVec3;

use crate::{
    body::{Ground, Particles, Springs, Strand},
    mechanics::{BodyParts, ground_distance, rest_lengths},
};

fn corner(particles: &Particles, strand: Strand, section: usize, corner: usize) -> DVec3 {
    particles.position(strand.section(section)[corner]).unwrap_or_default()
}

/// The length of a strand at rest: of each segment the mean rest length of its four axial edges.
pub fn length_at_rest(springs: &Springs, strand: Strand) -> f64 {
    let axial = |segment: usize| {
        let edges = (0..4).filter_map(move |corner| springs.get(strand.axial(segment, corner)));
        edges.map(|spring| spring.rest_length / 4.0).sum::<f64>()
    };
    (0..strand.segments()).map(axial).sum()
}

/// The centre of a section, counted from the tail.
pub fn section_center(particles: &Particles, strand: Strand, section: usize) -> DVec3 {
    (0..4).map(|c| corner(particles, strand, section, c)).sum::<DVec3>() / 4.0
}

/// The spine vector of a section: from the centre of the section behind it to that of the one in front of it, one-sided at the ends.
pub fn spine_vector(particles: &Particles, strand: Strand, section: usize) -> DVec3 {
    let ahead = section_center(particles, strand, (section + 1).min(strand.segments()));
    (ahead - section_center(particles, strand, section.saturating_sub(1))).normalize_or_zero()
}

/// The direction from the tail to the head seen from above: the angle from +x towards +z, in radians from −π to π.
pub fn heading(particles: &Particles, strand: Strand) -> f64 {
    let along = section_center(particles, strand, strand.segments()) - section_center(particles, strand, 0);
    libm::atan2(along.z, along.x)
}

/// The mean length of the four axial edges of a segment.
pub fn segment_length(particles: &Particles, strand: Strand, segment: usize) -> f64 {
    axial_lengths(particles, strand, segment).iter().sum::<f64>() / 4.0
}

/// By how much the left side of a segment is longer than the right one: ½[(l_LB + l_LT) − (l_RB + l_RT)].
pub fn bend(particles: &Particles, strand: Strand, segment: usize) -> f64 {
    let [left_bottom, right_bottom, right_top, left_top] = axial_lengths(particles, strand, segment);
    0.5 * ((left_bottom + left_top) - (right_bottom + right_top))
}

fn axial_lengths(particles: &Particles, strand: Strand, segment: usize) -> [f64; 4] {
    core::array::from_fn(|c| corner(particles, strand, segment, c).distance(corner(particles, strand, segment + 1, c)))
}

/// How wide a section is: the mean of its lower and its upper edge.
pub fn section_width(particles: &Particles, strand: Strand, section: usize) -> f64 {
    let at = |c| corner(particles, strand, section, c);
    0.5 * (at(0).distance(at(1)) + at(2).distance(at(3)))
}

/// The volume of a segment, as six tetrahedra round a diagonal of its cube: 1 at rest for cubes of edge 1, below 0 inside out. The best single sign of a
/// strand's health.
pub fn cell_volume(particles: &Particles, strand: Strand, segment: usize) -> f64 {
    hexahedron_volume(|i| corner(particles, strand, segment + i / 4, i % 4))
}

/// The first segment that is inside out, with a [volume](cell_volume) below 0. Every mass is read once, so that a strand can be asked after every tick.
pub fn inverted_segment(particles: &Particles, strand: Strand) -> Option<usize> {
    let corners = |section| core::array::from_fn::<_, 4, _>(|c| corner(particles, strand, section, c));
    let mut behind = corners(0);
    (0..strand.segments()).find(|&segment| {
        let ahead = corners(segment + 1);
        let volume = hexahedron_volume(|i| if i < 4 { behind[i] } else { ahead[i - 4] });
        behind = ahead;
        volume < 0.0
    })
}

/// The volume of a body with the corners of a cube: those of one face in order round it, then those across from them.
pub(super) fn hexahedron_volume(at: impl Fn(usize) -> DVec3) -> f64 {
    let origin = at(0);
    let diagonal = at(6) - origin;
    // The corners round the diagonal from 0 to 6, in order.
    let ring = [5, 4, 7, 3, 2, 1].map(|i| at(i) - origin);
    let six_times: f64 = (0..6).map(|i| diagonal.dot(ring[i].cross(ring[(i + 1) % 6]))).sum();
    six_times / 6.0
}

/// Whether both lower masses of a section are off the ground, further than the contact distance. Without a ground nothing is.
pub fn is_lifted(particles: &Particles, strand: Strand, section: usize, ground: Option<&Ground>) -> bool {
    ground.is_some_and(|ground| {
        (0..2).all(|c| ground_distance(ground, corner(particles, strand, section, c)).0 > Ground::CONTACT_DISTANCE)
    })
}

/// l/L − 1 of every spring, with the rest lengths L to which they are driven at `time`.
pub fn strains(body: &BodyParts<'_>, time: f64) -> Vec<f64> {
    let place = |particle| body.particles.position(particle).unwrap_or_default();
    let springs = body.springs.ends().iter().zip(rest_lengths(body, time));
    springs.map(|(&[a, b], rest)| place(a).distance(place(b)) / rest - 1.0).collect()
}
