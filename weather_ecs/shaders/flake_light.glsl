// Light that a flake shows at p, linear: white, it takes light from all sides and gives it to all, a
// little more onwards than back. ray: from the camera to p, unit. NO_LAMPS: as in drop_light.glsl.
#include <block:RainView>
#include <block:Snow>

vec3 flake_light(vec3 p, vec3 ray)
{
    float onwards = max(dot(ray, sun_direction.xyz), 0.0);
    vec3 light = snow_color.rgb + sun_color.rgb * (0.22 + 0.5 * onwards * onwards * onwards);
    light += flash_color.rgb * (0.6 + 0.4 * max(dot(ray, flash_direction.xyz), 0.0));
#ifndef NO_LAMPS
    for (int i = 0; i < light_count; ++i) {
        vec3 away = light_position[i].xyz - p;
        float r2 = dot(away, away);
        float fade = max(1.0 - r2 / (light_position[i].w * light_position[i].w), 0.0);
        if (fade > 0.0) {
            float forward = 0.6 + 0.4 * max(dot(ray, away * inversesqrt(r2)), 0.0);
            light += light_color[i].rgb * (2.5 * fade * fade * forward / (1.0 + 0.5 * r2));
        }
    }
#endif
    return light;
}
