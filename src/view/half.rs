//! Half the resolution: the scene is drawn into a quarter of the camera's texture and spread over the whole of it before anything else is
//! drawn there, so that panels and text stay sharp and the pointer finds what it points at.

use bevy::{
    asset::{load_internal_asset, uuid_handle},
    camera::{Camera, MainPassResolutionOverride},
    core_pipeline::{Core3dSystems, FullscreenShader, schedule::Core3d},
    ecs::query::QueryItem,
    prelude::*,
    render::{
        RenderApp, RenderStartup,
        extract_component::{ExtractComponent, ExtractComponentPlugin},
        render_resource::{
            BindGroup, BindGroupEntries, BindGroupLayoutDescriptor, BindGroupLayoutEntries, CachedRenderPipelineId,
            ColorTargetState, ColorWrites, FilterMode, FragmentState, Operations, PipelineCache,
            RenderPassColorAttachment, RenderPassDescriptor, RenderPipelineDescriptor, Sampler, SamplerBindingType,
            SamplerDescriptor, ShaderStages, TextureFormat, TextureSampleType, TextureViewId, VertexState,
            binding_types::{sampler, texture_2d},
        },
        renderer::{RenderContext, RenderDevice, ViewQuery},
        sync_component::SyncComponent,
        view::ViewTarget,
    },
};

const SHADER: Handle<Shader> = uuid_handle!("5c0f1a52-6e2d-4c36-9a7e-1d0b6a8f4b21");

pub(super) fn plugin(app: &mut App) {
    load_internal_asset!(app, SHADER, "half.wgsl", Shader::from_wgsl);
    app.add_plugins(ExtractComponentPlugin::<HalfResolution>::default());
    if let Some(render) = app.get_sub_app_mut(RenderApp) {
        render.add_systems(RenderStartup, prepare).add_systems(Core3d, spread.in_set(Core3dSystems::PostProcess));
    }
}

/// Put on a camera that draws at half its resolution in both directions.
#[derive(Clone, Component, Copy, Debug)]
pub(super) struct HalfResolution;

impl SyncComponent for HalfResolution {
    type Target = (Self, MainPassResolutionOverride);
}

impl ExtractComponent for HalfResolution {
    type QueryData = &'static Camera;
    type QueryFilter = With<Self>;
    type Out = (Self, MainPassResolutionOverride);

    fn extract_component(camera: QueryItem<'_, '_, Self::QueryData>) -> Option<Self::Out> {
        let size = camera.physical_target_size()?;
        Some((Self, MainPassResolutionOverride((size / 2).max(UVec2::ONE))))
    }
}

#[derive(Resource)]
struct Spreading {
    layout: BindGroupLayoutDescriptor,
    sampler: Sampler,
    vertex: VertexState,
}

fn prepare(device: Res<RenderDevice>, fullscreen: Res<FullscreenShader>, mut commands: Commands) {
    let layout = BindGroupLayoutDescriptor::new(
        "half_resolution_layout",
        &BindGroupLayoutEntries::sequential(
            ShaderStages::FRAGMENT,
            (texture_2d(TextureSampleType::Float { filterable: true }), sampler(SamplerBindingType::Filtering)),
        ),
    );
    let sampler = device.create_sampler(&SamplerDescriptor {
        mag_filter: FilterMode::Linear,
        min_filter: FilterMode::Linear,
        ..default()
    });
    commands.insert_resource(Spreading { layout, sampler, vertex: fullscreen.to_vertex_state() });
}

impl Spreading {
    /// The pipeline for a camera's texture of this format, which depends on the screen's.
    fn pipeline(&self, format: TextureFormat, pipelines: &PipelineCache) -> CachedRenderPipelineId {
        let target = ColorTargetState { format, blend: None, write_mask: ColorWrites::ALL };
        pipelines.queue_render_pipeline(RenderPipelineDescriptor {
            label: Some("half_resolution_pipeline".into()),
            layout: vec![self.layout.clone()],
            vertex: self.vertex.clone(),
            fragment: Some(FragmentState { shader: SHADER, targets: vec![Some(target)], ..default() }),
            ..default()
        })
    }
}

fn spread(
    view: ViewQuery<&ViewTarget, With<MainPassResolutionOverride>>,
    spreading: Option<Res<Spreading>>,
    pipelines: Res<PipelineCache>,
    mut queued: Local<Option<(TextureFormat, CachedRenderPipelineId)>>,
    mut bound: Local<Option<(TextureViewId, BindGroup)>>,
    mut context: RenderContext,
) {
    let target = view.into_inner();
    let Some(spreading) = spreading else { return };
    let format = target.main_texture_format();
    let (_, pipeline) = match *queued {
        Some(queued) if queued.0 == format => queued,
        _ => *queued.insert((format, spreading.pipeline(format, &pipelines))),
    };
    let Some(pipeline) = pipelines.get_render_pipeline(pipeline) else { return };
    let write = target.post_process_write();
    if bound.as_ref().is_none_or(|(source, _)| *source != write.source.id()) {
        let group = context.render_device().create_bind_group(
            "half_resolution_bind_group",
            &pipelines.get_bind_group_layout(&spreading.layout),
            &BindGroupEntries::sequential((write.source, &spreading.sampler)),
        );
        *bound = Some((write.source.id(), group));
    }
    let Some((_, group)) = &*bound else { return };
    let mut pass = context.command_encoder().begin_render_pass(&RenderPassDescriptor {
        label: Some("half_resolution_pass"),
        color_attachments: &[Some(RenderPassColorAttachment {
            view: write.destination,
            depth_slice: None,
            resolve_target: None,
            ops: Operations::default(),
        })],
        depth_stencil_attachment: None,
        timestamp_writes: None,
        occlusion_query_set: None,
        multiview_mask: None,
    });
    pass.set_pipeline(pipeline);
    pass.set_bind_group(0, group, &[]);
    pass.draw(0..3, 0..1);
}
