//! Pictures without a window.

use std::path::Path;

use bevy::{
    asset::RenderAssetUsages,
    camera::RenderTarget,
    prelude::*,
    render::{
        RenderPlugin,
        pipelined_rendering::PipelinedRenderingPlugin,
        render_resource::{Extent3d, PollType, TextureDimension, TextureFormat, TextureUsages},
        renderer::RenderDevice,
        view::screenshot::{Screenshot, ScreenshotCaptured},
    },
    window::ExitCondition,
    winit::WinitPlugin,
};

use super::{
    ViewPlugin,
    adapter::{NoAdapter, adapter},
    quality::Quality,
    window::quiet_assets,
};

/// What the scene's camera draws into where there is no window.
#[derive(Clone, Debug, Resource)]
pub(super) struct OffscreenTarget(pub RenderTarget);

/// Why there is no picture.
#[derive(Debug, thiserror::Error)]
pub enum ShotError {
    /// There is nothing to draw with.
    #[error(transparent)]
    NoAdapter(#[from] NoAdapter),
    /// The size is not one that can be drawn.
    #[error("a picture of {0}x{1} cannot be drawn; give a width and a height from 1 to 8192")]
    Size(u32, u32),
    /// The renderer gave no picture back.
    #[error("the renderer gave no picture back")]
    Lost,
    /// The picture could not be written.
    #[error("{path}: {problem}")]
    Write {
        /// The file.
        path: String,
        /// What went wrong, for people.
        problem: String,
    },
}

/// An app that draws into a picture instead of a window.
pub struct Shot {
    app: App,
    target: Handle<Image>,
}

impl Shot {
    /// Builds an app with the renderer and [`ViewPlugin`], whose pictures are `width` × `height` pixels. `build` adds the physics and the
    /// scene. Frames do not advance time unless `build` or the caller says so
    /// ([`TimeUpdateStrategy`](bevy::time::TimeUpdateStrategy)): the caller steps the physics to the time of the
    /// picture through [`world_mut`](Self::world_mut).
    ///
    /// # Errors
    /// If there is no graphics adapter or the size cannot be drawn.
    pub fn new(
        (width, height): (u32, u32),
        quality: Option<Quality>,
        build: impl FnOnce(&mut App),
    ) -> Result<Self, ShotError> {
        if !(1..=8192).contains(&width) || !(1..=8192).contains(&height) {
            return Err(ShotError::Size(width, height));
        }
        adapter()?;
        let mut app = App::new();
        let window = WindowPlugin { primary_window: None, exit_condition: ExitCondition::DontExit, ..default() };
        let render = RenderPlugin { synchronous_pipeline_compilation: true, ..default() };
        app.add_plugins(
            DefaultPlugins
                .set(window)
                .set(render)
                .set(quiet_assets())
                .disable::<WinitPlugin>()
                // One frame after the other, so that a picture is of the frame that asked for it.
                .disable::<PipelinedRenderingPlugin>(),
        );
        let size = Extent3d { width, height, depth_or_array_layers: 1 };
        let format = TextureFormat::Rgba8UnormSrgb;
        let mut image = Image::new_uninit(size, TextureDimension::D2, format, RenderAssetUsages::RENDER_WORLD);
        image.texture_descriptor.usage |= TextureUsages::RENDER_ATTACHMENT;
        let target = app.world_mut().resource_mut::<Assets<Image>>().add(image);
        app.insert_resource(OffscreenTarget(target.clone().into()))
            .insert_resource(bevy::time::TimeUpdateStrategy::ManualDuration(core::time::Duration::ZERO))
            .add_plugins(ViewPlugin { quality });
        build(&mut app);
        app.finish();
        app.cleanup();
        Ok(Self { app, target })
    }

    /// The world: for stepping the physics, moving the camera and reading what is shown.
    pub fn world_mut(&mut self) -> &mut World {
        self.app.world_mut()
    }

    /// Runs one frame, drawing included.
    pub fn update(&mut self) {
        self.app.update();
        // Frames that pile up on a software renderer only cost memory.
        let _ = self.app.world().resource::<RenderDevice>().wgpu_device().poll(PollType::wait_indefinitely());
    }

    /// Draws the world as it is now.
    ///
    /// # Errors
    /// If the renderer gives nothing back.
    pub fn picture(&mut self) -> Result<Picture, ShotError> {
        // The first frames build pipelines and upload meshes.
        for _ in 0..3 {
            self.update();
        }
        let (send, receive) = std::sync::mpsc::channel();
        self.app.world_mut().spawn(Screenshot::image(self.target.clone())).observe(
            move |shot: On<ScreenshotCaptured>| {
                // Nobody waits any more once a picture has come.
                let _ = send.send(shot.image.clone());
            },
        );
        for _ in 0..20 {
            self.update();
            if let Ok(image) = receive.try_recv() {
                return Picture::new(image).ok_or(ShotError::Lost);
            }
        }
        Err(ShotError::Lost)
    }
}

/// A finished picture.
pub struct Picture {
    image: Image,
    width: u32,
    height: u32,
    pixels: Vec<u8>,
}

impl Picture {
    fn new(image: Image) -> Option<Self> {
        let pixels = image.data.clone()?;
        let (width, height) = (image.width(), image.height());
        (pixels.len() == (width * height * 4) as usize).then_some(Self { image, width, height, pixels })
    }

    /// Its width in pixels.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Its height in pixels.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// The colour of a pixel, red, green and blue as they are shown; x to the right, y down, inside of the picture.
    pub fn pixel(&self, x: u32, y: u32) -> [u8; 3] {
        let at = ((y * self.width + x) * 4) as usize;
        [self.pixels[at], self.pixels[at + 1], self.pixels[at + 2]]
    }

    /// Writes it as a PNG file.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn save(&self, path: &Path) -> Result<(), ShotError> {
        let problem = |problem: String| ShotError::Write { path: path.display().to_string(), problem };
        let image = self.image.clone().try_into_dynamic().map_err(|error| problem(error.to_string()))?;
        image.to_rgb8().save(path).map_err(|error| problem(error.to_string()))
    }
}
