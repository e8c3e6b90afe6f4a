// Billboards of clouds, eight vertices each, of a stream of (billboard, cloud) that is sorted.
#include "cloud_row.glsl"
#include "cloud_light.glsl"
#include "cloud_flash.glsl"

uniform usampler2D cloud_stream;
uniform int cloud_first;  // of this draw in the stream
uniform mat4 cloud_matrix;  // from camera-relative places to the picture
uniform vec2 cloud_hulls[8 * IMAGES];  // octagons round what the images show
uniform float cloud_hazed;  // 1; 0 while an impostor is made

#ifdef SOFT
uniform sampler2D scene_depth;
uniform vec4 cloud_scene_at;  // the scene's texel: scale and offset of the pixel
uniform vec3 cloud_guard;  // depth by pixel's x, by y, at 0: what is nearer hides all of the clouds
uniform vec3 cloud_guard_at;  // depth by x, by y, in the middle of the picture, all -1 to 1

const int LOOKS = 6;

// Whether the scene hides all of a billboard, as far as so many looks along and across it tell;
// x, y: half of its sides.
bool hidden(vec3 middle, vec3 x, vec3 y)
{
    ivec2 size = textureSize(scene_depth, 0);
    for (int k = 0; k < LOOKS * LOOKS; ++k) {
        // From above: where most see the sky, so that few are needed.
        vec2 at = (vec2(k % LOOKS, LOOKS - 1 - k / LOOKS) + 0.5) * (2.0 / float(LOOKS)) - 1.0;
        vec4 clip = cloud_matrix * vec4(middle + x * at.x + y * at.y, 1.0);
        if (clip.w <= 0.0) return false;
        vec2 ndc = clip.xy / clip.w;
        if (any(greaterThan(abs(ndc), vec2(1.0)))) continue;
        ivec2 texel = min(ivec2((ndc * 0.5 + 0.5) * vec2(size)), size - 1);
        float guard = dot(vec3(ndc, 1.0), cloud_guard_at) * 0.5 + 0.5;
        float depth = texelFetch(scene_depth, texel, 0).r;
        if (depth >= 1.0 || depth >= guard) return false;
    }
    return true;
}
#endif

out vec3 vs_uv;
out vec3 vs_lit;
out vec3 vs_shade;
out vec3 vs_rim;
out vec3 vs_relief;  // the sun in the image's axes times its relief; softness of the outline
out vec4 vs_fade;  // opacity, height over the base, depth over which it fades, facing
flat out vec4 vs_haze;
#ifdef SOFT
flat out vec4 vs_scene_at;
flat out vec4 vs_guard;
flat out vec2 vs_depth;
#endif

void main()
{
    int item = cloud_first + gl_InstanceID;
    uvec2 pair = texelFetch(cloud_stream, ivec2(item & 1023, item >> 10), 0).rg;
    Cloud cloud = fetch_cloud(int(pair.y));
    Billboard b = fetch_billboard(int(pair.x));

    float there = presence(cloud, b.order);
    vec3 middle = place_in_cloud(cloud, b.position);
    vec3 at = cloud.center + middle;
    float away = length(at);
    vec2 size = b.size * cloud.scale * (0.55 + 0.45 * there);

    // It stands for an ellipsoid as deep as it is wide: the image lies level under a viewer below,
    // and turns up towards one at its own height, without a jump anywhere.
    vec3 way = at / max(away, 1e-3);
    float level = length(way.xz);
    vec2 ahead = level > 1e-4 ? way.xz / level : vec2(1.0, 0.0);
    vec3 right = vec3(-ahead.y, 0.0, ahead.x);
    vec3 up = cross(right, way);
    float height = length(vec2(size.y * level, size.x * way.y));
    // Strip of an octagon: 0 1 7 2 6 3 5 4.
    int side = (gl_VertexID & 1) == 1 ? (gl_VertexID + 1) >> 1 : (8 - (gl_VertexID >> 1)) & 7;
    vec2 corner = cloud_hulls[8 * int(b.image) + side];
    vec2 turn = vec2(cos(b.turn), sin(b.turn));
    // Image axes to level world axes, as (x, z) columns, then to the picture's.
    vec2 image_x = vec2(turn.x * cloud.mirror, turn.y);
    vec2 image_y = vec2(-turn.y * cloud.mirror, turn.x);
    image_x = vec2(image_x.x * cloud.turn.x + image_x.y * cloud.turn.y,
                   image_x.y * cloud.turn.x - image_x.x * cloud.turn.y);
    image_y = vec2(image_y.x * cloud.turn.x + image_y.y * cloud.turn.y,
                   image_y.y * cloud.turn.x - image_y.x * cloud.turn.y);
    vec2 ex = vec2(dot(image_x, right.xz), -dot(image_x, ahead));
    vec2 ey = vec2(dot(image_y, right.xz), -dot(image_y, ahead));
    vec2 flat_offset = ex * corner.x + ey * corner.y;
    vec3 offset = 0.5 * (right * (flat_offset.x * size.x) + up * (flat_offset.y * height));
    vec3 v = middle + offset;
    vec3 p = at + offset;

    bool plain = cloud_look.w > 0.5;
    Light light;
    if (plain) {
        vec3 seed_size;
        light = plain_light(v, fetch_seed(b.seed, cloud.fresh, seed_size).w);
    } else {
        vec4 seed = fetch_light(int(pair.x), cloud.fresh, to_shape(cloud, offset));
        vec3 s = place_in_cloud(cloud, seed.xyz);
        light = full_light(cloud, v, s, p / max(length(p), 1e-3), seed.w);
        // A picture of the cloud is taken without.
        vec3 flash = cloud_hazed * (own_flash(cloud.flash, v / cloud.half_size) + near_flash(p));
        light.lit += flash;
        light.shade += FLASH_SHADE * flash;
    }
    vs_lit = encode(light.lit);
    vs_shade = encode(light.shade);
    vs_rim = light.rim;
    vec2 sun = vec2(dot(cloud_sun.xyz, right), dot(cloud_sun.xyz, up));
    // In the shade the light comes from all round and shows no relief.
    vs_relief = vec3(vec2(dot(sun, ex), dot(sun, ey)) * light.relief, light.soft);
    vs_fade.w = light.facing;

    // Nothing is left of a billboard that the camera comes to.
    float near = smoothstep(0.20, 0.75, away / max(size.x, 1e-3));
    vs_fade.x = b.opacity * there * near * mix(cloud.opacity, 1.0, 1.0 - cloud_hazed);
    // Of the ellipsoid and not of its image, which hangs low where it lies level over the viewer.
    float rise = 0.5 * flat_offset.y * size.y * level * size.y / max(height, 1e-3);
    vs_fade.y = (middle.y + rise - cloud.base) / (0.16 * cloud.half_size.y) + 0.5;
    vs_fade.z = 0.25 * size.x;
    vs_haze = vec4(cloud.haze, cloud.fog * cloud_hazed);
    vs_uv = vec3(corner * 0.5 + 0.5, b.image);
    gl_Position = cloud_matrix * vec4(p, 1.0);
    // No far plane cuts clouds off.
    gl_Position.z = min(gl_Position.z, 0.999999 * gl_Position.w);
    bool unseen = vs_fade.x < 0.002;
#ifdef SOFT
    vs_scene_at = cloud_scene_at / vec2(textureSize(scene_depth, 0)).xyxy;
    vs_guard = vec4(cloud_guard, 1.0 / max(vs_fade.z * cloud_softness, 1e-3));
    vs_depth = cloud_depth.xy;
    unseen = unseen || hidden(at, right * (0.5 * size.x), up * (0.5 * height));
#endif
    if (unseen) gl_Position = vec4(0.0, 0.0, 2.0, 1.0);
}
