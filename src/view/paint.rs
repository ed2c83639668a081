//! The material that everything in a scene is painted with.

use bevy::{
    asset::{load_internal_asset, uuid_handle},
    mesh::MeshVertexBufferLayoutRef,
    pbr::{Material, MaterialPipeline, MaterialPipelineKey, MaterialPlugin},
    prelude::*,
    render::render_resource::{AsBindGroup, RenderPipelineDescriptor, SpecializedMeshPipelineError},
    shader::ShaderRef,
};

const SHADER: Handle<Shader> = uuid_handle!("b1b5d9a4-5e0e-4f0b-9d54-6d2a3f1c8e77");

pub(super) fn plugin(app: &mut App) {
    load_internal_asset!(app, SHADER, "paint.wgsl", Shader::from_wgsl);
    app.add_plugins(MaterialPlugin::<Paint>::default());
}

/// Vertex colours under the sun and the sky. One material for everything keeps the picture of one piece, and cheap where there is no
/// GPU.
#[derive(Asset, AsBindGroup, Clone, Debug, TypePath)]
#[bind_group_data(PaintKey)]
pub(crate) struct Paint {
    /// Multiplies the vertex colours.
    #[uniform(0)]
    pub tint: Vec4,
    /// Gloss; light shining through (leaves, drawn from both sides); glowing by itself; fog taken.
    #[uniform(0)]
    pub finish: Vec4,
    /// Where along x it is open to the light, and half the width of what is dark beyond; zero for light everywhere.
    #[uniform(0)]
    pub shelter: Vec4,
    /// Multiplies the vertex colours by where the vertices are on it; with a bump map only.
    #[texture(1)]
    #[sampler(2)]
    pub color_map: Option<Handle<Image>>,
    /// Turns the normals, in the directions of the vertices' tangents.
    #[texture(3)]
    pub bump_map: Option<Handle<Image>>,
    /// Whether it receives shadows from a shadow map.
    pub shadows: bool,
    /// Whether a vertex colour's fourth number is opacity and not the wind's reach.
    pub sheer: bool,
}

/// What of a [`Paint`] asks for another pipeline.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
#[repr(C)]
pub(crate) struct PaintKey {
    shadows: u8,
    both_sides: u8,
    sheer: u8,
    glows: u8,
    sheltered: u8,
    mapped: u8,
}

impl From<&Paint> for PaintKey {
    fn from(paint: &Paint) -> Self {
        Self {
            shadows: paint.shadows.into(),
            both_sides: (paint.finish.y > 0.0).into(),
            sheer: paint.sheer.into(),
            glows: (paint.finish.z > 0.5).into(),
            sheltered: (paint.shelter.z > 0.0).into(),
            mapped: (paint.color_map.is_some() && paint.bump_map.is_some()).into(),
        }
    }
}

impl Paint {
    /// Plain matte paint.
    pub fn matte(shadows: bool) -> Self {
        Self {
            tint: Vec4::ONE,
            finish: Vec4::new(0.0, 0.0, 0.0, 1.0),
            shelter: Vec4::ZERO,
            color_map: None,
            bump_map: None,
            shadows,
            sheer: false,
        }
    }

    /// Paint that shines, from 0 to 1.
    pub fn glossy(shadows: bool, gloss: f32) -> Self {
        Self { finish: Vec4::new(gloss, 0.0, 0.0, 1.0), ..Self::matte(shadows) }
    }

    /// Leaves and petals: the sun shines through.
    pub fn leafy(shadows: bool) -> Self {
        Self { finish: Vec4::new(0.0, 0.6, 0.0, 1.0), ..Self::matte(shadows) }
    }

    /// A soft dark spot on the ground.
    pub fn blot(strength: f32) -> Self {
        Self {
            tint: Vec4::new(1.0, 1.0, 1.0, strength),
            finish: Vec4::new(0.0, 0.0, 1.0, 0.0),
            sheer: true,
            ..Self::matte(false)
        }
    }

    /// Colours that are shown as they are: sky.
    pub fn glowing() -> Self {
        Self { finish: Vec4::new(0.0, 0.0, 1.0, 0.0), ..Self::matte(false) }
    }
}

impl Material for Paint {
    fn vertex_shader() -> ShaderRef {
        SHADER.into()
    }

    fn fragment_shader() -> ShaderRef {
        SHADER.into()
    }

    fn alpha_mode(&self) -> AlphaMode {
        if self.sheer { AlphaMode::Blend } else { AlphaMode::Opaque }
    }

    /// Added to the depth by which Bevy sorts what shines through, from far to near: a spot of shade lies on the ground behind whatever throws it.
    fn depth_bias(&self) -> f32 {
        if self.sheer && self.finish.z > 0.5 { -50.0 } else { 0.0 }
    }

    fn specialize(
        _pipeline: &MaterialPipeline,
        descriptor: &mut RenderPipelineDescriptor,
        _layout: &MeshVertexBufferLayoutRef,
        key: MaterialPipelineKey<Self>,
    ) -> Result<(), SpecializedMeshPipelineError> {
        let paint = key.bind_group_data;
        let defined = [
            (paint.shadows, "SHADOWS"),
            (paint.both_sides, "BOTH_SIDES"),
            (paint.sheer, "SHEER"),
            (paint.glows, "GLOWS"),
            (paint.sheltered, "SHELTERED"),
            (paint.mapped, "MAPPED"),
        ];
        for (_, name) in defined.iter().filter(|(on, _)| *on != 0) {
            descriptor.vertex.shader_defs.push((*name).into());
            if let Some(fragment) = &mut descriptor.fragment {
                fragment.shader_defs.push((*name).into());
            }
        }
        if paint.both_sides != 0 {
            descriptor.primitive.cull_mode = None;
        }
        Ok(())
    }
}
