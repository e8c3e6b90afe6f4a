// The sky as a disc seen from below: stereographic, the horizon is a circle of radius SKY_RIM.
// The map holds display values, so that showing it costs next to nothing.
const float SKY_RIM = 0.46;

vec2 sky_uv(vec3 d) {
    float size = length(d);
    return d.xz * (SKY_RIM / (size + max(d.y, -0.08 * size))) + 0.5;
}

// Scene light of display values: tone() undone.
vec3 sky_decode(vec3 y) {
    y = min(y, 0.96);
    vec3 a = 6.2 * (1.0 - y);
    vec3 b = 0.5 - 1.7 * y;
    return (sqrt(b * b + 0.24 * a * y) - b) / (2.0 * a) + 0.004;
}
