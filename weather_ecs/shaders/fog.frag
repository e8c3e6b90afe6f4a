// Fog over a picture whose own shaders know none, by its depth; physics/optics.py in NumPy. Every
// instruction here is paid for a million times.
#include <block:RainView>
#include <block:FogView>

uniform sampler2D scene_depth;

noperspective in vec2 vs_ray;
noperspective in vec2 vs_place;
noperspective in float vs_rise;
out vec4 color;

const float DARK = 0.02;  // light of the things for which the blending is right, over the fog's
const float DARK_SHOWN = 0.1414213562;  // its root: what such a thing has in the picture

void main()
{
    float depth = textureLod(scene_depth, vs_place, 0.0).r;
    // Optical depth times log2(e): up to the scene, or of the fog's layer on a round Earth.
    float over = depth < 1.0 ? depth + fog_law.y : max(vs_rise, 0.0) + fog_law.z;
    float x = fog_law.x * sqrt((dot(vs_ray, vs_ray) + 1.0) / (over * over));
    // 2^-x to 0.002, for less than it costs.
    float q = 1.0 + x * (0.35011 + x * (0.04957 + x * 0.01292));
    float covered = 1.0 - 1.0 / (q * q);
    float opacity = sqrt(DARK + (1.0 - DARK) * covered) - DARK_SHOWN;
    color = vec4(fog_shown.rgb, opacity * (1.0 / (1.0 - DARK_SHOWN)));
}
