// Moves the drops of a box by transform feedback; what leaves at one face comes in at the other.
uniform vec3 box_low;
uniform vec3 box_size;
uniform vec3 wind;  // m/s
uniform float dt;   // s

in vec3 in_position;
in vec4 in_drop;  // fall speed, diameter, brightness, kind

out vec3 out_position;

void main()
{
    vec3 p = in_position + vec3(wind.x, wind.y - in_drop.x, wind.z) * dt - box_low;
    out_position = box_low + p - floor(p / box_size) * box_size;
}
