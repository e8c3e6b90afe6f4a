// The collision heightmap: what rain meets first along its mean fall direction. shelter_matrix takes
// world points to (u, v, depth), all in [0, 1] where the map knows.
#include <block:Shelter>

uniform sampler2D shelter_map;

bool sheltered(vec3 p)
{
    vec3 m = (shelter_matrix * vec4(p, 1.0)).xyz;
    if (any(lessThan(m.xy, vec2(0.0))) || any(greaterThan(m.xy, vec2(1.0)))) return false;
    return m.z > textureLod(shelter_map, m.xy, 0.0).r + shelter_bias.x;
}
