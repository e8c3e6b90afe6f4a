// Light that water in the air shows at p, linear: the sky of the half behind it, upside down; the
// sun's glow around it; lamps, most of all against the light. ray: from the camera to p, unit. NO_LAMPS:
// there are none: a compiler for vectors works out a first one before it looks.
#include <block:RainView>

vec3 drop_light(vec3 p, vec3 ray)
{
    float glow = max(dot(ray, sun_direction.xyz), 0.0);
    glow *= glow;
    glow *= glow;
    glow *= glow;
    vec3 light = drop_color.rgb + sun_color.rgb * (0.6 * glow);
    float flash = max(dot(ray, flash_direction.xyz), 0.0);
    flash *= flash;
    light += flash_color.rgb * (0.35 + 0.65 * flash * flash);
#ifndef NO_LAMPS
    for (int i = 0; i < light_count; ++i) {
        vec3 away = light_position[i].xyz - p;
        float r2 = dot(away, away);
        float fade = max(1.0 - r2 / (light_position[i].w * light_position[i].w), 0.0);
        if (fade > 0.0) {
            float forward = 0.35 + 0.65 * pow(max(dot(ray, away * inversesqrt(r2)), 0.0), 4.0);
            light += light_color[i].rgb * (fade * fade * forward / (1.0 + 0.5 * r2));
        }
    }
#endif
    return light;
}
