// A grain under one step of a display keeps the ramp from banding.
in vec3 v_color;
out vec4 out_color;

void main() {
    float grain = fract(dot(gl_FragCoord.xy, vec2(0.75487766, 0.56984029))) - 0.5;
    out_color = vec4(v_color + grain / 255.0, 1.0);
}
