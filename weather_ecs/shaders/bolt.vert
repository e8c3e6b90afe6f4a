// One piece of a lightning channel as a quad round it, or round the glow of the air about it.
#include <block:RainView>
#include "fog.glsl"

uniform mat4 bolt_matrix;  // from camera-relative places to the picture
uniform vec4 bolt_color;  // linear RGB of the channel; factor on all lights
uniform vec4 bolt_shape;  // m, width; pixels, least and most half width; 1: the glow

in vec4 in_begin;  // m from the camera, light
in vec4 in_end;

out vec2 vs_at;  // pixels, along and across, from the piece's beginning
flat out vec4 vs_piece;  // pixels: length, half width, edge; light
flat out vec3 vs_color;

void main()
{
    vs_at = vec2(0.0);
    vs_piece = vec4(0.0);
    vs_color = vec3(0.0);
    gl_Position = vec4(0.0, 0.0, 2.0, 1.0);
    vec4 a = bolt_matrix * vec4(in_begin.xyz, 1.0);
    vec4 b = bolt_matrix * vec4(in_end.xyz, 1.0);
    if (min(a.w, b.w) < 0.1) return;
    float light = 0.5 * (in_begin.w + in_end.w);
    vec2 way = (b.xy / b.w - a.xy / a.w) * 0.5 * view_size.xy;
    float span = length(way);
    way = span > 1e-4 ? way / span : vec2(0.0, 1.0);
    float pixels = 0.5 * bolt_shape.x * sqrt(light) * camera_position.w / (0.5 * (a.w + b.w));
    // It dazzles: the brighter the wider, however far.
    float least = bolt_shape.y * (1.0 + min(light, 4.0) * (bolt_shape.w > 0.5 ? 0.0 : 0.35));
    float half_width = clamp(pixels, least, bolt_shape.z);
    float edge = bolt_shape.w > 0.5 ? 0.0 : 1.0;
    float reach = half_width + edge;
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
    vs_at = vec2(mix(-reach, span + reach, corner.x), mix(-reach, reach, corner.y));
    vec2 from = vs_at.x * way + vs_at.y * vec2(-way.y, way.x);
    // Thinner than a pixel can be: fainter.
    float thin = bolt_shape.w > 0.5 ? 1.0 : min(pixels / least + 0.15, 1.0);
    vs_piece = vec4(span, half_width, edge, bolt_color.w * light * thin);
    vs_color = bolt_color.rgb * fog_left_above(0.5 * (in_begin.xyz + in_end.xyz));
    float share = clamp(vs_at.x / max(span, 1e-4), 0.0, 1.0);
    vec4 p = mix(a, b, share);
    vec2 ndc = a.xy / a.w + from / (0.5 * view_size.xy);
    // No far plane cuts it off.
    gl_Position = vec4(ndc, min(mix(a.z / a.w, b.z / b.w, share), 0.999999), 1.0);
}
