// A billboard's shadow on the level ground: the ellipse that the sun sees, laid down.
#include "cloud_row.glsl"

uniform usampler2D cloud_stream;
uniform vec3 shadow_sun;  // towards it; not too low
uniform float shadow_scale;  // 2 / side of the map, 1/m

out vec3 vs_uv;
flat out float vs_opacity;

void main()
{
    uvec2 pair = texelFetch(cloud_stream, ivec2(gl_InstanceID & 1023, gl_InstanceID >> 10), 0).rg;
    Cloud cloud = fetch_cloud(int(pair.y));
    Billboard b = fetch_billboard(int(pair.x));
    float there = presence(cloud, b.order);
    vec3 p = cloud.center + place_in_cloud(cloud, b.position);
    vec2 middle = p.xz - p.y * shadow_sun.xz / shadow_sun.y;
    vec2 size = b.size * cloud.scale * (0.55 + 0.45 * there);
    float level = length(shadow_sun.xz);
    vec2 along = level > 1e-4 ? shadow_sun.xz / level : vec2(1.0, 0.0);
    vec3 unit = normalize(shadow_sun);
    float high = length(vec2(size.y * length(unit.xz), size.x * unit.y)) / unit.y;
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
    vec2 turn = vec2(cos(b.turn), sin(b.turn));
    vec2 turned = vec2(corner.x * turn.x - corner.y * turn.y, corner.x * turn.y + corner.y * turn.x);
    vec2 at = middle + 0.5 * (along * (turned.x * high) + vec2(-along.y, along.x) * (turned.y * size.x));
    vs_uv = vec3(corner * 0.5 + 0.5, b.image);
    vs_opacity = b.opacity * there * cloud.opacity;
    gl_Position = vec4(at * shadow_scale, 0.0, 1.0);
}
