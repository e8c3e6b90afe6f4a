// Laws of one flake; physics/snow.py says where they come from, physics/snow_step.py is the oracle.
// D: diameter in mm of the drop that it melts to. law = (slope in 1/mm, 1 - exp(-3.8 slope), share
// that has melted, temperature at the ground). What a flake is by chance is in the bits of one word.
#include "hash.glsl"
#include "wave.glsl"
#include <block:Snow>

const float LIU_TONG = 1.0;  // snow_motion.w: the paper's flakes

uint flake_word(uint id)
{
    return hash_word(id ^ 0x5F356495u);
}

// Inverse of the distribution of melted diameters in the air, between 0.2 and 4 mm.
float flake_diameter(float quantile, vec4 law)
{
    return min(0.2 - log(max(1.0 - quantile * law.y, 1e-7)) / law.x, 4.0);
}

// 0 plates, 1 columns and needles, 2 stars and dendrites: by the cold in which the flake grew.
int flake_habit(uint word, vec4 law)
{
    float cold = 3.0 - law.w + 12.0 * (float(word & 255u) * (1.0 / 256.0));
    if (cold <= 4.0) return 0;
    if (cold <= 10.0) return 1;
    if (cold <= 12.0) return 0;
    if (cold <= 17.0) return 2;
    return cold <= 22.0 ? 0 : 1;
}

// 0 for a single crystal, 1 for a clump of many.
float flake_clumped(float diameter)
{
    float x = clamp((diameter - snow_motion.z) * 2.5, 0.0, 1.0);
    return x * x * (3.0 - 2.0 * x);
}

// Diameter in mm as the flake is.
float flake_size(float diameter, int habit, vec4 law)
{
    float crystal = habit == 2 ? 7.5 : (habit == 1 ? 3.0 : 2.7);
    return diameter * mix(mix(crystal, 4.0, flake_clumped(diameter)), 1.3, law.z);
}

// Of a clump, m/s: 0.8 (4 D)^0.16 to 1e-4, by roots, which cost less than a power.
float aggregate_speed(float diameter)
{
    float root = sqrt(sqrt(diameter));
    return 0.1896008 + root * (1.029535 + root * (0.05063818 * root - 0.271041));
}

// In still air, now, m/s: it falls and sways.
vec3 flake_velocity(uint id, float quantile, vec4 law)
{
    uint word = flake_word(id);
    vec2 often = vec2((word >> 8u) & 63u, (word >> 14u) & 63u);
    vec2 phase = vec2((word >> 20u) & 63u, word >> 26u);
    float diameter = flake_diameter(quantile, law);
    float clumped = flake_clumped(diameter);
    int habit = flake_habit(word, law);
    float fall = mix(habit == 2 ? 0.31 : 0.5, aggregate_speed(diameter), clumped);
    fall += (9.65 - 10.3 * exp(-0.6 * diameter) - fall) * law.z * law.z;
    // Two swings of frequencies of their own, 1/2 to 1 1/2 a second: a way that sways and spirals.
    vec2 swing = wave((often + 30.0) * snow_motion.y + phase * (1.0 / 64.0));
    float sway = snow_motion.x * (1.0 - law.z);
    float side = sway * fall * mix(habit == 0 ? 0.4 : 0.2, 0.35, clumped);
    float down = fall * (1.0 + 0.1 * sway * (2.0 * swing.x * swing.x - 1.0));
    // The paper's by a choice at the end: a compiler for vectors works out both sides of a branch.
    vec3 paper = vec3(phase.x, often.x, phase.y) * (2.0 / 63.0) - 1.0;
    paper = vec3(0.0, -1.0, 0.0) + paper * vec3(0.25, 0.2, 0.25);
    return snow_motion.w == LIU_TONG ? paper : vec3(side * swing.x, -down, side * swing.y);
}
