//! One picture of the garden at two times, looked at coarsely: what should be where, by colour and coverage.

use bevy::{camera::Camera, prelude::*};
use wriggle::{
    physics::{Clock, PhysicsPlugin, Shown, Ticks},
    scenes::{self, ScenesPlugin},
    view::{Picture, Quality, SceneCamera, Shot, ShotError, adapter},
};

const SIZE: (u32, u32) = (320, 180);

/// Opens the garden as it is shipped, without a window, at time 0.
fn garden() -> Result<Shot, ShotError> {
    let scene = scenes::load("garden").expect("the garden is shipped");
    let mut shot = Shot::new(SIZE, Some(Quality::Low), |app| {
        app.add_plugins((PhysicsPlugin::new(Ticks), ScenesPlugin::new(scene)));
    })?;
    shot.update();
    Ok(shot)
}

/// Lets the worm crawl for a time.
fn pass(shot: &mut Shot, time: f64) {
    let world = shot.world_mut();
    let mut clock = world.resource_mut::<Clock>();
    let steps = (time / clock.dt()).round() as u64;
    clock.set_steps_per_tick(steps);
    world.run_schedule(Ticks);
}

/// A picture, and what is needed to know where things should be in it.
struct Seen {
    picture: Picture,
    camera: (Camera, GlobalTransform),
    worm: Vec<Vec3>,
}

impl Seen {
    fn of(shot: &mut Shot) -> Self {
        let picture = shot.picture().expect("the renderer gives a picture");
        let world = shot.world_mut();
        let mut cameras = world.query_filtered::<(&Camera, &GlobalTransform), With<SceneCamera>>();
        let (camera, place) = cameras.single(world).expect("one camera");
        let camera = (camera.clone(), *place);
        let mut bodies = world.query::<&Shown>();
        let worm = bodies.single(world).expect("one worm").positions().to_vec();
        Self { picture, camera, worm }
    }

    /// Where a point of the garden is in the picture.
    fn project(&self, point: Vec3) -> Vec2 {
        self.camera.0.world_to_viewport(&self.camera.1, point).expect("the point is in front of the camera")
    }

    fn pixels(&self, least: Vec2, most: Vec2) -> impl Iterator<Item = (Vec2, [f32; 3])> {
        let clamp = |at: f32, size: u32| (at.round().max(0.0) as u32).min(size);
        let (x0, x1) = (clamp(least.x, SIZE.0), clamp(most.x, SIZE.0));
        let (y0, y1) = (clamp(least.y, SIZE.1), clamp(most.y, SIZE.1));
        (y0..y1).flat_map(move |y| {
            (x0..x1).map(move |x| (Vec2::new(x as f32, y as f32), self.picture.pixel(x, y).map(f32::from)))
        })
    }

    /// The mean colour of a rectangle.
    fn mean(&self, least: Vec2, most: Vec2) -> [f32; 3] {
        let (mut sum, mut count) = ([0.0; 3], 0.0);
        for (_, color) in self.pixels(least, most) {
            sum = core::array::from_fn(|i| sum[i] + color[i]);
            count += 1.0;
        }
        assert!(count > 0.0, "{least} to {most} is outside of the picture");
        sum.map(|channel| channel / count)
    }

    /// The mean colour around a point of the garden.
    fn around(&self, point: Vec3, reach: f32) -> [f32; 3] {
        let at = self.project(point);
        self.mean(at - reach, at + reach + 1.0)
    }

    /// The rectangle of the picture that the worm should fill.
    fn worm_box(&self) -> (Vec2, Vec2) {
        let (tail, head) = (self.worm[0], self.worm[2]);
        let (a, b) = (self.project(tail - Vec3::X * 0.5), self.project(head + Vec3::new(0.5, 0.8, 0.0)));
        (a.min(b), a.max(b))
    }

    /// The worm's own pixels in a rectangle: skin, and rings.
    fn worm_pixels(&self, (least, most): (Vec2, Vec2)) -> (Vec<Vec2>, Vec<Vec2>) {
        let (mut skin, mut rings) = (Vec::new(), Vec::new());
        for (at, [r, g, b]) in self.pixels(least, most) {
            if r > 150.0 && r - g > 35.0 && b > 85.0 && r - b > 15.0 {
                skin.push(at);
            } else if r > 150.0 && r - g > 50.0 && g - b > 15.0 && b < 110.0 {
                rings.push(at);
            }
        }
        (skin, rings)
    }
}

fn mean(points: &[Vec2]) -> Vec2 {
    points.iter().sum::<Vec2>() / points.len() as f32
}

/// Whether there is an adapter to draw with. Says so where there is none, which is an error where graphics are required.
pub fn can_draw() -> bool {
    let Err(missing) = adapter() else { return true };
    assert!(std::env::var_os("WRIGGLE_REQUIRE_GRAPHICS").is_none_or(|asked| asked != "1"), "{missing}");
    eprintln!("skipped what is drawn: {missing}");
    false
}

#[test]
fn the_garden_shows_what_is_in_it_and_the_worm_moves() {
    if !can_draw() {
        return;
    }
    let mut shot = garden().expect("there is an adapter");
    pass(&mut shot, 0.0);
    let before = Seen::of(&mut shot);
    pass(&mut shot, 12.0);
    let after = Seen::of(&mut shot);
    if let Some(folder) = std::env::var_os("WRIGGLE_KEEP_PICTURES") {
        for (seen, name) in [(&before, "garden-before.png"), (&after, "garden-after.png")] {
            seen.picture.save(&std::path::Path::new(&folder).join(name)).expect("the folder can be written to");
        }
    }

    let (width, height) = (SIZE.0 as f32, SIZE.1 as f32);
    for seen in [&before, &after] {
        let [r, g, b] = seen.mean(Vec2::ZERO, Vec2::new(width, height * 0.06));
        assert!(b > 150.0 && b > r + 20.0 && b >= g, "the sky is blue: {r} {g} {b}");
        let [r, g, b] = seen.mean(Vec2::new(0.0, height * 0.9), Vec2::new(width, height));
        assert!(g > 70.0 && g > r * 1.15 && g > b * 1.5, "the grass is green: {r} {g} {b}");
        let [r, g, b] = seen.around(Vec3::new(12.0, 2.9, 1.0), 5.0);
        assert!(r > 120.0 && r > g * 1.25 && g > b, "the roof is of red tiles: {r} {g} {b}");
        let [r, g, b] = seen.around(Vec3::new(10.28, 1.2, 1.9), 1.0);
        assert!(r > 150.0 && g > 130.0 && (r - b).abs() < 70.0, "the walls are pale: {r} {g} {b}");
        for pot in [Vec3::new(9.15, 0.35, -1.35), Vec3::new(4.1, 0.5, -1.3)] {
            let [r, g, b] = seen.around(pot, 1.0);
            assert!(r > 90.0 && r > g * 1.3 && g > b, "a pot of clay stands at {pot}: {r} {g} {b}");
        }

        let area = seen.worm_box();
        let (skin, rings) = seen.worm_pixels(area);
        let all = (area.1 - area.0).element_product();
        let (skin, rings) = (skin.len() as f32 / all, rings.len() as f32 / all);
        assert!(skin > 0.15, "the worm's skin covers {skin} of where it should be");
        assert!(rings > 0.08, "its rings cover {rings} of where it should be");
        // Further along the path there is gravel and no worm.
        let ahead = [Vec3::new(5.6, 0.0, 0.0), Vec3::new(8.0, 0.4, 0.0)].map(|at| seen.project(at));
        let (skin, rings) = seen.worm_pixels((ahead[0].min(ahead[1]), ahead[0].max(ahead[1])));
        assert!(skin.len() + rings.len() < 12, "there is no worm ahead: {} {}", skin.len(), rings.len());
    }

    // Both pictures are searched in the same place, which holds the worm of either.
    let (a, b) = (before.worm_box(), after.worm_box());
    let both = (a.0.min(b.0) - 2.0, a.1.max(b.1) + 2.0);
    let found = [&before, &after].map(|seen| {
        let (skin, rings) = seen.worm_pixels(both);
        mean(&[skin, rings].concat())
    });
    let middle = |seen: &Seen| seen.project(seen.worm.iter().sum::<Vec3>() / 3.0 + Vec3::Y * 0.4);
    let (moved, due) = (found[1].x - found[0].x, middle(&after).x - middle(&before).x);
    assert!(due > 5.0, "the worm was to move in this time: {due} pixels");
    assert!((moved - due).abs() < 1.0 + 0.15 * due, "the worm moved {moved} pixels and not {due}");
}

/// Mesa's software renderer compiles a shader again at every draw for a uniform that decides a branch, and keeps all of them.
#[test]
fn frames_take_no_memory_that_they_do_not_give_back() {
    // Megabytes, where the system tells.
    let resident = || {
        let pages = std::fs::read_to_string("/proc/self/statm").ok()?.split_whitespace().nth(1)?.parse::<u32>().ok()?;
        Some(f64::from(pages) * 4096.0 / 1e6)
    };
    if !can_draw() || resident().is_none() {
        return;
    }
    let mut shot = garden().expect("there is an adapter");
    for _ in 0..10 {
        shot.update();
    }
    let before = resident().unwrap();
    for _ in 0..40 {
        shot.update();
    }
    // Other tests run beside this one and take some; 40 frames of what went wrong took more than a thousand.
    let grown = resident().unwrap() - before;
    assert!(grown < 400.0, "40 frames took {grown:.0} MB");
}
