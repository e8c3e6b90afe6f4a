// The sheet of veils before the scene, coarser than the picture, over it: each pixel has its share of
// the optical depth by its own distance.
#include <block:RainView>
#include "grain.glsl"

uniform sampler2D scene_depth;
uniform sampler2D veil_sheet;

noperspective in vec3 vs_ray;
noperspective in vec2 vs_place;
out vec4 color;

void main()
{
    float depth = texture(scene_depth, vs_place).r;
    float t = view_depth.y / (depth * 2.0 - 1.0 + view_depth.x);
    vec4 per_km = texture(veil_sheet, vs_place);
    float opacity = 1.0 - exp(-1e-3 * per_km.a * t);
    color = vec4(per_km.rgb / max(per_km.a, 1e-6) + pixel_grain(), opacity);
}
