// How fast what rain meets first is moving; over the same places as the collision heightmap.
#include "shelter.glsl"
#include "motion.glsl"

uniform sampler2D shelter_motion;

// In bytes, see motion.glsl, at a place of the map; of what lies outside nothing is known to move.
vec3 met_motion(vec3 m)
{
    if (!in_shelter_map(m)) return vec3(128.0);
    return floor(texelFetch(shelter_motion, ivec2(m.xy * shelter_size.x), 0).rgb * 255.0 + 0.5);
}

// In m/s.
vec3 met_velocity(vec3 m)
{
    return motion_velocity(met_motion(m));
}
