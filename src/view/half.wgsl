// Spreads the quarter of the texture into which the scene was drawn over the whole of it.

#import bevy_core_pipeline::fullscreen_vertex_shader::FullscreenVertexOutput

@group(0) @binding(0) var scene: texture_2d<f32>;
@group(0) @binding(1) var smooth_sampler: sampler;

@fragment
fn fragment(in: FullscreenVertexOutput) -> @location(0) vec4<f32> {
    let size = vec2<f32>(textureDimensions(scene));
    let drawn = floor(size * 0.5) / size;
    // Half a texel away from what was not drawn.
    let most = drawn - 0.5 / size;
    return textureSampleLevel(scene, smooth_sampler, min(in.uv * drawn, most), 0.0);
}
