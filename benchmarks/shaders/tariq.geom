// Expands a drop to a sprite along its path and finds the four appearances of the library that lie
// nearest to its view and light angles. The published shader finds them anew in every pixel: once
// a drop gives the same picture.
layout(points) in;
layout(triangle_strip, max_vertices = 4) out;

#define KINDS 2.0
#define AZIMUTHS 9.0

uniform mat4 view_projection;
uniform vec3 eye;
uniform vec3 wind;
uniform float exposure;  // s
uniform float width;     // factor on the drop's diameter
uniform float size;      // factor on the whole streak
uniform vec3 sun_direction;
#ifdef LAMP
uniform vec3 lamp_position;
#endif

in vec3 vs_position[];
in vec4 vs_drop[];
out vec2 gs_uv;
flat out vec4 gs_layers;
flat out vec4 gs_blend;  // between elevations, between azimuths, 1 if mirrored, brightness
#ifdef LAMP
flat out vec4 gs_lamp_layers;
flat out vec4 gs_lamp_blend;
#endif

const float DEGREES = 57.2957795;

// Layers and blend of the appearances for light from direction l, seen along e, of a drop moving
// along n; all unit. Steps of 20 degrees, the first at 10.
void appearance(vec3 l, vec3 e, vec3 n, float kind, out vec4 layers, out vec3 blend)
{
    float up = dot(l, n);
    float elevation = clamp((abs(acos(up) * DEGREES - 90.0) - 10.0) / 20.0, 0.0, 4.0);
    vec3 lp = normalize(l - up * n);
    vec3 ep = normalize(e - dot(e, n) * n);
    float azimuth = clamp((acos(clamp(dot(ep, lp), -1.0, 1.0)) * DEGREES - 10.0) / 20.0, 0.0, 8.0);
    vec2 low = floor(vec2(elevation, azimuth));
    vec2 high = min(low + 1.0, vec2(4.0, 8.0));
    layers = (vec4(low.x, low.x, high.x, high.x) * AZIMUTHS
              + vec4(low.y, high.y, low.y, high.y)) * KINDS + kind;
    blend = vec3(elevation - low.x, azimuth - low.y, step(dot(n, cross(ep, lp)), 0.0));
}

void main()
{
    vec3 path = (wind - vec3(0.0, vs_drop[0].x, 0.0)) * (exposure * size);
    vec4 head = gl_in[0].gl_Position;
    vec4 tail = head - view_projection * vec4(path, 0.0);
    if (min(head.w, tail.w) < 0.1) return;
    vec2 h = head.xy / head.w;
    vec2 t = tail.xy / tail.w;
    if (any(greaterThan(min(h, t), vec2(1.02))) || any(lessThan(max(h, t), vec2(-1.02)))) return;

    vec3 away = eye - vs_position[0];
    vec3 n = normalize(path);
    vec3 e = normalize(away);
    vec4 layers;
    vec3 blend;
    appearance(sun_direction, e, n, vs_drop[0].w, layers, blend);
#ifdef LAMP
    vec3 to_lamp = lamp_position - vs_position[0];
    float fall_off = min(1.0 / dot(to_lamp, to_lamp), 1.0);
    vec4 lamp_layers;
    vec3 lamp_blend;
    appearance(normalize(to_lamp), e, n, vs_drop[0].w, lamp_layers, lamp_blend);
#endif
    vec3 across = normalize(cross(n, away)) * (0.5 * width * size * vs_drop[0].y);
    vec4 side = view_projection * vec4(across, 0.0);
    for (int i = 0; i < 4; ++i) {
        gs_uv = vec2(float(i & 1), float(i >> 1));
        gl_Position = mix(head, tail, gs_uv.y) + side * (gs_uv.x * 2.0 - 1.0);
        gs_layers = layers;
        gs_blend = vec4(blend, vs_drop[0].z);
#ifdef LAMP
        gs_lamp_layers = lamp_layers;
        gs_lamp_blend = vec4(lamp_blend, vs_drop[0].z * fall_off);
#endif
        EmitVertex();
    }
    EndPrimitive();
}
