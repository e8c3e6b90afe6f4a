// Lightning in clouds; the same as in physics/cloud_light.py. All colours linear RGB.
#include <block:CloudView>
#include "cloud_share.glsl"

const float FLASH_SHADE = 0.8;  // of it on what is turned from the sun

// Of the cloud that it is in, which is lit as a whole; q: place over the cloud's half size.
vec3 own_flash(float strength, vec3 q)
{
    return strength * max(1.0 - 0.55 * dot(q, q), 0.12) * vec3(0.86, 0.90, 1.0);
}

// Where the flashes are, but for one of them (-1: all).
vec3 flashes_but(int left_out, vec3 p)
{
    vec3 sum = vec3(0.0);
    for (int k = 0; k < cloud_flashes; ++k) {
        if (k != left_out) sum += cloud_flash_color[k].rgb * flash_share(cloud_flash_at[k], p);
    }
    return sum;
}

vec3 near_flash(vec3 p)
{
    return flashes_but(-1, p);
}

// The one that is brightest at p; -1 where there is none.
int brightest_flash(vec3 p)
{
    int found = -1;
    float most = 0.0;
    for (int k = 0; k < cloud_flashes; ++k) {
        float light = cloud_flash_color[k].g * flash_share(cloud_flash_at[k], p);
        if (light > most) {
            most = light;
            found = k;
        }
    }
    return found;
}
