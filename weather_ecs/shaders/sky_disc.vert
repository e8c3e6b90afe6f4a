// A square round the sun or the moon.
#include "sky_show.glsl"

uniform vec3 disc_direction;
uniform vec3 disc_right;  // unit, in the picture's sense of somebody who looks at it with north up
uniform vec3 disc_up;
uniform vec2 disc_size;  // tangent of the radius; side of the square over the disc

out vec3 vs_direction;
out vec2 vs_place;  // 1 at the disc's rim

void main()
{
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
    vs_place = corner * disc_size.y;
    vec2 off = vs_place * disc_size.x;
    vs_direction = disc_direction + off.x * disc_right + off.y * disc_up;
    gl_Position = sky_position(vs_direction);
}
