in vec2 v_corner;
in float v_strength;
out vec4 out_color;

void main() {
    float r2 = min(dot(v_corner, v_corner), 1.0);
    float soft = (1.0 - r2) * (1.0 - r2);
    float core = soft * soft * soft;
    out_color = vec4(vec3(1.0, 0.66, 0.36) * ((0.22 * soft * soft + 0.5 * core) * v_strength), 0.0);
}
