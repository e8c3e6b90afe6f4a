// One frame's camera, light and weather; filled by demo_game.render.frame_block.
layout(std140) uniform Frame {
    mat4 view_projection;
    mat4 shadow_matrix;   // world to the shadow map's (u, v, depth)
    vec4 camera;          // xyz m, w time s
    vec4 sun_direction;   // xyz towards the sun, w lamps' strength
    vec4 sun_color;       // rgb, w wetness 0..1
    vec4 zenith_color;    // rgb, w overcast 0..1
    vec4 horizon_color;   // rgb, w fog density 1/m
    vec4 ground_color;    // rgb, w depth bias of leaves
    vec4 fog_color;       // rgb, w number of rain areas
    vec4 fog_law;         // optical depth straight up, its rim; 0 haze to 1 fog that hides hills
    vec4 wind;            // x, z where it blows to, z m/s at which gusts come, w sway phase rad
    vec4 drift;           // y 1 while there is lightning, w phase of waves in grass rad; x, z unused
    vec4 gusts[4];        // m/s, the wind now, half a second ago, and so on
    vec4 area_shape[4];   // center x, z, 1/a, 1/b
    vec4 area_turn[4];    // cos, sin of the heading, darkness, wetness
    vec4 area_cloud[4];   // base m, share of the light it takes, unused
};

// Albedo of snow: when fresh it throws back nearly nine tenths of the light.
const vec3 SNOW = vec3(0.84, 0.86, 0.90);
