// Blades: three vertices each, shrinking away with distance.
#include "frame.glsl"
#include "light.glsl"
#include "breeze.glsl"

in vec3 in_position;
in vec4 in_color;   // square root of the albedo, w: 1 at the tip
in vec4 in_root;    // foot of the tuft, w: lamp light

uniform sampler2DShadow shadow_map;
uniform vec3 sun_full;
uniform vec2 reach; // m, where blades begin to shrink, where they are gone

out vec3 v_shade;

void main() {
    vec3 root = in_root.xyz;
    float size = 1.0 - smoothstep(reach.x, reach.y, distance(root.xz, camera.xz));
    // Snow weighs blades down and hides their feet.
    float snowy = snow_cover(root, vec3(0.0, 1.0, 0.0));
    vec3 p = mix(root, in_position, size * (1.0 - 0.62 * snowy));
    float phase = wind.w * 1.7 + dot(root.xz, vec2(0.9, 0.7));
    float lean = grass_lean(root.xz) * (0.85 + 0.15 * sin(phase));
    float high = (p.y - root.y) * in_color.w;
    p.xz += wind.xy * (high * lean);
    p.y -= high * 0.42 * lean * lean;
    float flutter = 0.008 + 0.0022 * min(gusts[0].x, 12.0);
    p.xz += vec2(sin(phase * 1.9), cos(phase * 1.6)) * (flutter * in_color.w);
    vec2 cover = rain_cover(root.xz);
    vec3 albedo = in_color.rgb * in_color.rgb * (1.0 - 0.28 * cover.y);
    albedo = mix(albedo, SNOW, snowy * (0.55 + 0.40 * in_color.w));
    vec3 up = vec3(0.0, 1.0, 0.0);
    vec3 ambient = (sky_light(up, cover.x) + flash_light(root, up)) * (0.62 + 0.38 * in_color.w);
    ambient += LAMP_COLOR * (LAMP_STRENGTH * in_root.w * 4.0 * sun_direction.w);
    vec4 air = haze(p);
    vec3 shadow = (shadow_matrix * vec4(root + vec3(0.0, 0.25, 0.0), 1.0)).xyz;
    float lit = sun_share(0.25 + 0.75 * sun_direction.y, cover.x) * textureLod(shadow_map, shadow, 0.0);
    v_shade = albedo * (ambient + sun_full * lit) * air.a + air.rgb;
    gl_Position = view_projection * vec4(p, 1.0);
}
