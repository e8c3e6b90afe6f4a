// Light of a vertex of a cloud's billboard; the same symbols as physics/cloud_light.py.
// v: vertex from the cloud's centre; s: the centre of its seed from there; way: unit, from the
// camera to the vertex; a: what the seed's ray has lost, 0 to 1. All colours linear RGB.
#include <block:CloudView>
#include "encode.glsl"

const float FOOT = 2600.0;  // m
const float OVERLAP = 1.3;  // seeds in which a ray is at once

const float HIGHEST = 12000.0;  // m, of the table of the sun by height
const int SUN_LEVELS = 7;

// The sun at a height in m; as physics/high_sun.sun_at.
vec3 sun_at(float height)
{
    float at = sqrt(clamp(height / HIGHEST, 0.0, 1.0)) * float(SUN_LEVELS - 1);
    int i = min(int(at), SUN_LEVELS - 2);
    return mix(cloud_suns[i].rgb, cloud_suns[i + 1].rgb, at - float(i));
}

struct Light {
    vec3 lit;  // of what faces the sun
    vec3 shade;  // of what is turned from it
    vec3 rim;  // that shines through where the cloud is thin
    float facing;  // 0 to 1: which of the two the vertex itself shows
    float relief;  // how much the image's own relief adds to it
    float soft;  // 0 to 1: how soft the image's outline is
};

// The dissertation's own: diffuse = clamp(dot(sun, unit(v)) * sun colour - absorbed, 0, 1).
Light plain_light(vec3 v, float a)
{
    vec3 n = v / max(length(v), 1e-6);
    vec3 diffuse = clamp(dot(cloud_sun.xyz, n) * cloud_sun_color.rgb - a, 0.0, 1.0);
    vec3 color = diffuse + cloud_ambient.rgb;
    return Light(color, color, vec3(0.0), 0.5, 0.0, 0.0);
}

Light full_light(Cloud cloud, vec3 v, vec3 s, vec3 way, float a)
{
    vec3 q = v / cloud.half_size;
    // The way out of the cloud, of the whole as an ellipsoid and of the seed; and what is seen of a
    // cloud is turned towards the camera.
    vec3 whole = q / cloud.half_size;
    vec3 own = v - s;
    vec3 n = 0.42 * whole / max(length(whole), 1e-9) + 0.50 * own / max(length(own), 1e-3)
        - 0.36 * way;
    n /= max(length(n), 1e-6);
    // Of a tower only the foot counts as base.
    float high = cloud.half_size.y * 2.0;
    float rise = clamp((v.y - cloud.base) / min(high, FOOT), 0.0, 1.0);
    float towards = dot(cloud_sun.xyz, n);
    // The ray was followed from the seed's centre; the side towards the sun has less before it.
    a = clamp(a - 0.6 * cloud.thick * dot(own, cloud_sun.xyz), 0.0, 1.0);
    // Under its top no ray has come farther than from there.
    float under_top = max(high + cloud.base - v.y, 0.0) / max(cloud_sun.y, 0.15);
    a = min(a, OVERLAP * cloud.thick * under_top);
    float through = exp(-0.75 * a);

    // Sky from above, ground and lit air from below; less of both deep inside.
    float up = 0.5 + 0.5 * n.y;
    vec3 ambient = mix(cloud_below.rgb, cloud_above.rgb, up * up * (3.0 - 2.0 * up));
    ambient *= cloud_look.z * (0.62 + 0.38 * rise);
    float deep = cloud_look.y * (0.30 + 0.70 * cloud.darkness);
    float under = 1.0 - deep * (1.0 - smoothstep(0.0, 0.55, rise)) * 0.62;
    // Its top has the sun that never comes to the base.
    float gloom = 1.0 - 0.38 * cloud.darkness * cloud_look.y * (1.0 - 0.9 * smoothstep(0.4, 1.0, rise));

    vec3 here = sun_at(cloud_sun.w + cloud.center.y + v.y) * (1.0 - cloud.shaded.x);
    vec3 sun = here * through;
    float ahead = dot(way, cloud_sun.xyz);
    // Forward scattering of droplets, broad and narrow (two lobes of Henyey and Greenstein's kind).
    float forward = 0.16 * pow(max(0.5 + 0.5 * ahead, 0.0), 6.0) + 0.7 * pow(max(ahead, 0.0), 24.0);

    Light light;
    float dim = under * gloom;
    // A low sun shines under the base.
    sun *= mix(1.0, dim, smoothstep(0.02, 0.30, cloud_sun.y));
    ambient *= dim * (1.0 - cloud.shaded.y);
    light.lit = sun * (0.92 + 0.08 * towards) + ambient;
    light.shade = sun * (0.22 + 0.06 * towards) + ambient * 0.95;
    light.facing = clamp(0.60 + 0.58 * towards - 0.28 * a, 0.0, 1.0);
    light.relief = (0.62 - 0.38 * a) * (0.45 + 0.55 * rise);
    light.soft = 0.75 * (1.0 - rise) * (1.0 - rise);

    // Lining: where the cloud ends beside the line of sight, so that little lies behind.
    vec3 aside = q - way * dot(q, way);
    float edge = smoothstep(0.50, 1.0, length(aside));
    light.rim = cloud_look.x * here * forward * (0.08 + 0.92 * edge) * (1.0 - 0.5 * a);

    return light;
}
