// A ring on a puddle: bright where its crest mirrors the sky, dark behind.
flat in vec4 v_ring;
flat in vec2 v_age;

out vec4 out_color;

void main() {
    vec2 corner = (2.0 * gl_PointCoord - 1.0) * vec2(1.0, v_age.y);
    float front = (length(corner) - 0.85 * v_age.x) * 5.0;
    float crest = max(1.0 - front * front, 0.0);
    float height = front * crest * crest * 3.4;  // -1 to 1
    vec3 color = height > 0.0 ? min(v_ring.rgb * 1.15, 1.0) : v_ring.rgb * 0.35;
    out_color = vec4(color, min(abs(height), 1.0) * 0.65 * v_ring.a);
}
