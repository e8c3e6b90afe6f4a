// What one flake looks like: its place, size, opacity and picture, and how far it goes during the
// exposure. Its area times its opacity is what the real flakes cover that it stands for.
#include "snow_law.glsl"
#include "drop_weight.glsl"
#include "landed.glsl"
#include "flake_light.glsl"
#include "encode.glsl"
#include "flake_shape.glsl"
#include "fog.glsl"
#include "packed_color.glsl"
#include <block:RainView>

in vec3 in_position;
in vec3 in_velocity;
in vec4 in_birth;

// The geometry shader is handed little: what it is handed costs as much as what it does.
out vec4 vs_place;  // normalised device coordinates; radius in pixels. Radius 0: nothing to draw
out vec4 vs_axes;   // the picture's two in them, half as long as its sides
out vec4 vs_shown;  // colour, encoded and packed; layer and level of the picture

const float SMALLEST = 1.7;  // pixels, diameter below which a flake gets fainter instead
const float PICTURE = 64.0;  // texels on a side
const float FILL = 0.25;     // share of its square that a picture covers, on average
const float FOCUS = 6.0;     // m; what is closer gets softer
// First layer of each kind and how many; as gpu/flake_texture.py.
const ivec2 PLATES = ivec2(0, 12);
const ivec2 NEEDLES = ivec2(12, 6);
const ivec2 STARS = ivec2(18, 28);
const ivec2 CLUMPS = ivec2(46, 16);
const ivec2 WET = ivec2(62, 6);
// What of its disc a picture of each kind comes to that is a few pixels large.
const float[5] WHITE = float[5](0.98, 0.5, 0.74, 0.82, 0.9);

// Layer, and number of the kind.
ivec2 flake_layer(uint word, float diameter, int habit, float wet)
{
    // Which of the pictures, and whether it looks like a clump or has melted, by other bits each.
    uint pick = hash_word(word);
    float u = float(pick & 1023u) * (1.0 / 1024.0);
    float chance = float((pick >> 10u) & 1023u) * (1.0 / 1024.0);
    float melts = float(pick >> 22u) * (1.0 / 1024.0);
    int kind = habit;
    if (chance < flake_clumped(diameter)) kind = 3;
    if (melts < wet * 1.6) kind = 4;
    if (snow_motion.w == LIU_TONG) kind = 2;
    ivec2 of = kind == 0 ? PLATES : (kind == 1 ? NEEDLES : (kind == 2 ? STARS
             : (kind == 3 ? CLUMPS : WET)));
    return ivec2(of.x + int(u * float(of.y)), kind);
}

// Cosine and sine of so many turns, about: of parabolas, which is enough to turn a flake.
vec2 turned(float turns)
{
    vec2 z = fract(vec2(turns + 0.25, turns)) * 2.0 - 1.0;
    return z * (4.0 * abs(z) - 4.0);
}

void main()
{
    vs_place = vs_axes = vs_shown = vec4(0.0);
    gl_Position = vec4(0.0);
    if (has_landed(in_velocity)) return;
    vec3 p = in_position;
    vec4 head = view_projection * vec4(p, 1.0);
    if (head.w < 0.15 || any(greaterThan(abs(head.xy), head.ww * 1.05 + 0.05))) return;

    float d;
    float weight = drop_weight(p, in_birth.z, gl_VertexID, d);
    if (weight <= 0.0) return;
    float rise = (p.y - container_shape.z) / container_shape.w;
    weight *= clamp((1.0 - rise) * 8.0, 0.0, 1.0) * step(p.y, area_shape.w);

    uint word = flake_word(uint(gl_VertexID));
    float diameter = flake_diameter(in_birth.w, drop_law);
    int habit = flake_habit(word, drop_law);
    float scale = (1.0 + (drop_look.x - 1.0) * d * d) * drop_look.y;
    float real = flake_size(diameter, habit, drop_law) * 1e-3;
    float size = real * drop_look.z;
    if (snow_motion.w == LIU_TONG) {
        real = size = 0.05 + 0.01 * (float((word >> 5u) & 1023u) * (2.0 / 1023.0) - 1.0);
    }
    float covered = 0.785398 * real * real * weight * drop_load.w;
    size *= scale;

    // Relative to the camera, on the picture.
    vec3 path = (in_velocity - camera_velocity.xyz) * snow_look.y;
    vec4 tail = head - view_projection * vec4(path, 0.0);
    if (tail.w < 0.1) return;
    float per_metre = camera_position.w / head.w;
    vec2 way = (head.xy / head.w - tail.xy / tail.w) * 0.5 * view_size.xy;
    way *= drop_look.y;

    float pixels = size * per_metre;
    float soft = snow_look.x * max(1.0 - head.w / FOCUS, 0.0) * per_metre;
    float shown = max(pixels + soft, SMALLEST);
    float smear = length(way);
    // What is drawn is the flake, blurred and drawn out; what it stands for fills that too, but the
    // fainter it must be at most.
    float blurred = pixels + soft;
    float longer = 1.0 + 1.273 * smear / blurred;
    float area = blurred * blurred * longer / (per_metre * per_metre);
    float most = drop_look.w * inversesqrt(longer) * pixels / blurred;
    float opacity = min(covered / (FILL * area), most) * min(blurred / SMALLEST, 1.0);
    opacity *= smoothstep(0.2, 0.7, head.w);
    if (opacity < 0.004) return;

    float swing = (30.0 + float((word >> 8u) & 63u)) * snow_motion.y * 0.5;
    float tilt = mix(0.62 + 0.38 * turned(swing).x, 1.0, flake_clumped(diameter) * 0.7);
    tilt = max(tilt, 0.3);
    ivec2 layer = flake_layer(word, diameter, habit, drop_law.z);
    float radius = 0.5 * shown;
    float turn = float(word >> 26u) * 0.015625 + view_time.z * (float((word >> 3u) & 31u) - 15.5) * 0.0095;
    vec2 turning = normalize(turned(turn));
#ifdef FAR
    // The smallest have no shape: discs of what one sees of them.
    float flat_by = mix(1.0, tilt, clamp(radius - 1.0, 0.0, 1.0));
    float wide = max(shown * sqrt(tilt / flat_by), SMALLEST);
    radius = 0.5 * wide;
    opacity *= WHITE[layer.y] * tilt * shown * shown / (flat_by * wide * wide);
    tilt = flat_by;
#else
    vs_shown.zw = vec2(layer.x, log2(PICTURE / shown * (1.0 + (soft + 0.7 * smear) / max(pixels, 1.0))));
#endif
    // Drawn out along its way, about the middle of it.
    vec2 e = smear > 0.5 ? way / smear : vec2(1.0, 0.0);
    mat2 drawn = mat2(e * (radius + 0.5 * smear), vec2(-e.y, e.x) * radius);
    vec2 along = drawn * turning;
    vec2 across = drawn * vec2(-turning.y, turning.x) * tilt;
    vec2 pixel = 1.0 / view_size.xy;
    vs_place = vec4(head.xyz / head.w, radius);
    vs_place.xy -= way * pixel;
    vs_axes = vec4(along * pixel, across * pixel) * 2.0;

    vec3 ray = p - camera_position.xyz;
    float away = length(ray);
    // No two flakes lie alike to the light.
    vec3 light = flake_light(p, ray / away) * (0.85 + 0.3 * float((word >> 7u) & 63u) / 63.0);
    opacity *= flake_denser(radius);
    vs_shown.xy = pack_color(vec4(encode(in_fog(light, away)), opacity));
}
