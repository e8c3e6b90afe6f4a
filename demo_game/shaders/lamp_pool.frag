uniform vec3 tint;    // warm light on earth and grass, display values

in vec3 v_way;
in float v_strength;
out vec4 out_color;

void main() {
    float d2 = dot(v_way, v_way);
    float light = v_strength * 9.0 * v_way.y * inversesqrt(d2) / (d2 + 1.5);
    float rim = clamp(1.0 - dot(v_way.xz, v_way.xz) * 0.016, 0.0, 1.0);
    out_color = vec4(tint * (light * rim * rim), 0.0);
}
