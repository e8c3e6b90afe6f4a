// A flag: hangs down in a calm, stands out in the wind, waves from hoist to fly.
#include "frame.glsl"
#include "breeze.glsl"
#include "light.glsl"

in vec2 in_grid;   // along from the hoist, down from the top; 0..1
in vec3 in_color;  // albedo

uniform vec4 hoist;  // xyz upper corner at the pole m, w lamp light
uniform vec2 size;   // m, along and down
uniform vec3 sun_full;
uniform sampler2DShadow shadow_map;

out vec3 v_shade;

const float HALF_OUT = 5.2;  // m/s at which it stands out at 45 degrees

// Integral of sqrt(1 - w w) from 0.
float half_circle(float w) {
    return 0.5 * (w * sqrt(max(1.0 - w * w, 0.0)) + asin(w));
}

vec3 place(vec2 at, float speed) {
    float pull = speed * speed / (HALF_OUT * HALF_OUT);
    vec2 out_down = normalize(vec2(pull, 1.0));
    float s = at.x * size.x;
    float t = at.y * size.y;
    // The sine of its slope grows along the upper edge, which sags the more the farther out; its way
    // out and down are the integrals.
    float turn = max(0.65 * out_down.y, 0.02);
    float held = min(0.35 * out_down.y + 0.03, 1.0);
    float far = min(held + turn * at.x, 1.0);
    float reach = size.x * (half_circle(far) - half_circle(held)) / turn;
    float sag = size.x * (held + 0.5 * turn * at.x) * at.x;
    // What hangs gathers into folds.
    float fold = out_down.y * 0.11 * smoothstep(0.0, 0.3, at.x) * sin(at.y * 9.0 + at.x * 3.0);
    float flap = speed / (speed + 4.0);
    float phase = s * 5.5 - drift.w * 3.0 + at.y * 1.3;
    float wave = 0.17 * flap * at.x * (sin(phase) + 0.4 * sin(phase * 1.7 + wind.w * 2.0));
    // The more it blows, the more its free end whips up and down, each corner in its own time.
    float whip = 0.22 * flap * flap * at.x * at.x
        * (sin(phase * 0.6 - drift.w * 0.9 + at.y * 1.5) + 0.5 * sin(phase - at.y * 2.1));
    reach *= 1.0 - 0.13 * flap * flap * at.x;  // cloth in waves is shorter
    vec3 along = vec3(wind.x, 0.0, wind.y);
    vec3 side = vec3(-wind.y, 0.0, wind.x);
    float tuck = mix(1.0, 0.75, out_down.y * at.x);
    return hoist.xyz + along * reach + side * (wave + fold)
        - vec3(0.0, t * tuck + sag + 0.35 * wave * at.x + whip, 0.0);
}

void main() {
    float speed = wind_at(hoist.xz);
    vec3 p = place(in_grid, speed);
    vec3 a = place(in_grid + vec2(0.02, 0.0), speed) - p;
    vec3 b = place(in_grid + vec2(0.0, 0.02), speed) - p;
    vec3 n = normalize(cross(a, b));
    if (dot(n, camera.xyz - p) < 0.0) n = -n;
    vec2 cover = rain_cover(p.xz);
    vec3 albedo = in_color * (1.0 - 0.35 * cover.y);
    // Thin cloth: what the sun lights from behind shines through.
    float lit = dot(n, sun_direction.xyz);
    lit = max(lit, 0.0) + 0.45 * max(-lit, 0.0);
    vec3 ambient = sky_light(n, cover.x) + LAMP_COLOR * (LAMP_STRENGTH * hoist.w * sun_direction.w);
    vec3 shadow = (shadow_matrix * vec4(p + n * 0.05, 1.0)).xyz;
    vec3 sun = sun_full * sun_share(lit, cover.x) * textureLod(shadow_map, shadow, 0.0);
    vec4 air = haze(p);
    v_shade = albedo * (ambient + sun) * air.a + air.rgb;
    gl_Position = view_projection * vec4(p, 1.0);
}
