// Fog between the camera and what the weather draws. f = exp(-extinction distance), the share of a
// thing's own light that is left; the rest is the fog's. physics/optics.fog_factor in NumPy.
#include <block:RainView>

const float ROUND = 2.0 / 6.371e6;  // 1/m, over the Earth's radius: the layer ends at the horizon too

// distance: m, along the view ray and not the depth of a plane.
float fog_left(float distance)
{
    return exp2(-fog_color.w * distance);
}

// The same for what stands at `way` (m, world axes) from the camera and above the fog's layer: no more
// of it is in between than a ray of this elevation meets. A cloud, say.
float fog_left_above(vec3 way)
{
    float away = length(way);
    float up = max(way.y / max(away, 1e-3), 0.0);
    return fog_left(min(away, fog_shown.w / (up + sqrt(ROUND * fog_shown.w + 1e-9))));
}

// Linear light as it arrives from `distance`. Opacity stays: what is seen through it has its own fog.
vec3 in_fog(vec3 light, float distance)
{
    return mix(fog_color.rgb, light, fog_left(distance));
}
