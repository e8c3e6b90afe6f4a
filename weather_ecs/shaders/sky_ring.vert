// A ring round a direction, with the colours that physics/bows.py gives it by the angle.
#include "sky_show.glsl"

uniform vec3 ring_axis;
uniform vec3 ring_right;  // unit, level
uniform vec3 ring_up;
uniform vec3 ring_light;
uniform float ring_strength[33];  // from the right over the top to the left, and the same below

in vec4 in_ring;  // cosine and sine of the angle from the axis; turn over pi, 0 to 2
in vec3 in_color;

out vec3 vs_light;

void main()
{
    float turn = in_ring.z * 3.14159265;
    vec3 side = cos(turn) * ring_right + sin(turn) * ring_up;
    vec3 d = in_ring.x * ring_axis + in_ring.y * side;
    float at = clamp(in_ring.z > 1.0 ? 2.0 - in_ring.z : in_ring.z, 0.0, 1.0) * 32.0;
    int i = min(int(at), 31);
    float strength = mix(ring_strength[i], ring_strength[i + 1], at - float(i));
    vs_light = in_color * ring_light * strength * sky_left(d) * smoothstep(-0.02, 0.03, d.y);
    gl_Position = sky_position(d);
}
