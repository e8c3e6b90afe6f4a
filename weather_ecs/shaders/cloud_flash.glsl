// Lightning in clouds; the same as in physics/cloud_light.py. All colours linear RGB.
#include <block:CloudView>

const float FLASH_SHADE = 0.8;  // of it on what is turned from the sun

// Of the cloud that it is in, which is lit as a whole; q: place over the cloud's half size.
vec3 own_flash(float strength, vec3 q)
{
    return strength * max(1.0 - 0.55 * dot(q, q), 0.12) * vec3(0.86, 0.90, 1.0);
}

// Where the flashes are; p: place from the camera, m.
vec3 near_flash(vec3 p)
{
    vec3 sum = vec3(0.0);
    for (int k = 0; k < cloud_flashes; ++k) {
        vec3 way = p - cloud_flash_at[k].xyz;
        float u = 1.0 + dot(way, way) * cloud_flash_at[k].w;
        sum += cloud_flash_color[k].rgb * inversesqrt(u * u * u);
    }
    return sum;
}
