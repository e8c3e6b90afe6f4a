// Fog over a picture whose own shaders know none, by its depth; physics/optics.py in NumPy. Every
// instruction here is paid for a million times, a uniform block's too.
uniform sampler2D scene_depth;

noperspective in vec2 vs_ray;
noperspective in vec2 vs_place;
noperspective in float vs_rise;
flat in vec3 vs_law;
flat in vec3 vs_shown;
out vec4 color;  // premultiplied

void main()
{
    float depth = texture(scene_depth, vs_place).r;
    // Optical depth times log2(e) is far / over: up to the scene, or of the fog's layer on a round Earth.
    float far = vs_law.x * sqrt(dot(vs_ray, vs_ray) + 1.0);
    float over = depth < 1.0 ? abs(depth + vs_law.y) : max(vs_rise, 0.0) + vs_law.z;
    // optics.overlay_opacity of 2^-(far / over), to 0.004, for less than an exponential and a root cost.
    float cube = 1.57955 * far * far;
    float up = far * (over * (2.41089 * over + 1.61010 * far) + cube);
    float down = over * (over * (over + 4.45925 * far) + 1.38194 * far * far) + cube * far;
    color = vec4(vs_shown, 1.0) * (up / down);
}
