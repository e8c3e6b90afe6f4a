// Fog over a picture whose own shaders know none, by its depth; physics/optics.py in NumPy.
#include <block:RainView>
#include <block:FogView>

uniform sampler2D scene_depth;

noperspective in vec3 vs_ray;
out vec4 color;

const float DARK = 0.02;  // light of the things for which the blending is right, over the fog's
const float DARK_SHOWN = 0.1414213562;  // its root: what such a thing has in the picture

void main()
{
    // Where the host has no depth, one texel stands for all.
    ivec2 texel = min(ivec2(gl_FragCoord.xy - view_origin.xy), textureSize(scene_depth, 0) - 1);
    float depth = texelFetch(scene_depth, texel, 0).r;
    float length2 = dot(vs_ray.xy, vs_ray.xy) + 1.0;
    // Optical depth times log2(e): up to the scene, or of the fog's layer on a round Earth.
    float up = max(vs_ray.z, 0.0);
    bool sky = depth >= 1.0;
    float t_inverse = depth * 2.0 - 1.0 + view_depth.x;
    float over = sky ? up * up + fog_law.z * length2 : t_inverse * t_inverse;
    float optical = (sky ? fog_law.y : fog_law.x) * sqrt(length2 / over);
    float covered = 1.0 - exp2(-optical);
    if (covered < 0.001) discard;  // less than a step of an 8-bit target
    float opacity = sqrt(DARK + (1.0 - DARK) * covered) - DARK_SHOWN;
    color = vec4(fog_shown.rgb, opacity / (1.0 - DARK_SHOWN));
}
