// The sky as a disc seen from below: stereographic, the horizon is a circle of radius SKY_RIM.
const float SKY_RIM = 0.46;

vec2 sky_uv(vec3 d) {
    float length_d = length(d);
    return d.xz * (SKY_RIM / (length_d + max(d.y, -0.08 * length_d))) + 0.5;
}

// The map holds the square root of half the light.
vec3 sky_decode(vec3 coded) {
    return coded * coded * 2.0;
}
