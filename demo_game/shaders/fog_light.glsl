// Light that the air itself sends along a unit way. It glows towards the sun. Haze is a little darker
// and bluer than the sky at the horizon, so that hills stand out from it; fog hides them.
vec3 fog_light(vec3 way) {
    float glow = max(dot(way, sun_direction.xyz), 0.0);
    vec3 color = fog_color.rgb * mix(vec3(0.78, 0.84, 0.92), vec3(1.0), fog_law.z);
    return color + sun_color.rgb * (0.30 * glow * glow * glow * (1.0 - zenith_color.w));
}

// Premultiplied haze from what haze_depth has handed on.
vec4 haze_at(vec4 depth) {
    float thin = exp(-depth.a);
    return vec4(depth.rgb * (1.0 - thin), thin);
}
