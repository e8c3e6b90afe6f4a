// A piece of a lightning channel, encoded. Cores are blended by their maximum, so that joints do not
// show; glows are added up: each is the integral along its piece of e / (d^2 + s^2 + e^2).
#include "encode.glsl"

uniform vec4 bolt_shape;

in vec2 vs_at;
flat in vec4 vs_piece;
flat in vec3 vs_color;
out vec4 color;

const float CORE = 0.06;  // of the glow's half width: e

void main()
{
    float aside = vs_at.x - clamp(vs_at.x, 0.0, vs_piece.x);
    float away = length(vec2(aside, vs_at.y));
    float share;
    if (bolt_shape.w > 0.5) {
        float e = CORE * vs_piece.y;
        float q = inversesqrt(vs_at.y * vs_at.y + e * e);
        share = e * q * (atan((vs_piece.x - vs_at.x) * q) + atan(vs_at.x * q)) * 0.31830989;
        float rim = max(1.0 - away * away / (vs_piece.y * vs_piece.y), 0.0);
        color = vec4(vs_color * (vs_piece.w * share * rim * rim), 0.0);
        return;
    }
    share = clamp((vs_piece.y - away) / vs_piece.z + 0.5, 0.0, 1.0);
    if (share <= 0.0) discard;
    color = vec4(min(encode(vs_color * vs_piece.w) * share, vec3(1.0)), 0.0);
}
