// A drop off an eave: a bright streak, or the little crown that it throws up.
#include "tone.glsl"

in vec2 v_corner;
in vec4 v_color;
flat in float v_landed;

out vec4 out_color;

void main() {
    float x = abs(v_corner.x), y = v_corner.y;
    float streak = (1.0 - x * x) * min(y * 2.5, 1.0);
    // Walls of water that lean outwards, and the film between them at the bottom.
    float wall = x - 0.25 - 0.65 * y;
    float crown = exp(-60.0 * wall * wall) * (1.0 - y);
    crown = max(crown, exp(-60.0 * y * y) * (1.0 - x) * 0.6);
    out_color = vec4(tone(v_color.rgb), v_color.a * mix(streak, crown, v_landed));
}
