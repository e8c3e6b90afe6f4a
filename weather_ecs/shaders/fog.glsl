// Fog between the camera and what the weather draws. f = exp(-extinction distance), the share of a
// thing's own light that is left; the rest is the fog's. physics/optics.fog_factor in NumPy.
#include <block:RainView>

// distance: m, along the view ray and not the depth of a plane.
float fog_left(float distance)
{
    return exp2(-fog_color.w * distance);
}

// Linear light as it arrives from `distance`. Opacity stays: what is seen through it has its own fog.
vec3 in_fog(vec3 light, float distance)
{
    return mix(fog_color.rgb, light, fog_left(distance));
}
