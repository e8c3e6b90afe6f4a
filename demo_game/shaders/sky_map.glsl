// The sky as a disc seen from below: stereographic, the horizon is a circle of radius SKY_RIM.
// The map holds display values, so that showing it costs next to nothing.
const float SKY_RIM = 0.46;

vec2 sky_uv(vec3 d) {
    float size = length(d);
    return d.xz * (SKY_RIM / (size + max(d.y, -0.08 * size))) + 0.5;
}

// For directions that are about unit and point up.
vec2 sky_uv_unit(vec3 d) {
    return d.xz * (SKY_RIM / (1.0 + d.y)) + 0.5;
}
