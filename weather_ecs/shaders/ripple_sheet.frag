// Water under rain: the sky in it by Fresnel's share, its own colour below, thin at the shore.
#include <block:RainView>
#include <block:RippleSheet>
#include "encode.glsl"
#include "fog.glsl"
#include "ripple_sample.glsl"
#ifdef SHELTER
#include "shelter.glsl"
#endif

uniform sampler2D scene_depth;

in vec3 vs_ray;   // m, from the camera
in vec2 vs_own;   // m, own axes
in vec2 vs_rain;  // share of the full rain; slope that it gives the water
out vec4 color;

// Metres of water along a view ray; `step` is the ray's way per metre of depth.
float water_path(float step, float away)
{
    float depth = texelFetch(scene_depth, ivec2(gl_FragCoord.xy - view_origin.xy), 0).r;
    float along = depth < 1.0 ? view_depth.y / (depth * 2.0 - 1.0 + view_depth.x) : 1e6;
    return max(along * step - away, 0.0);
}

// Share of the full rain that reaches the water here.
float rain_on(vec2 xz)
{
    float share = min(vs_rain.x, 1.0);
#ifdef SHELTER
    vec3 m = shelter_place(vec3(xz.x, sheet_body.z, xz.y));
    if (in_shelter_map(m) && below_texel(m) > 0.1) share = 0.0;
#endif
    return share;
}

void main()
{
    if (sheet_body.w > 0.0) {
        vec2 share = vs_own / sheet_body.xy;
        if (dot(share, share) > 1.0) discard;
    }
    float away = length(vs_ray);
    vec3 ray = vs_ray / away;
    float steep = max(abs(ray.y), 0.02);

    // A pixel covers this much of the water: the mean of its two sides, so that rings far off are
    // seen as thin as they are.
    float blur = away * inversesqrt(steep) / camera_position.w;
    vec2 off = abs(vs_own - sheet_window.xy) - sheet_window.zw;
    float outside = clamp(max(off.x, off.y) * 2.0, 0.0, 1.0);
    vec2 xz = vs_ray.xz + camera_position.xz;
    vec2 slope = ripple_slope(xz, blur);
    // Waves run a little way in under a roof: its edge on the water is theirs.
    float rain = rain_on(xz + 6.0 * slope);
    // Outside of what is computed the pattern comes again, but only where it rains.
    slope *= 1.0 - outside * (1.0 - rain);
    // What is too small to be seen by itself still turns the light.
    float rough = vs_rain.y * step(1e-3, rain) * clamp(blur * 10.0 - 0.2, 0.0, 1.0);

    vec3 normal = vec3(-slope.x, 1.0, -slope.y);
    float facing = abs(dot(ray, normal));
    vec3 mirrored = ray + 2.0 * facing * normal;
    float dark = max(1.0 - facing - 0.7 * rough, 0.0);
    float fresnel = 0.02 + 0.98 * (dark * dark) * (dark * dark) * dark;
    float rise = clamp(mirrored.y + 1.4 * rough, 0.0, 1.0);
    vec3 light = mix(sheet_horizon.rgb, sheet_zenith.rgb, sqrt(rise));
    // The sun's image and those of lamps, spread over the slopes of what is too small to be seen.
    float sharp = 500.0 / (1.0 + 4e4 * rough * rough);
    light += sun_color.rgb * (0.01 * sharp * exp(sharp * (dot(mirrored, sun_direction.xyz) - 1.0)));
#ifdef LAMPS
    vec3 place = vs_ray + camera_position.xyz;
    for (int i = 0; i < light_count; ++i) {
        vec3 to = light_position[i].xyz - place;
        float r2 = dot(to, to);
        float fade = max(1.0 - r2 / (light_position[i].w * light_position[i].w), 0.0);
        float match = dot(mirrored, to) * inversesqrt(r2) - 1.0;
        light += light_color[i].rgb * (fade * fade * 8.0 * exp(0.5 * sharp * match));
    }
#endif
    // Light that comes up out of the water leaves more by the sides of the waves that lean to it.
    vec3 body = sheet_color.rgb * max(1.0 - 5.0 * dot(slope, sun_direction.xz), 0.3);
    float path = water_path(away / dot(vs_ray, camera_forward.xyz), away);
    float opacity = max(1.0 - exp(-path * sheet_color.w), fresnel);
    opacity *= min(path * steep * 10.0, 1.0);
    color = vec4(encode(in_fog(mix(body, light, fresnel), away)), opacity);
}
