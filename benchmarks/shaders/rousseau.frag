// A pixel of a streak: the drop passes over it, and it shows the mean of what a few points of the
// drop refract. The mask says where in the captured scene a point of the drop looks.
uniform sampler2D mask;   // offset in the capture (0.5 is none), opacity in alpha
uniform sampler2D scene;  // wide-angle capture
uniform float opacity;

in vec2 gs_uv;
flat in vec2 gs_center;
out vec4 color;

const int SAMPLES = 3;

void main()
{
    vec4 sum = vec4(0.0);
    float u = 0.5 + 0.5 * gs_uv.x;
    for (int i = 0; i < SAMPLES; ++i) {
        float v = (float(i) + 0.25 + 0.5 * gs_uv.y) / float(SAMPLES);
        vec4 m = textureLod(mask, vec2(u, v), 0.0);
        vec2 at = gs_center + (m.xy - 0.5) * 0.64;
        sum += vec4(textureLod(scene, at, 0.0).rgb, 1.0) * m.a;
    }
    float ends = min(min(gs_uv.y, 1.0 - gs_uv.y) * 6.0, 1.0);
    color = vec4(sum.rgb / max(sum.a, 1e-3), opacity * ends * sum.a / float(SAMPLES));
}
