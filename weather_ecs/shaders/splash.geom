// The crown: a quad that stands along the surface's normal and turns about it towards the camera.
layout(points) in;
layout(triangle_strip, max_vertices = 4) out;
#include "splash.glsl"
#include "splash_quad.glsl"

void main()
{
    vec4 form = vs_form[0];
    if (form.x <= 0.0) return;
    vec3 up = vs_normal[0];
    vec3 ray = vs_at[0] - camera_position.xyz;
    vec3 side = cross(ray, up);
    float across = length(side);
    if (across < 1e-4) return;
    uint h = hash_word(floatBitsToUint(form.w));
    float variant = float(h & 1u);
    // No two alike: mirrored or not, leaning a little, taller or lower.
    up = normalize(up + side / across * (0.35 * hash_unit(h) - 0.175));
    side = cross(ray, up);
    side *= ((h & 2u) != 0u ? 1.0 : -1.0) / length(side);
    float pixel = vs_at[0] == camera_position.xyz ? 0.0 : length(ray) / camera_position.w;
    float reach = max(form.x * growth(form.y) * 1.33, pixel);
    float tall = reach * (0.8 + 0.5 * hash_unit(h ^ 0x9E3779B9u));
    vec3 middle = vs_at[0] + up * (tall * (TALL - BELOW));
    float kind = (form.z > 0.5 ? BURST : CROWN) + variant;
    quad(middle, side * reach, up * (tall * TALL), layer_at(kind, form.y), vs_color[0]);
}
