// A ring on a puddle: bright where its crest mirrors the sky, dark behind.
in vec2 v_corner;
flat in vec4 v_ring;
flat in float v_age;

out vec4 out_color;

void main() {
    float front = (length(v_corner) - 0.9 * v_age) * 5.0;
    float crest = max(1.0 - front * front, 0.0);
    float height = front * crest * crest * 3.4;  // -1 to 1
    vec3 color = height > 0.0 ? min(v_ring.rgb * 1.15, 1.0) : v_ring.rgb * 0.35;
    out_color = vec4(color, min(abs(height), 1.0) * 0.65 * v_ring.a);
}
