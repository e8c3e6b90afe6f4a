// Light that water in the air shows at p, linear: the sky of the half behind it, upside down; the
// sun's glow around it; lamps, most of all against the light. ray: from the camera to p, unit.
#include <block:RainView>

vec3 drop_light(vec3 p, vec3 ray)
{
    float glow = pow(max(dot(ray, sun_direction.xyz), 0.0), 8.0);
    vec3 light = drop_color.rgb + sun_color.rgb * (0.6 * glow);
    light += flash_color.rgb * (0.35 + 0.65 * pow(max(dot(ray, flash_direction.xyz), 0.0), 4.0));
    for (int i = 0; i < light_count; ++i) {
        vec3 away = light_position[i].xyz - p;
        float r2 = dot(away, away);
        float fade = max(1.0 - r2 / (light_position[i].w * light_position[i].w), 0.0);
        if (fade > 0.0) {
            float forward = 0.35 + 0.65 * pow(max(dot(ray, away * inversesqrt(r2)), 0.0), 4.0);
            light += light_color[i].rgb * (fade * fade * forward / (1.0 + 0.5 * r2));
        }
    }
    return light;
}
