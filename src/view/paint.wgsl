// The one material of the garden: vertex colours under a warm sun and a blue sky. The fourth number of a vertex colour is how far the
// wind moves the vertex or, below 0, how much of the paint's maps it does without. Cheap enough for a renderer without a GPU; the tone curve is applied here so that both qualities look alike.
// What a paint does differently is a definition and not a test of a uniform: Mesa's software renderer compiles a shader again for each
// value of a uniform that decides a branch, at every draw.

#import bevy_pbr::{
    forward_io::{Vertex, VertexOutput},
    mesh_functions,
    mesh_view_bindings::{globals, lights, view},
    view_transformations::position_world_to_clip,
}
#ifdef SHADOWS
#import bevy_pbr::shadows::fetch_directional_shadow
#endif

struct Paint {
    tint: vec4<f32>,
    // x: gloss, y: light shining through, z: whether it glows (GLOWS), w: how much fog it takes
    finish: vec4<f32>,
    // x..y along the x axis is open to the light; beyond, it is dark within z (burrow and house).
    shelter: vec4<f32>,
}

@group(#{MATERIAL_BIND_GROUP}) @binding(0) var<uniform> paint: Paint;
#ifdef MAPPED
@group(#{MATERIAL_BIND_GROUP}) @binding(1) var color_map: texture_2d<f32>;
@group(#{MATERIAL_BIND_GROUP}) @binding(2) var map_sampler: sampler;
@group(#{MATERIAL_BIND_GROUP}) @binding(3) var bump_map: texture_2d<f32>;
#endif

const SUN: vec3<f32> = vec3(1.95, 1.68, 1.25);
const SKY: vec3<f32> = vec3(0.33, 0.45, 0.64);
const BOUNCE: vec3<f32> = vec3(0.24, 0.25, 0.13);
const HAZE: vec3<f32> = vec3(0.68, 0.82, 0.90);
// How much haze a unit of the way to the eye adds at the ground, from where on, and at which height it is thinner by e: who looks down from a hill sees clearly.
const HAZINESS: f32 = 0.0075;
const CLEAR: f32 = 24.0;
const HAZE_HEIGHT: f32 = 12.0;

@vertex
fn vertex(in: Vertex) -> VertexOutput {
    var out: VertexOutput;
    let world_from_local = mesh_functions::get_world_from_local(in.instance_index);
    var world = mesh_functions::mesh_position_local_to_world(world_from_local, vec4(in.position, 1.0));
#ifndef SHEER
    let reach = in.color.a;
    if (reach > 0.0) {
        // A slow gust that travels over the field, and a quick flutter on top of it.
        let t = globals.time;
        let gust = sin(world.x * 0.45 + world.z * 0.3 - t * 1.1) * 0.6 + 0.4;
        let flutter = sin(t * 3.7 + world.x * 3.1 + world.z * 2.3);
        let push = gust + 0.28 * flutter;
        world.x += reach * push;
        world.z += reach * (0.35 * gust - 0.3 * flutter);
        world.y -= reach * 0.3 * push * push;
    }
#endif
    out.world_position = world;
    out.position = position_world_to_clip(world.xyz);
    out.world_normal = mesh_functions::mesh_normal_local_to_world(in.normal, in.instance_index);
    out.color = in.color;
#ifdef MAPPED
    out.uv = in.uv;
    out.world_tangent = mesh_functions::mesh_tangent_local_to_world(world_from_local, in.tangent, in.instance_index);
#endif
#ifdef VERTEX_OUTPUT_INSTANCE_INDEX
    out.instance_index = in.instance_index;
#endif
#ifdef VISIBILITY_RANGE_DITHER
    out.visibility_range_dither = mesh_functions::get_visibility_range_dither_level(in.instance_index, world_from_local[3]);
#endif
    return out;
}

// A gentle film curve: keeps colours friendly, rolls highlights off.
fn tone(x: vec3<f32>) -> vec3<f32> {
    let y = x * 0.92;
    let mapped = (y * (2.51 * y + 0.03)) / (y * (2.43 * y + 0.59) + 0.14);
    let grey = dot(mapped, vec3(0.2126, 0.7152, 0.0722));
    return clamp(mix(vec3(grey), mapped, 1.08), vec3(0.0), vec3(1.0));
}

@fragment
fn fragment(in: VertexOutput, @builtin(front_facing) front: bool) -> @location(0) vec4<f32> {
    var albedo = in.color.rgb * paint.tint.rgb;
#ifdef MAPPED
    let mapped = clamp(1.0 + in.color.a, 0.0, 1.0);
    albedo *= mix(vec3(1.0), textureSample(color_map, map_sampler, in.uv).rgb, mapped);
    let bump = mix(vec3(0.0, 0.0, 1.0), textureSample(bump_map, map_sampler, in.uv).xyz * 2.0 - 1.0, mapped);
#endif
    let to_eye = view.world_position - in.world_position.xyz;
    let distance = length(to_eye);
    var color = albedo;
#ifndef GLOWS
    {
        let eye = to_eye / distance;
        var normal = normalize(in.world_normal);
#ifdef MAPPED
        let along = normalize(in.world_tangent.xyz - normal * dot(normal, in.world_tangent.xyz));
        let across = in.world_tangent.w * cross(normal, along);
        normal = normalize(bump.x * along + bump.y * across + bump.z * normal);
#endif
#ifndef BOTH_SIDES
        // Leaves and blades are seen from both sides; their normals point up and stay.
        if (!front) {
            normal = -normal;
        }
#endif
        let to_sun = lights.directional_lights[0].direction_to_light;
        let facing = dot(normal, to_sun);
        var sunlight = mix(max(facing, 0.0), abs(facing) * 0.5 + 0.5 * max(facing, 0.0), paint.finish.y);
#ifdef SHADOWS
        if (sunlight > 0.0) {
            let view_z = dot(vec4(
                view.view_from_world[0].z, view.view_from_world[1].z, view.view_from_world[2].z, view.view_from_world[3].z),
                in.world_position);
            sunlight *= fetch_directional_shadow(0u, in.world_position, normal, view_z, in.position.xy);
        }
#endif
        let up = normal.y * 0.5 + 0.5;
        var light = mix(BOUNCE, SKY, up) + SUN * sunlight;
        let half_way = normalize(eye + to_sun);
        let shine = pow(max(dot(normal, half_way), 0.0), 40.0) * paint.finish.x * sunlight;
        let rim = pow(1.0 - max(dot(normal, eye), 0.0), 3.0) * paint.finish.x * 0.35;
        color = albedo * light + SUN * shine * 0.35 + SKY * rim;
#ifdef SHELTERED
        {
            let x = in.world_position.x;
            let inside = (1.0 - smoothstep(paint.shelter.x - 0.2, paint.shelter.x + 0.35, x))
                + smoothstep(paint.shelter.y, paint.shelter.y + 0.7, x);
            let near = step(abs(in.world_position.z), paint.shelter.z);
            color *= 1.0 - 0.97 * min(inside, 1.0) * near;
        }
#endif
    }
#endif
    // The mean of e^(−y/h) over the way from the eye's height to here.
    let eye_height = max(view.world_position.y, 0.0) / HAZE_HEIGHT;
    let rise = max(in.world_position.y, 0.0) / HAZE_HEIGHT - eye_height;
    let thinned = exp(-eye_height) * select((1.0 - exp(-rise)) / rise, 1.0 - 0.5 * rise, abs(rise) < 0.01);
    let fog = (1.0 - exp(-max(distance - CLEAR, 0.0) * HAZINESS * thinned)) * paint.finish.w;
    let shown = tone(mix(color, HAZE, fog));
#ifdef SHEER
    return vec4(shown, in.color.a * paint.tint.a);
#else
    return vec4(shown, 1.0);
#endif
}
